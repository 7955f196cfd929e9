#include "blactl/fleet/command_result.hpp"

#include "blactl/bla/value.hpp"

#include "fleet/command_texts.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;

namespace {

/// In tenths of a degree.
std::int64_t tolerance(const CommandPlan& plan) {
  constexpr std::int64_t least = 10, beside_dead_band = 5;
  const auto dead_band = plan.plan.before.raw(at::angle_dead_band);
  return std::max(least, dead_band.value_or(0) + beside_dead_band);
}

std::optional<std::int64_t> last_angle(const CommandResult& result) {
  return result.samples.empty() ? std::nullopt : result.samples.back().angle;
}

/// Any reading in the direction of the command.
bool follows(const CommandPlan& plan, const CommandResult& result,
             std::optional<std::int64_t> CommandSample::* reading) {
  const std::int64_t target = plan.last_target();
  return std::ranges::any_of(result.samples, [&](const CommandSample& sample) {
    const std::int64_t shown = (sample.*reading).value_or(0);
    return (target > 0 && shown > 0) || (target < 0 && shown < 0);
  });
}

/// It went half of the way to some place and back.
bool has_wiggled(const CommandPlan& plan, const CommandResult& result) {
  const std::int64_t way = std::abs(plan.course.front().raw - plan.last_target());
  return std::ranges::any_of(result.samples, [&](const CommandSample& sample) {
    return sample.angle && 2 * std::abs(*sample.angle - plan.last_target()) >= way;
  });
}

Error differs(const CommandPlan& plan, std::string message) {
  const std::uint8_t id = plan.servo().id.value();
  return {Code::mismatch, std::move(message), say<texts::motion_why_hint>(id), id};
}

} // namespace

bool has_arrived(const CommandPlan& plan, const CommandResult& result) {
  const auto angle = last_angle(result);
  return angle && std::abs(*angle - plan.last_target()) <= tolerance(plan);
}

std::optional<Error> judge_motion(const CommandPlan& plan, const CommandResult& result) {
  if (result.is_cut) {
    return std::nullopt;
  }
  const std::uint8_t id = plan.servo().id.value();
  const std::string target = bla::display(*plan.parameter, plan.last_target());
  if (plan.wiggles() && !has_wiggled(plan, result)) {
    return differs(plan, say<texts::motion_not_wiggled>(id));
  }
  if (plan.is_angle() && !has_arrived(plan, result)) {
    const auto angle = last_angle(result);
    return differs(plan, say<texts::motion_not_reached>(
                             id, target, angle ? bla::display(*plan.parameter, *angle) : "?"));
  }
  const bool turns = follows(plan, result, &CommandSample::speed);
  if (plan.parameter->address == at::command_speed && plan.last_target() != 0 && !turns) {
    return differs(plan, say<texts::motion_not_turned>(id, target));
  }
  const bool pushes = turns || follows(plan, result, &CommandSample::torque);
  if (plan.by_servo_id && !plan.is_angle() && !result.is_shown && !pushes) {
    return differs(plan, say<texts::motion_array_ignored>(id, target));
  }
  return std::nullopt;
}

StepResponse step_response(const CommandPlan& plan, const CommandResult& result) {
  StepResponse response;
  const std::int64_t target = plan.last_target();
  const std::int64_t way = target - plan.plan.before.raw(at::current_angle).value_or(target);
  for (const CommandSample& sample : result.samples) {
    if (!sample.angle || sample.target != target) {
      continue;
    }
    const std::int64_t beyond = *sample.angle - target;
    response.overshoot_decideg = std::max(response.overshoot_decideg, way < 0   ? -beyond
                                                                      : way > 0 ? beyond
                                                                                : 0);
    if (std::abs(beyond) > tolerance(plan)) {
      response.settled.reset();
    } else if (!response.settled) {
      response.settled = sample.after;
    }
  }
  return response;
}

} // namespace blactl::fleet
