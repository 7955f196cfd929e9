// What ArrayCommand can tell a servo, against the receiving side of the simulator.

#include "blactl/bla/address.hpp"
#include "blactl/fleet/bus/array_command.hpp"
#include "blactl/sim/servo/array_entry.hpp"

#include "catch.hpp"

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
