#include "blactl/fleet/configuration.hpp"

#include "support.hpp"

#include <algorithm>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

using Addresses = std::vector<int>;

Addresses addresses(const std::vector<const bla::Parameter*>& parameters) {
  Addresses all;
  for (const bla::Parameter* each : parameters) {
    all.push_back(each->address.value());
  }
  return all;
}

constexpr const char* servo_11 = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
    "ram": {"angle_limit_cw": "90deg", "reverse": "on"}}])";

/// A job that has read the configuration of node 11.
std::unique_ptr<ReadJob> read(const Scene& scene) {
  auto job = std::make_unique<ReadJob>(scene.roster(), scene.member(11), profiles(),
                                       Identification::Options{}, [](const Member& servo) {
                                         return Result<std::vector<const bla::Parameter*>>(
                                             configuration(profiles(), servo));
                                       });
  scene.run(*job);
  return job;
}

bool mentions(const Error& error, std::string_view words) {
  return error.message.find(words) != std::string::npos;
}

} // namespace

TEST_CASE("the configuration is what SAVE keeps and can be read and written, by address",
          "[requirement-82]") {
  const Scene scene(servo_11);
  const Addresses all = addresses(configuration(profiles(), scene.identify(11)));
  // Tables 3-5 to 3-8: no gaps of the reserved addresses, nothing below 0x20, not 0x49.
  CHECK(all == Addresses{0x20, 0x21, 0x22, 0x23, 0x24, 0x25, 0x26, 0x27, 0x2A, 0x2C, 0x2D, 0x2E,
                         0x2F, 0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x3A,
                         0x3B, 0x3C, 0x3D, 0x3E, 0x3F, 0x40, 0x41, 0x44, 0x45, 0x46});
}

TEST_CASE("what a firmware lacks is no part of its configuration", "[requirement-90]") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                                   "firmware_version": 1010}])");
  const Addresses all = addresses(configuration(profiles(), scene.identify(11)));
  for (const int absent : {0x25, 0x2A, 0x2F, 0x34, 0x35, 0x36, 0x37}) {
    CHECK(std::ranges::find(all, absent) == all.end());
  }
  CHECK(all.size() == 34 - 7);
}

TEST_CASE("the factory defaults are those of the model, one for every register") {
  const Scene scene(servo_11);
  const Member& servo = scene.identify(11);
  const auto defaults = factory_defaults(profiles(), servo);
  REQUIRE(defaults);
  CHECK(defaults->size() == configuration(profiles(), servo).size());
  CHECK(defaults->at(bla::address::angle_limit_cw) == 1799);
  CHECK(defaults->at(bla::address::servo_id) == 0);
  CHECK(defaults->at(bla::address::static_node_id) == 0);
}

TEST_CASE("a model that is not known well enough has no defaults") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                                   "model_number": 99, "hardware_version": 55555}])");
  const auto defaults = factory_defaults(profiles(), scene.identify(11));
  REQUIRE_FALSE(defaults);
  CHECK(defaults.error().code == Code::no_profile);
  CHECK(defaults.error().node_id == 11);
  CHECK_FALSE(defaults.error().hint.empty());
}

TEST_CASE("what was read is what must be there") {
  const Scene scene(servo_11);
  const auto job = read(scene);
  const Values held = values(*job);
  CHECK(held.size() == job->readings().size());
  CHECK(held.at(bla::address::angle_limit_cw) == 900);
  CHECK_FALSE(compare(*job, held));
  CHECK_FALSE(compare(*job, {})); // nothing is expected
  CHECK_FALSE(compare(*job, {{bla::address::angle_limit_cw, 900}}));
  CHECK_FALSE(compare(*job, {{bla::address::current_angle, 5}})); // of which nothing was read
}

TEST_CASE("registers that differ are named, each with what it holds and what it should hold") {
  const Scene scene(servo_11);
  const auto job = read(scene);
  Values expected = values(*job);
  SECTION("one") {
    expected[bla::address::angle_limit_cw] = 1799;
    const auto error = compare(*job, expected);
    REQUIRE(error);
    CHECK(error->code == Code::mismatch);
    CHECK(error->node_id == 11);
    CHECK(mentions(*error, "angle_limit_cw"));
    CHECK(mentions(*error, "90.0"));
    CHECK(mentions(*error, "179.9"));
    CHECK_FALSE(mentions(*error, "reverse"));
  }
  SECTION("several") {
    expected[bla::address::angle_limit_cw] = 1799;
    expected[parameter("reverse").address] = 0;
    const auto error = compare(*job, expected);
    REQUIRE(error);
    CHECK(mentions(*error, "angle_limit_cw"));
    CHECK(mentions(*error, "reverse"));
  }
}

TEST_CASE("what could not be read is no match, whatever the other registers hold") {
  const Scene scene(servo_11);
  scene.identify(11);
  ReadJob job(scene.roster(), scene.member(11), profiles(), {}, [](const Member& servo) {
    return Result<std::vector<const bla::Parameter*>>(configuration(profiles(), servo));
  });
  Script script;
  std::string asked = text(job.next(Script::start()));
  REQUIRE(asked == "read 0x20");
  asked = text(job.next(script.value("0x20", std::int64_t{0})));
  REQUIRE(asked == "read 0x21");
  asked = text(job.next(Script::timed_out()));
  while (asked != "nothing") {
    asked = text(job.next(script.value(asked.substr(5), std::int64_t{0})));
  }
  const auto error = compare(job, values(job));
  REQUIRE(error);
  CHECK(error->code == Code::timeout);
  CHECK_FALSE(values(job).contains(parameter("soft_start").address));
  CHECK(values(job).contains(parameter("torque_output").address));
}

TEST_CASE("a servo that was not identified is no match") {
  const Scene scene(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11,
                                   "faults": {"mute": true}}])");
  const auto job = read(scene);
  const auto error = compare(*job, {});
  REQUIRE(error);
  CHECK(error->code == Code::timeout);
  CHECK(values(*job).empty());
}
