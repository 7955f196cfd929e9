// What is refused before a shaft is moved, and what is asked.

#include "blactl/fleet/motion/motion_plan.hpp"

#include "support.hpp"

#include <algorithm>
#include <string>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace at = bla::address;

namespace {

CommandWanted wanted(const std::string& text) {
  return {.target = assignments({text}).front()};
}

/// A servo with its torque on that holds this, and its defaults else.
Result<MotionPlan> plan(const CommandWanted& wanted, const bla::Values& held = {}) {
  const Servo servo = bla21();
  const auto needed = registers_to_command(wanted, servo);
  REQUIRE(needed);
  return plan_command(wanted, snapshot_of(servo, *needed, held), profiles());
}

Error refusal(const CommandWanted& wanted, const bla::Values& held = {}) {
  const auto planned = plan(wanted, held);
  REQUIRE_FALSE(planned);
  return planned.error();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("commands are repeated at less than half of the servo's timeout", "[requirement-149]") {
  for (const std::int64_t timeout_ms : {50, 60, 100, 250, 1000, 60'000}) {
    const auto planned = plan(wanted("command_angle=45deg"), {{at::timeout_time, timeout_ms}});
    REQUIRE(planned);
    const Duration half = std::chrono::milliseconds(timeout_ms) / 2;
    CHECK(planned->period < half);
    CHECK(planned->longest_gap < half);
    CHECK(planned->period <= planned->longest_gap);
    CHECK(planned->period <= 100ms);
  }
  for (const std::int64_t timeout_ms : {1, 10, 49}) {
    const Error refused = refusal(wanted("command_angle=45deg"), {{at::timeout_time, timeout_ms}});
    CHECK(refused.code == Code::cross_check);
    CHECK(contains(refused.hint, "timeout_time=1000ms"));
  }
}

TEST_CASE("a command beyond a limit, or without an output, is refused") {
  CHECK(plan(wanted("command_angle=45deg"), {{at::angle_limit_cw, 450}}));
  CHECK(refusal(wanted("command_angle=45deg"), {{at::angle_limit_cw, 449}}).code ==
        Code::cross_check);
  CHECK(refusal(wanted("command_angle=-45deg"), {{at::angle_limit_ccw, -449}}).code ==
        Code::cross_check);
  const bla::Values on{{at::speed_torque_control, 1}};
  bla::Values slow = on;
  slow[at::speed_limit_cw] = 59;
  CHECK(plan(wanted("command_speed=60rpm"), on));
  CHECK(refusal(wanted("command_speed=60rpm"), slow).code == Code::cross_check);
  for (const std::int64_t output : {1, 2}) {
    const Error refused = refusal(wanted("command_angle=45deg"), {{at::torque_output, output}});
    CHECK(refused.code == Code::cross_check);
    CHECK(contains(refused.hint, "torque_output=on"));
  }
}

TEST_CASE("a shaft outside of its limits is not commanded: it could not be held on its way") {
  const Error refused =
      refusal(wanted("command_angle=0deg"), {{at::current_angle, 1700}, {at::angle_limit_cw, 900}});
  CHECK(refused.code == Code::cross_check);
  CHECK(contains(refused.hint, "command_angle=0deg"));
  CHECK(
      plan(wanted("command_speed=10rpm"),
           {{at::speed_torque_control, 1}, {at::current_angle, 1700}, {at::angle_limit_cw, 900}}));
}

TEST_CASE("a speed or torque needs its switch, and a timeout that stops it") {
  for (const char* motion : {"command_speed=60rpm", "command_torque=20%"}) {
    CHECK(contains(refusal(wanted(motion)).hint, "speed_torque_control=on"));
    CHECK(contains(
        refusal(wanted(motion), {{at::speed_torque_control, 1}, {at::timeout_action, 0}}).hint,
        "timeout_action=off"));
    CHECK(plan(wanted(motion), {{at::speed_torque_control, 1}, {at::timeout_action, 2}}));
  }
  CHECK(plan(wanted("command_angle=45deg"), {{at::timeout_action, 0}})); // it ends by itself
}

TEST_CASE("limits that hold nothing are told before the shaft moves") {
  const auto told = [](const CommandWanted& wanted, const bla::Values& held) {
    const auto planned = plan(wanted, held);
    REQUIRE(planned);
    return std::ranges::any_of(planned->plan.warnings, [](const Warning& each) {
      return each.code == "limits_without_effect";
    });
  };
  const CommandWanted angle = wanted("command_angle=45deg");
  CHECK(told(angle, {{at::torque_limit_cw, 10}}));
  CHECK(told(angle, {{at::torque_limit_cw, 10}, {at::command_angle, 450}})); // it is sent again
  CHECK(told({}, {{at::speed_limit_ccw, -5}}));                              // a wiggle
  CHECK_FALSE(told(angle, {}));
  CHECK_FALSE(told(angle, {{at::torque_limit_cw, 10}, {at::speed_torque_control, 1}}));
}

TEST_CASE("what a model forbids is never planned") {
  Servo slow = bla21();
  slow.identity = bla::Identity(profiles(), {86, 240900558, 1400, 12050}); // a BLA34
  CHECK(registers_to_command(wanted("command_speed=80rpm"), slow));
  CHECK(registers_to_command(wanted("command_speed=81rpm"), slow).error().code ==
        Code::out_of_range);
  Servo unknown = bla21();
  unknown.identity = bla::Identity(profiles(), {});
  CHECK(registers_to_command(wanted("command_angle=45deg"), unknown).error().code ==
        Code::no_profile);
}

TEST_CASE("a wiggle stays inside the limits and ends where it began") {
  const auto offsets = [](const MotionPlan& planned, std::int64_t around) {
    std::vector<std::int64_t> all;
    for (const Waypoint& waypoint : planned.course) {
      all.push_back(waypoint.raw - around);
    }
    return all;
  };
  const auto free = plan({}, {{at::current_angle, 123}});
  REQUIRE(free);
  CHECK(offsets(*free, 123) == std::vector<std::int64_t>{50, -50, 50, -50, 50, -50, 50, 0});
  CHECK(free->target_at(0ms) == 173);
  CHECK(free->target_at(249ms) == 173);
  CHECK(free->target_at(250ms) == 73);
  CHECK(free->target_at(5s) == 123);
  const auto at_stop = plan({}, {{at::current_angle, 900}, {at::angle_limit_cw, 900}});
  REQUIRE(at_stop);
  const auto found = offsets(*at_stop, 900);
  CHECK(*std::ranges::max_element(found) == 0);
  CHECK(*std::ranges::min_element(found) == -50);
  CHECK(found.back() == 0);
  CHECK(refusal({}, {{at::current_angle, 0}, {at::angle_limit_cw, 20}, {at::angle_limit_ccw, -20}})
            .code == Code::cross_check);
  CHECK(refusal({}, {{at::current_angle, 950}, {at::angle_limit_cw, 900}}).code ==
        Code::cross_check); // it would not stay where it is
}

TEST_CASE("what ArrayCommand cannot tell exactly is refused") {
  CommandWanted array = wanted("command_angle=250.1deg");
  array.by_servo_id = true;
  const bla::Values wide{{at::angle_limit_cw, 36'000}};
  const Error refused = refusal(array, wide);
  CHECK(refused.code == Code::usage);
  CHECK(contains(refused.message, "250.1 deg"));
  array.by_servo_id = false;
  CHECK(plan(array, wide));
}

TEST_CASE("the question says from where to where, for how long, and what comes after it") {
  constexpr std::int64_t no_pulses = 1 << 20;
  const bla::Values held{{at::current_angle, -100}, {at::fault_notice, no_pulses}};
  const auto angle = plan(wanted("command_angle=45deg"), held);
  REQUIRE(angle);
  const std::string question = question_to_command(*angle);
  CHECK(contains(question, "from -10.0 deg to 45.0 deg"));
  CHECK(contains(question, "After 2 s"));
  CHECK(contains(question, "1000 ms after the last command the output goes off"));
  CHECK_FALSE(contains(question, "PWM"));
  const auto speed = plan(wanted("command_speed=-60rpm"),
                          {{at::speed_torque_control, 1}, {at::timeout_action, 2}});
  REQUIRE(speed);
  CHECK(contains(question_to_command(*speed), "at -60 rpm for 2 s"));
  CHECK(contains(question_to_command(*speed), "brakes"));
  CHECK(contains(question_to_command(*speed), "PWM signal is present"));
}

TEST_CASE("the question names what may hold the motor off") {
  constexpr std::int64_t supply_low = 1 << 11;
  const auto planned = plan(wanted("command_angle=45deg"), {{at::fault_warning, supply_low}});
  REQUIRE(planned);
  CHECK(contains(question_to_command(*planned), "motor may be off"));
}
