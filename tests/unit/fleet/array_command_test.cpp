// What ArrayCommand can tell a servo, against the receiving side of the simulator.

#include "blactl/bla/address.hpp"
#include "blactl/fleet/bus/array_command.hpp"
#include "blactl/sim/servo/array_entry.hpp"

#include "catch.hpp"

#include <cstdint>
#include <limits>

using namespace blactl;
using namespace blactl::fleet;

namespace {

/// What a servo takes from the message as it is on the wire.
std::int64_t taken(bla::Address command, std::int64_t raw) {
  const auto sent = array_command(7, command, raw).encode();
  const auto message = dronecan::ArrayCommand::decode(sent.bytes());
  REQUIRE(message);
  REQUIRE(message->commands.size() == 1);
  CHECK(message->commands.front().actuator_id == 7);
  const auto motion = sim::motion_command(message->commands.front(), {});
  REQUIRE(motion);
  CHECK(motion->address == command);
  return motion->value;
}

} // namespace

TEST_CASE("every angle within 200 deg, every speed and torque is told exactly") {
  for (std::int64_t raw = -2000; raw <= 2000; ++raw) {
    CHECK(taken(bla::address::command_angle, raw) == raw);
    CHECK(told_by_array(bla::address::command_angle, raw) == raw);
  }
  for (std::int64_t raw = -300; raw <= 300; ++raw) {
    CHECK(taken(bla::address::command_speed, raw) == raw);
    CHECK(taken(bla::address::command_torque, raw) == raw);
  }
}

TEST_CASE("what ArrayCommand cannot tell is known before") {
  for (const std::int64_t raw : {2001, 3601, -36'001, 1'234'567}) {
    const std::int64_t told = told_by_array(bla::address::command_angle, raw);
    CHECK(told == taken(bla::address::command_angle, raw));
    CHECK(told != raw);
  }
}

TEST_CASE("a heard entry is read as a servo takes it") {
  const auto read = [](std::uint8_t type, float value) {
    return motion_command({.actuator_id = 7, .command_type = type, .value = value});
  };
  for (std::uint8_t type = 0; type <= 3; ++type) {
    for (const float value : {-1.0F, -0.125F, 0.0F, 0.25F, 0.75F}) {
      const auto told = read(type, value);
      const auto motion = sim::motion_command({7, type, value}, {});
      REQUIRE(told);
      REQUIRE(motion);
      CHECK(told->reg == motion->address);
      CHECK(told->raw == motion->value);
    }
  }
  CHECK(read(0, 0.5F)->raw == 900);
  CHECK_FALSE(read(4, 0.5F));
  CHECK_FALSE(read(1, std::numeric_limits<float>::quiet_NaN()));
  CHECK_FALSE(read(1, std::numeric_limits<float>::infinity()));
}
