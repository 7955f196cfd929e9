#include "blactl/fleet/live/fault_job.hpp"

#include "replugged.hpp"
#include "support.hpp"

#include <array>
#include <memory>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
namespace at = bla::address;

namespace {

constexpr std::array node_11{NodeId(11)};

/// A servo without a load, which has one notice: no pulse at its PWM input.
std::string servo_11(const char* more) {
  return fmt::format(R"("servos": [{{"model": "BLA15-06U-A0", "node_id": 11{}}}])", more);
}

} // namespace

TEST_CASE("0x18 that shows no bit of a level tells what its register holds, unread",
          "[requirement-168]") {
  Scene scene(servo_11(""));
  scene.grow_old();
  const auto states = read_faults(*scene.session, profiles(), node_11, {});
  REQUIRE(states.servos.size() == 1);
  CHECK(states.servos[0].errors.empty());
  CHECK(states.servos[0].fault_register(at::fault_warning) == 0);
  CHECK_FALSE(states.servos[0].snapshot.raw(at::fault_warning));
}

TEST_CASE("an error that NodeStatus reports is not explained by a warning, a warning by a notice") {
  using bla::Level;
  using dronecan::Health;
  const auto unexplained = [](Health health, std::optional<Level> worst) {
    FaultState state{.snapshot = {}, .faults = {}, .health = health, .errors = {}};
    if (worst) {
      state.faults.push_back({.reg = at::fault_warning, .level = *worst, .group = {}});
    }
    return state.unexplained_health();
  };
  CHECK(unexplained(Health::error, Level::warning) == Level::failure);
  CHECK(unexplained(Health::error, {}) == Level::failure);
  CHECK_FALSE(unexplained(Health::critical, Level::failure));
  CHECK(unexplained(Health::warning, {}) == Level::warning);
  CHECK_FALSE(unexplained(Health::warning, Level::notice)); // unproven: whether notices warn
  CHECK_FALSE(unexplained(Health::ok, Level::warning));
}

TEST_CASE("a servo that refuses a register is there") {
  FaultState state{.snapshot = {}, .faults = {}, .health = {}, .errors = {}};
  CHECK(state.has_answered());
  state.errors.push_back({Code::refused, "", ""});
  CHECK(state.has_answered());
  state.errors.push_back({Code::timeout, "", ""});
  CHECK_FALSE(state.has_answered());
}

TEST_CASE("where NodeStatus tells of more than 0x18 did, all four registers are read") {
  Scene scene(servo_11(R"(, "behaviour": {"notices_warn": true}, "ram": {"fault_notice": 256})"));
  scene.grow_old();
  const auto states = read_faults(*scene.session, profiles(), node_11, {});
  REQUIRE(states.servos.size() == 1);
  CHECK(states.servos[0].health == dronecan::Health::warning);
  CHECK(states.servos[0].errors.empty());
  for (const bla::Address reg : bla::all_fault_registers) {
    CHECK(states.servos[0].snapshot.raw(reg));
  }
}

TEST_CASE("what another servo told, that was here while one was read, is not told as that one's") {
  for (Duration there = 0ms; there < 6ms; there += 250us) {
    INFO(there.count());
    const Time off(20s);
    const Time again = off + 500ms + there; // after the repeated request has come to the other one
    auto opened = Session::open(
        std::make_unique<Replugged>(servo_1001, servo_1002,
                                    std::vector{Gap{off, off + 400ms}, Gap{again, again + 700ms}}),
        state::LocalNodeId::unshared({}), Session::Hearing::commands, profiles());
    REQUIRE(opened);
    Session& session = **opened;
    REQUIRE(session.live_until(Time(15s)));
    const std::array node_20{NodeId(20)};
    REQUIRE(read_faults(session, profiles(), node_20, {}).servos.at(0).errors.empty());
    REQUIRE(session.live_until(off));
    const auto states = read_faults(session, profiles(), node_20, {});
    const FaultState& state = states.servos.at(0);
    CHECK(state.snapshot.servo.identity.readings().serial_number == 1001);
    CHECK((!state.errors.empty() || state.faults.size() == 1)); // no pulse at PWM
  }
}
