// One millisecond in the life of a shaft: which command counts, what the motor does about it.

#include "blactl/sim/motion.hpp"

#include "sim/addresses.hpp"
#include "sim/rounded.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>

namespace blactl::sim {

namespace {

/// 0x20; in 0x26 the first means to go on.
constexpr std::int64_t output_off = 1, output_brake = 2;

constexpr std::int64_t turn_decideg = 3600;

/// How often 360 deg must be taken off to come to -180.0 to +179.9 deg.
std::int64_t turns_in(std::int64_t decideg) {
  const std::int64_t from_lowest = decideg + turn_decideg / 2;
  const std::int64_t turns = from_lowest / turn_decideg;
  return from_lowest % turn_decideg < 0 ? turns - 1 : turns;
}

/// Requirement 123: about 10 rpm is the least that a servo can.
std::int64_t possible_rpm(std::int64_t rpm, SlowSpeed slow_speed) {
  constexpr std::int64_t slowest_rpm = 10;
  if (rpm == 0 || std::abs(rpm) >= slowest_rpm) {
    return rpm;
  }
  if (slow_speed == SlowSpeed::stands) {
    return 0;
  }
  return rpm > 0 ? slowest_rpm : -slowest_rpm;
}

} // namespace

/// False: and the same again would change nothing either.
bool Motion::step() {
  const Shaft shaft = shaft_;
  const Controller controller = controller_;
  const Drive before = drive_;
  const bool soft_start = soft_start_;
  const bool commanded = runs_ && obey_pulse();
  drive_ = drive();
  const std::int64_t push = sign() * drive_.effort * world_.supply_decivolt / nominal_decivolt_;
  shaft_.step(drive_.kind, push, world_, full_speed_);
  return commanded || soft_start != soft_start_ || drive_ != before || shaft_ != shaft ||
         !(controller_ == controller);
}

/// Requirements 150-157. Whether it changed a command.
bool Motion::obey_pulse() {
  if (!pulse_.command || !timer_.accepts_pwm(grid_, timeout()) ||
      !registers_.takes(pulse_.command->address, 0)) {
    return false;
  }
  timer_.commanded(grid_);
  end_soft_start();
  const auto [address, value] = *pulse_.command;
  const std::int64_t before = registers_.value(address);
  if (value == before && !holds_) {
    return false;
  }
  holds_ = false;
  registers_.command(address, value);
  return registers_.value(address) != before;
}

Drive Motion::drive() {
  constexpr std::int64_t soft_start_end_decideg = 10; // requirement 141
  const Drive::Kind kind = output();
  if (soft_start_ && (kind != Drive::Kind::on ||
                      std::abs(position().angle) <= soft_start_end_decideg * angle_per_decideg)) {
    end_soft_start();
  }
  if (kind != Drive::Kind::on) {
    controller_.rest();
    return {.kind = kind};
  }
  return controller_.step(aim(), position(), tuning_);
}

/// Whether the motor is on: protection first, then 0x20, then the timeout.
Drive::Kind Motion::output() const {
  if (!runs_ || stopped_) {
    return Drive::Kind::off;
  }
  const auto kind = [](std::int64_t setting) {
    return setting == output_off     ? Drive::Kind::off
           : setting == output_brake ? Drive::Kind::brake
                                     : Drive::Kind::on;
  };
  const Drive::Kind set = kind(registers_.value(address::torque_output));
  if (set == Drive::Kind::on && timer_.timed_out(grid_, timeout())) {
    return kind(registers_.value(address::timeout_action));
  }
  return set;
}

Mode Motion::mode() const {
  if (registers_.value(address::command_angle) != bla::not_active) {
    return Mode::angle;
  }
  return registers_.value(address::command_speed) != bla::not_active ? Mode::speed : Mode::torque;
}

Aim Motion::aim() const {
  const Mode mode = this->mode();
  if (mode == Mode::speed) {
    const std::int64_t rpm =
        possible_rpm(registers_.value(address::command_speed), behaviour_.slow_speed);
    return {mode, rpm * speed_per_rpm};
  }
  if (mode == Mode::torque) {
    return {mode, registers_.value(address::command_torque) * effort_per_percent};
  }
  const std::int64_t commanded = registers_.value(address::command_angle);
  const std::int64_t limited = std::clamp(commanded, registers_.value(address::angle_limit_ccw),
                                          registers_.value(address::angle_limit_cw));
  return {mode, (holds_ ? commanded : limited) * angle_per_decideg};
}

Tuning Motion::tuning() const {
  const auto value = [this](bla::Address address) { return registers_.value(address); };
  Tuning tuning;
  tuning.cascade = soft_start_ || value(address::speed_torque_control) != 0;
  tuning.smooth = value(address::smoothing) != 0;
  tuning.p_gain = value(address::angle_p_gain);
  tuning.d_gain = value(address::angle_d_gain);
  tuning.dead_band = value(address::angle_dead_band) * angle_per_decideg;
  tuning.boost = has_boost_ ? value(address::angle_boost) * effort_per_percent / 10 : 0;
  tuning.speed_cw = value(address::speed_limit_cw) * speed_per_rpm;
  tuning.speed_ccw = value(address::speed_limit_ccw) * speed_per_rpm;
  tuning.effort_cw = value(address::torque_limit_cw) * effort_per_percent;
  tuning.effort_ccw = value(address::torque_limit_ccw) * effort_per_percent;
  if (full_current_ > 0) {
    tuning.effort_limit =
        std::min(value(address::overcurrent_limit) * full_effort / full_current_, full_effort);
  }
  tuning.full_speed = full_speed_;
  if (soft_start_) { // requirement 140
    tuning.speed_cw = 30 * speed_per_rpm;
    tuning.effort_cw = 30 * effort_per_percent;
    tuning.speed_ccw = -tuning.speed_cw;
    tuning.effort_ccw = -tuning.effort_cw;
  }
  return tuning;
}

Duration Motion::timeout() const {
  return std::chrono::milliseconds(registers_.value(address::timeout_time));
}

/// 4.16.
std::int64_t Motion::sign() const {
  return registers_.value(address::reverse) != 0 ? -1 : 1;
}

/// Requirements 127, 128.
Position Motion::position() const {
  const std::int64_t zero = registers_.value(address::origin) + turns_ * turn_decideg;
  return {sign() * (shaft_.angle - zero * angle_per_decideg), sign() * shaft_.speed};
}

std::int64_t Motion::angle_decideg() const {
  return rounded(position().angle, angle_per_decideg);
}

void Motion::wrap() {
  turns_ += sign() * turns_in(angle_decideg());
}

} // namespace blactl::sim
