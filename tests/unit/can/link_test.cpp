#include "blactl/can/link.hpp"

#include "catch.hpp"

#include <algorithm>

using namespace blactl;
using namespace blactl::can;

namespace {

const Link can0{.name = "can0", .kind = "can", .is_up = true};
const Link can1{.name = "can1", .kind = "can", .is_up = false};
const Link vcan0{.name = "vcan0", .kind = "vcan", .is_up = true};

} // namespace

TEST_CASE("the only interface that is up is found among others that are down") {
  const std::vector<Link> links{can1, can0};
  REQUIRE(only_one_up(links) != nullptr);
  CHECK(only_one_up(links)->name == "can0");
}

TEST_CASE("there is no only interface when none or several are up") {
  CHECK(only_one_up({}) == nullptr);
  CHECK(only_one_up(std::vector{can1}) == nullptr);
  CHECK(only_one_up(std::vector{can0, can1, vcan0}) == nullptr);
}

TEST_CASE("interfaces are listed for a person, foreign names made harmless") {
  CHECK(describe(std::vector{can0, can1}) ==
        "CAN interfaces of this machine: can0 (up), can1 (down)");
  CHECK(describe(std::vector{Link{.name = "x\x1b[2J"}}) ==
        "CAN interfaces of this machine: x\\x1b[2J (down)");
  CHECK(describe({}).starts_with("this machine has no CAN interface"));
}

TEST_CASE("the interfaces of this machine can be listed, and only CAN is among them") {
  const auto found = links();
  REQUIRE(found.has_value());
  CHECK(std::ranges::find(*found, "lo", &Link::name) == found->end());
}
