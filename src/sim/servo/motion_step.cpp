// One millisecond of a shaft: the active command, and the motor's reaction to it.

#include "blactl/sim/servo/motion.hpp"

#include "sim/servo/names.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>

namespace blactl::sim {

namespace {

/// Of 0x20; in 0x26 the value 1 means to go on.
constexpr std::int64_t output_off = 1, output_brake = 2;

/// Requirement 123: a servo turns at about 10 rpm at least.
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

/// False: nothing changed, and a further step would change nothing either.
bool Motion::step() {
  const Shaft shaft = shaft_;
  const Controller controller = controller_;
  const Drive before = drive_;
  const bool soft_start = soft_start_;
  const bool commanded = runs_ && obey_pulse();
  drive_ = drive();
  const std::int64_t push =
      frame_.sign() * drive_.effort * world_.supply_decivolt / motor_.nominal_decivolt;
  shaft_.step(drive_.kind, push, world_, motor_.full_speed);
  return commanded || soft_start != soft_start_ || drive_ != before || shaft_ != shaft ||
         !(controller_ == controller);
}

/// Requirements 150-157. Returns whether a command changed.
bool Motion::obey_pulse() {
  if (!pulse_.command || !timer_.accepts_pwm(grid_, timeout()) ||
      !registers_.takes(pulse_.command->address, 0)) {
    return false;
  }
  timer_.commanded(grid_);
  told_commands_.reset();
  end_soft_start();
  holds_ = false;
  const auto [address, value] = *pulse_.command;
  const std::int64_t before = registers_.value(address);
  if (value == before) {
    return false;
  }
  forget_turns();
  registers_.command(address, value);
  return registers_.value(address) != before;
}

Drive Motion::drive() {
  const Drive::Kind kind = output();
  if (soft_start_) {
    heed_soft_start(kind);
  }
  if (kind != Drive::Kind::on) {
    controller_.rest();
    return {.kind = kind};
  }
  return controller_.step(aim(), position(), tuning_);
}

/// Requirements 141, 143. A soft start that was cut by a timeout resumes with the next command, if
/// Behaviour says so; it ends at its target, or with a command without one.
void Motion::heed_soft_start(Drive::Kind kind) {
  constexpr std::int64_t end_decideg = 10;
  if (kind != Drive::Kind::on) {
    const bool by_timeout = !stopped_ && registers_.value(address::torque_output) == 0;
    if (by_timeout && behaviour_.soft_start_resumes) {
      soft_start_cut_ = true;
    } else {
      end_soft_start();
    }
    return;
  }
  const Aim aim = this->aim();
  if (aim.mode != Mode::angle ||
      std::abs(aim.value - position().angle) <= end_decideg * angle_per_decideg) {
    end_soft_start();
  }
}

/// The state of the motor: protection first, then 0x20, then the timeout.
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
  if (!timer_.timed_out(grid_, timeout())) {
    return set;
  }
  const Drive::Kind action = kind(registers_.value(address::timeout_action));
  const bool lets_go = set == Drive::Kind::brake && action == Drive::Kind::off;
  return set == Drive::Kind::on || (lets_go && behaviour_.timeout_beats_brake) ? action : set;
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
    return {mode, registers_.value(address::command_torque) * tuning_.whole_effort() / 100};
  }
  const std::int64_t commanded = registers_.value(address::command_angle);
  return {mode, (holds_ ? commanded : inside_limits(commanded)) * angle_per_decideg};
}

std::int64_t Motion::inside_limits(std::int64_t decideg) const {
  return std::clamp(decideg, registers_.value(address::angle_limit_ccw),
                    registers_.value(address::angle_limit_cw));
}

Duration Motion::timeout() const {
  return std::chrono::milliseconds(registers_.in_effect(address::timeout_time));
}

} // namespace blactl::sim
