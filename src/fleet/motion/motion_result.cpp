#include "blactl/fleet/motion/motion_result.hpp"

#include "blactl/bla/value.hpp"

#include "fleet/motion/motion_texts.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;

namespace {

/// In tenths of a degree.
std::int64_t tolerance(const MotionPlan& plan) {
  constexpr std::int64_t least = 10, most = 50, beside_dead_band = 5;
  const auto dead_band = plan.plan.before.raw(at::angle_dead_band);
  return std::clamp(dead_band.value_or(0) + beside_dead_band, least, most);
}

/// In the second half of its time most samples show at least half of the speed; the noise of a
/// motor that stands still does not count. Empty: there are no such samples.
std::optional<bool> came_to_speed(const MotionPlan& plan, const MotionResult& result) {
  constexpr std::int64_t noise_rpm = 3; // unproven
  const std::int64_t target = plan.last_target();
  const std::int64_t least = std::max(std::abs(target) / 2, std::min(noise_rpm, std::abs(target)));
  std::size_t seen = 0, fast = 0;
  for (const MotionSample& sample : result.samples) {
    if (sample.target == target && sample.speed && sample.after >= plan.duration / 2) {
      const std::int64_t forward = target < 0 ? -*sample.speed : *sample.speed;
      ++seen;
      fast += forward >= least ? 1U : 0U;
    }
  }
  return seen > 0 ? std::optional(2 * fast > seen) : std::nullopt;
}

/// The shaft went half of the way to some waypoint, for more than a glitch of its register.
bool has_wiggled(const MotionPlan& plan, const MotionResult& result) {
  constexpr std::ptrdiff_t least = 3;
  const std::int64_t way = std::abs(plan.course.front().raw - plan.last_target());
  return std::ranges::count_if(result.samples, [&](const MotionSample& sample) {
           return sample.angle && 2 * between(*sample.angle, plan.last_target()) >= way;
         }) >= least;
}

/// unproven: that a servo obeys ArrayCommand to servo ID 0 (tables 2-20 and 2-22 differ).
Error differs(const MotionPlan& plan, const MotionResult& result, std::string message) {
  const std::uint8_t id = plan.servo().id.value();
  const bool may_be_deaf =
      plan.by_servo_id && plan.plan.before.raw(at::servo_id) == 0 && !result.is_shown;
  return {Code::mismatch, std::move(message),
          may_be_deaf ? say<texts::motion_servo_id_0_hint>(id) : say<texts::motion_why_hint>(id),
          id};
}

} // namespace

bool holds(const MotionPlan& plan, const MotionResult& result) {
  return !result.protection && result.output == plan.plan.before.raw(at::torque_output);
}

std::int64_t between(std::int64_t angle, std::int64_t other) {
  constexpr std::int64_t turn = 3600;
  const std::int64_t way = std::abs(angle - other) % turn;
  return std::min(way, turn - way);
}

bool is_at(const MotionPlan& plan, std::int64_t angle, std::int64_t target) {
  return std::abs(angle - target) <= tolerance(plan);
}

std::string after_commands(const MotionPlan& plan, const MotionResult& result) {
  const bool is_known = result.timeout.size() == 2;
  if (!is_known && result.has_restarted) {
    return say<texts::motion_then_unknown>();
  }
  return is_known ? after_commands(plan, result.timeout) : after_commands(plan);
}

std::optional<Error> judge_motion(const MotionPlan& plan, const MotionResult& result) {
  if (result.is_cut) {
    return std::nullopt;
  }
  const std::uint8_t id = plan.servo().id.value();
  const std::string target = bla::display(*plan.parameter, plan.last_target());
  if (result.held) { // it had not arrived when its time was over
    return differs(
        plan, result,
        say<texts::motion_not_reached>(id, target, bla::display(*plan.parameter, *result.held)));
  }
  if (plan.wiggles() && !has_wiggled(plan, result)) {
    return differs(plan, result, say<texts::motion_not_wiggled>(id));
  }
  const bool is_speed = plan.parameter->address == at::command_speed && plan.last_target() != 0;
  const auto turned = is_speed ? came_to_speed(plan, result) : std::optional(true);
  if (!turned) {
    return Error{Code::timeout, say<texts::motion_not_seen>(id), say<texts::motion_why_hint>(id),
                 id};
  }
  if (!*turned) {
    return differs(plan, result, say<texts::motion_not_turned>(id, target));
  }
  if (plan.by_servo_id && !plan.is_angle() && !is_speed && !result.is_shown) {
    return differs(plan, result, say<texts::motion_array_ignored>(id, target));
  }
  return std::nullopt;
}

StepResponse step_response(const MotionPlan& plan, const MotionResult& result) {
  StepResponse response;
  const std::int64_t target = plan.last_target();
  const std::int64_t way = target - plan.plan.before.raw(at::current_angle).value_or(target);
  for (const MotionSample& sample : result.samples) {
    if (!sample.angle || sample.target != target) {
      continue;
    }
    const std::int64_t beyond = *sample.angle - target;
    response.overshoot_decideg = std::max(response.overshoot_decideg, way < 0   ? -beyond
                                                                      : way > 0 ? beyond
                                                                                : 0);
    if (!is_at(plan, *sample.angle, target)) {
      response.settled.reset();
    } else if (!response.settled) {
      response.settled = sample.after;
    }
  }
  return response;
}

} // namespace blactl::fleet
