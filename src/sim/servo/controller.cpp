#include "blactl/sim/servo/controller.hpp"

#include <algorithm>
#include <cstdlib>

namespace blactl::sim {
namespace {

/// unproven: the amount of smoothing. A first-order filter of 50 ms.
constexpr std::int64_t smoothing_ms = 50;

/// A derivative gain of 10 looks 1 ms ahead (unproven).
constexpr std::int64_t d_gain_per_ms = 10;

std::int64_t approach(std::int64_t from, std::int64_t to) {
  const std::int64_t step = (to - from) / smoothing_ms;
  return step == 0 ? to : from + step;
}

/// The part of a deviation beyond the dead band, from zero without a jump.
std::int64_t beyond(std::int64_t deviation, std::int64_t dead_band) {
  const std::int64_t rest = std::max<std::int64_t>(std::abs(deviation) - dead_band, 0);
  return deviation < 0 ? -rest : rest;
}

/// Requirements 171, 182: more current gives more torque. But it does not turn an unloaded motor
/// faster: the additional effort fades to none at full speed.
std::int64_t greatest_effort(std::int64_t speed, const Tuning& tuning) {
  if (tuning.effort_limit <= full_effort) {
    return tuning.effort_limit;
  }
  const std::int64_t left =
      std::clamp<std::int64_t>(tuning.full_speed - std::abs(speed), 0, tuning.full_speed);
  return full_effort + (tuning.effort_limit - full_effort) * left / tuning.full_speed;
}

} // namespace

std::int64_t angle_effort(std::int64_t deviation, const Tuning& tuning) {
  constexpr std::int64_t deviation_per_effort = 4000; // at a gain of 1
  const std::int64_t rest = std::abs(beyond(deviation, tuning.dead_band));
  const bool boosts = rest > 0 || (deviation != 0 && tuning.boost_in_dead_band);
  const std::int64_t boost = boosts ? tuning.boost : 0;
  const std::int64_t effort =
      std::min(tuning.p_gain * rest / deviation_per_effort + boost, tuning.whole_effort());
  return deviation < 0 ? -effort : effort;
}

void Controller::follow(const Aim& aim, const Position& position, bool smooth) {
  if (!follows_ || mode_ != aim.mode) {
    follows_ = true;
    mode_ = aim.mode;
    integral_ = 0;
    reference_ = aim.mode == Mode::angle   ? position.angle
                 : aim.mode == Mode::speed ? position.speed
                                           : 0;
  }
  reference_ = smooth ? approach(reference_, aim.value) : aim.value;
}

/// Proportional, integral and feed-forward: steady without load, and stiff under one. unproven: the
/// units of 0x30-0x33, and that they combine so.
std::int64_t Controller::speed_control(std::int64_t wanted, const Position& position,
                                       const Tuning& tuning) {
  constexpr std::int64_t proportional = 3;
  constexpr std::int64_t integral_ms = 20;
  constexpr std::int64_t fading_ms = 200;
  const auto as_effort = [&](std::int64_t speed) {
    return speed * full_effort / tuning.full_speed;
  };
  const std::int64_t deviation = beyond(wanted - position.speed, tuning.speed_dead_band);
  integral_ = std::clamp(integral_, -tuning.integral_limit, tuning.integral_limit);
  const std::int64_t effort =
      as_effort(wanted + tuning.speed_p.of(proportional * deviation)) + integral_;
  const std::int64_t highest = std::min(tuning.effort_cw, tuning.effort_limit);
  const std::int64_t lowest = std::max(tuning.effort_ccw, -tuning.effort_limit);
  const std::int64_t given = std::clamp(effort, lowest, highest);
  const std::int64_t growth = tuning.speed_i.of(as_effort(deviation)) / integral_ms;
  if (growth == 0) { // the integral of a start fades, so that in the end no speed limit is exceeded
    integral_ -= integral_ / fading_ms;
  } else if (given == effort) { // no windup while the output is limited
    integral_ += growth;
  }
  return given;
}

Drive Controller::step(const Aim& aim, const Position& position, const Tuning& tuning) {
  follow(aim, position, tuning.smooth);
  const bool stands = aim.mode != Mode::angle && (aim.value == 0 || !tuning.cascade);
  if (stands) { // 4.2, 4.3: 0 brakes; 4.18: without 0x25 there is neither speed nor torque
    rest();
    return {.kind = Drive::Kind::brake};
  }
  const auto limited = [&](std::int64_t speed) {
    return std::clamp(speed, tuning.speed_ccw, tuning.speed_cw);
  };
  std::int64_t effort = 0;
  if (aim.mode == Mode::torque) {
    effort = std::clamp(reference_, tuning.effort_ccw, tuning.effort_cw);
  } else if (aim.mode == Mode::speed) {
    effort = speed_control(limited(reference_), position, tuning);
  } else if (!tuning.cascade) {
    effort = angle_effort(reference_ - position.angle, tuning);
  } else {
    const std::int64_t ahead = position.angle + position.speed * tuning.d_gain / d_gain_per_ms;
    const std::int64_t part = angle_effort(reference_ - ahead, tuning);
    effort = speed_control(limited(tuning.full_speed * part / full_effort), position, tuning);
  }
  const std::int64_t greatest = greatest_effort(position.speed, tuning);
  return {.kind = Drive::Kind::on, .effort = std::clamp(effort, -greatest, greatest)};
}

} // namespace blactl::sim
