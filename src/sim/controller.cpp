#include "blactl/sim/controller.hpp"

#include <algorithm>
#include <cstdlib>

namespace blactl::sim {
namespace {

/// unproven: how much smoothing levels a command. A first-order filter of 50 ms.
constexpr std::int64_t smoothing_ms = 50;

/// A derivative gain of 10 looks 1 ms ahead (unproven).
constexpr std::int64_t d_gain_per_ms = 10;

std::int64_t approach(std::int64_t from, std::int64_t to) {
  const std::int64_t step = (to - from) / smoothing_ms;
  return step == 0 ? to : from + step;
}

} // namespace

std::int64_t angle_effort(std::int64_t deviation, const Tuning& tuning) {
  constexpr std::int64_t deviation_per_effort = 4000; // at a gain of 1
  const std::int64_t beyond = std::max<std::int64_t>(std::abs(deviation) - tuning.dead_band, 0);
  const bool boosts = beyond > 0 || (deviation != 0 && tuning.boost_in_dead_band);
  const std::int64_t boost = boosts ? tuning.boost : 0;
  const std::int64_t effort =
      std::min(tuning.p_gain * beyond / deviation_per_effort + boost, full_effort);
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

/// Proportional, integral and feed-forward; steady without load, and stiff under one.
std::int64_t Controller::speed_control(std::int64_t wanted, const Position& position,
                                       const Tuning& tuning) {
  constexpr std::int64_t proportional = 3;
  constexpr std::int64_t integral_ms = 20;
  const auto as_effort = [&](std::int64_t speed) {
    return speed * full_effort / tuning.full_speed;
  };
  const std::int64_t deviation = wanted - position.speed;
  const std::int64_t effort = as_effort(wanted + proportional * deviation) + integral_;
  const std::int64_t highest = std::min(tuning.effort_cw, tuning.effort_limit);
  const std::int64_t lowest = std::max(tuning.effort_ccw, -tuning.effort_limit);
  const std::int64_t given = std::clamp(effort, lowest, highest);
  if (given == effort) { // else it would build up what it cannot give
    integral_ += as_effort(deviation) / integral_ms;
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
  return {.kind = Drive::Kind::on,
          .effort = std::clamp(effort, -tuning.effort_limit, tuning.effort_limit)};
}

} // namespace blactl::sim
