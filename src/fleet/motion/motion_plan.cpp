#include "blactl/fleet/motion/motion_plan.hpp"

#include "blactl/bla/fault_bits.hpp"
#include "blactl/bla/faults.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/array_command.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include "fleet/motion/motion_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using namespace std::chrono_literals;

namespace {

/// Of 0x20 and 0x26.
constexpr std::int64_t output_on = 0, action_hold = 0, action_off = 1;

/// Commands come as often as from an autopilot, or as required by the servo's timeout.
constexpr Duration usual_period = 100ms;

/// A write and its response take 1 ms on an idle bus; computers are sometimes slower.
constexpr Duration shortest_gap = 20ms;

/// The amplitude of a wiggle, in tenths of a degree, and the time at each end.
constexpr std::int64_t wiggle_decideg = 50;
constexpr Duration wiggle_stay = 250ms;

struct LimitPair {
  Address command, reading, ccw, cw;
};

constexpr std::array limit_pairs{
    LimitPair{at::command_angle, at::current_angle, at::angle_limit_ccw, at::angle_limit_cw},
    LimitPair{at::command_speed, at::current_speed, at::speed_limit_ccw, at::speed_limit_cw},
    LimitPair{at::command_torque, at::current_torque, at::torque_limit_ccw, at::torque_limit_cw}};

const LimitPair& limits_of(Address command) {
  return *std::ranges::find(limit_pairs, command, &LimitPair::command);
}

Address commanded(const CommandWanted& wanted) {
  return wanted.target ? wanted.target->parameter->address : at::command_angle;
}

/// If any of these changes, the command is not the one that was agreed to.
std::vector<Address> settings_of(Address command) {
  const LimitPair& limits = limits_of(command);
  return {at::torque_output,  at::reverse,      at::extended_angle, at::speed_torque_control,
          at::timeout_action, at::timeout_time, limits.ccw,         limits.cw,
          at::origin,         at::servo_id};
}

std::string shown(const Snapshot& before, Address address, std::int64_t raw) {
  const bla::Parameter* parameter = before.servo.identity.parameter(address);
  return parameter != nullptr ? bla::display(*parameter, raw) : std::to_string(raw);
}

/// The register's value, for people.
std::string held(const Snapshot& before, Address address) {
  const auto raw = before.raw(address);
  return raw ? shown(before, address, *raw) : say<texts::unknown_before>();
}

Error refused(const Snapshot& before, std::string message, std::string hint) {
  return {Code::cross_check, std::move(message), std::move(hint), before.servo.id.value()};
}

std::optional<Error> check_output(const Snapshot& before) {
  const std::uint8_t id = before.servo.id.value();
  if (before.raw(at::torque_output) == output_on) {
    return std::nullopt;
  }
  return refused(before, say<texts::motion_output_off>(id, held(before, at::torque_output)),
                 say<texts::set_first_hint>(id, "torque_output=on"));
}

/// Beyond its limits the servo would stop there (4.31 to 4.33). Torque and speed limits apply only
/// if 0x25 is on; without it neither is commanded.
std::optional<Error> check_limits(const Snapshot& before, Address command, std::int64_t raw) {
  const LimitPair& limits = limits_of(command);
  const auto ccw = before.raw(limits.ccw), cw = before.raw(limits.cw);
  if (!ccw || !cw || (raw >= *ccw && raw <= *cw)) {
    return std::nullopt;
  }
  const std::uint8_t id = before.servo.id.value();
  const auto name = [&](Address address) { return before.servo.identity.parameter(address)->name; };
  return refused(before,
                 say<texts::motion_beyond_limits>(id, shown(before, command, raw), name(limits.ccw),
                                                  held(before, limits.ccw), name(limits.cw),
                                                  held(before, limits.cw)),
                 say<texts::motion_beyond_limits_hint>(id));
}

/// Outside its limits it cannot be held on the way: it would run on to the nearer one (4.31).
std::optional<Error> check_place(const Snapshot& before, Address command) {
  const auto angle = before.raw(at::current_angle);
  const auto ccw = before.raw(at::angle_limit_ccw), cw = before.raw(at::angle_limit_cw);
  if (command != at::command_angle || !angle || !ccw || !cw || (*angle >= *ccw && *angle <= *cw)) {
    return std::nullopt;
  }
  const std::uint8_t id = before.servo.id.value();
  return refused(before,
                 say<texts::motion_outside>(id, held(before, at::current_angle),
                                            held(before, at::angle_limit_ccw),
                                            held(before, at::angle_limit_cw)),
                 say<texts::motion_outside_hint>(id));
}

std::optional<Error> check_timeout(const Snapshot& before, const MotionPlan& plan) {
  if (plan.longest_gap >= shortest_gap) {
    return std::nullopt;
  }
  const std::uint8_t id = before.servo.id.value();
  return refused(before, say<texts::motion_timeout_short>(id, held(before, at::timeout_time)),
                 say<texts::set_first_hint>(id, "timeout_time=1000ms"));
}

/// ArrayCommand carries float16: it cannot represent every angle (errata C11).
std::optional<Error> check_exact(const Snapshot& before, const MotionPlan& plan) {
  for (const Waypoint& waypoint : plan.course) {
    const std::int64_t told = told_by_array(plan.parameter->address, waypoint.raw);
    if (plan.by_servo_id && told != waypoint.raw) {
      const auto text = [&](std::int64_t raw) { return bla::display(*plan.parameter, raw); };
      return Error{Code::usage, say<texts::motion_not_exact>(text(waypoint.raw), text(told)),
                   say<texts::motion_not_exact_hint>(text(told)), before.servo.id.value()};
    }
  }
  return std::nullopt;
}

std::array<CommandReading, 3> readings_of(const Snapshot& before) {
  std::array<CommandReading, 3> readings;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    readings.at(i) = {before.servo.identity.parameter(limit_pairs.at(i).reading),
                      before.raw(limit_pairs.at(i).ccw), before.raw(limit_pairs.at(i).cw)};
  }
  return readings;
}

/// To both sides, or to the one with room; finally back to the start.
Result<std::vector<Waypoint>> wiggle(const Snapshot& before, Duration duration) {
  const auto angle = before.raw(at::current_angle);
  const auto ccw = before.raw(at::angle_limit_ccw), cw = before.raw(at::angle_limit_cw);
  const bool is_known = angle && ccw && cw;
  const bool goes_ccw = is_known && *angle - wiggle_decideg >= *ccw && *angle <= *cw;
  const bool goes_cw = is_known && *angle + wiggle_decideg <= *cw && *angle >= *ccw;
  if (!goes_ccw && !goes_cw) {
    return std::unexpected(
        refused(before,
                say<texts::motion_no_room>(before.servo.id.value(), held(before, at::current_angle),
                                           held(before, at::angle_limit_ccw),
                                           held(before, at::angle_limit_cw)),
                say<texts::motion_no_room_hint>(before.servo.id.value())));
  }
  const std::int64_t there = *angle + (goes_cw ? wiggle_decideg : -wiggle_decideg);
  const std::int64_t back = goes_cw && goes_ccw ? *angle - wiggle_decideg : *angle;
  std::vector<Waypoint> course;
  for (Duration from{}; from + 2 * wiggle_stay <= duration || course.empty(); from += wiggle_stay) {
    course.push_back({from, course.size() % 2 == 0 ? there : back});
  }
  course.push_back({course.back().from + wiggle_stay, *angle});
  return course;
}

Result<std::vector<Waypoint>> course_of(const CommandWanted& wanted, const Snapshot& before) {
  if (wanted.target) {
    return std::vector<Waypoint>{{Duration{}, wanted.target->value.raw}};
  }
  return wiggle(before, wanted.duration);
}

/// The change of 0x00, 0x01 or 0x02, checked as in any command that writes; a value that is held
/// already is sent as well.
Result<Plan> judged(const CommandWanted& wanted, Snapshot before, std::int64_t raw,
                    const bla::Profiles& profiles) {
  std::erase_if(before.readings, [&](const Reading& reading) {
    return reading.parameter->address == commanded(wanted);
  });
  if (wanted.target) {
    return make_plan({.assignments = {*wanted.target}}, std::move(before), profiles);
  }
  auto assignment = bla::make_assignment(profiles, at::command_angle.name(), std::to_string(raw));
  if (!assignment) {
    return std::unexpected(assignment.error());
  }
  if (auto allowed = before.servo.identity.may_write(at::command_angle, raw); !allowed) {
    return std::unexpected(allowed.error());
  }
  return make_plan({.assignments = {std::move(*assignment)}}, std::move(before), profiles);
}

void set_times(MotionPlan& plan, const CommandWanted& wanted) {
  constexpr std::int64_t usual_timeout_ms = 1000; // the default of 0x27
  plan.duration = plan.wiggles() ? std::max(wanted.duration, plan.course.back().from + wiggle_stay)
                                 : wanted.duration;
  plan.timeout =
      std::chrono::milliseconds(plan.plan.before.raw(at::timeout_time).value_or(usual_timeout_ms));
  plan.longest_gap = plan.timeout * 2 / 5; // less than half of it (requirement 149)
  plan.period = std::min(usual_period, plan.longest_gap / 2);
}

std::string seconds_text(Duration duration) {
  return fmt::format("{:g}", std::chrono::duration<double>(duration).count());
}

/// Present warnings and failures: they may keep the motor off (4.12).
std::string fault_lines(const MotionPlan& plan) {
  std::string lines;
  for (const bla::Fault& fault : plan.faults) {
    const std::string text = fault.known != nullptr
                                 ? std::string(choose(fault.known->text_en, fault.known->text_ja))
                                 : fmt::format("{}.{}", fault.reg.name(), fault.bit);
    lines += say<texts::motion_question_fault>(text);
  }
  return lines;
}

bool has_pulses(const MotionPlan& plan) {
  const auto notices = plan.plan.before.raw(at::fault_notice);
  return plan.servo().identity.check_pwm_input() && notices &&
         (*notices & bla::fault::pwm_input) == 0;
}

} // namespace

std::int64_t MotionPlan::target_at(Duration after) const {
  std::int64_t raw = course.front().raw;
  for (const Waypoint& waypoint : course) {
    raw = waypoint.from <= after ? waypoint.raw : raw;
  }
  return raw;
}

bla::Values MotionPlan::conditions() const {
  bla::Values values;
  if (const auto angle = plan.before.raw(at::current_angle); angle && is_angle()) {
    values[at::current_angle] = *angle;
  }
  for (const Address address : settings_of(parameter->address)) {
    if (const auto raw = plan.before.raw(address)) {
      values[address] = *raw;
    }
  }
  return values;
}

Result<std::vector<const bla::Parameter*>> registers_to_command(const CommandWanted& wanted,
                                                                const Servo& servo) {
  if (servo.identity.profile() == nullptr) {
    return fail(Code::no_profile, say<texts::only_readable>());
  }
  Wanted change;
  if (wanted.target) {
    change.assignments = {*wanted.target};
  }
  change.also_read = settings_of(commanded(wanted));
  const std::array readings{at::current_angle,  at::command_angle,  at::command_speed,
                            at::command_torque, at::fault_notice,   at::fault_warning,
                            at::fault_failure,  at::angle_dead_band};
  change.also_read.insert(change.also_read.end(), readings.begin(), readings.end());
  for (const LimitPair& pair : limit_pairs) {
    change.also_read.insert(change.also_read.end(), {pair.ccw, pair.cw});
  }
  return registers_needed(change, servo);
}

Result<MotionPlan> plan_command(const CommandWanted& wanted, Snapshot before,
                                const bla::Profiles& profiles) {
  if (auto error = before.first_error()) {
    return std::unexpected(std::move(*error));
  }
  const Address command = commanded(wanted);
  const auto course = course_of(wanted, before);
  if (!course) {
    return std::unexpected(course.error());
  }
  MotionPlan plan{.plan = {},
                  .parameter = before.servo.identity.parameter(command),
                  .course = *course,
                  .by_servo_id = wanted.by_servo_id};
  auto change = judged(wanted, std::move(before), course->front().raw, profiles);
  if (!change) {
    return std::unexpected(change.error());
  }
  plan.plan = std::move(*change);
  set_times(plan, wanted);
  plan.readings = readings_of(plan.plan.before);
  plan.faults = bla::faults(plan.plan.before.values(), profiles);
  std::erase_if(plan.faults, [](const auto& fault) { return fault.level == bla::Level::notice; });
  const Snapshot& now = plan.plan.before;
  for (auto refusal :
       {check_output(now), check_limits(now, command, plan.course.front().raw),
        check_place(now, command), check_timeout(now, plan), check_exact(now, plan)}) {
    if (refusal) {
      return std::unexpected(std::move(*refusal));
    }
  }
  return plan;
}

std::string after_commands(const MotionPlan& plan, const bla::Values& now) {
  const auto value = [&](Address address) {
    const auto raw = bla::find(now, address);
    return raw ? raw : plan.plan.before.raw(address);
  };
  const auto raw = value(at::timeout_time);
  const std::string timeout =
      raw ? shown(plan.plan.before, at::timeout_time, *raw) : say<texts::unknown_before>();
  const auto action = value(at::timeout_action);
  return action == action_hold  ? say<texts::motion_then_hold>(timeout)
         : action == action_off ? say<texts::motion_then_off>(timeout)
                                : say<texts::motion_then_brake>(timeout);
}

std::string question_to_command(const MotionPlan& plan) {
  const std::uint8_t id = plan.servo().id.value();
  const std::string from = held(plan.plan.before, at::current_angle);
  const std::string to = bla::display(*plan.parameter, plan.course.front().raw);
  const std::string time = seconds_text(plan.duration);
  const std::string then = after_commands(plan);
  std::string question;
  if (plan.wiggles()) {
    question = say<texts::motion_question_wiggle>(id, bla::display(*plan.parameter, wiggle_decideg),
                                                  time, from, then);
  } else if (plan.is_angle()) {
    question = say<texts::motion_question_angle>(id, from, to, time, then);
  } else if (plan.parameter->address == at::command_speed) {
    question = say<texts::motion_question_speed>(id, to, time, from, then);
  } else {
    question = say<texts::motion_question_torque>(id, to, time, from, then);
  }
  return question + fault_lines(plan) +
         (has_pulses(plan) ? say<texts::motion_question_pwm>() : std::string());
}

} // namespace blactl::fleet
