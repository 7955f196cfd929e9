// The effects of a command on a servo: it is accepted, limited, dropped, or shown.

#include "blactl/sim/servo/motion.hpp"

#include "sim/servo/names.hpp"
#include "sim/servo/soft_start.hpp"

namespace blactl::sim {

using bla::Address;

/// Obeys an accepted command; `before`: the previous value of the register.
void Motion::obey(Address address, std::int64_t before) {
  const bool goes_on = address == address::torque_output && registers_.value(address) == 0 &&
                       !behaviour_.output_write_ends_soft_start;
  if (!soft_start_cut_ && !goes_on) {
    end_soft_start();
  }
  soft_start_cut_ = false;
  if (address != address::torque_output) {
    holds_ = false;
    limit_command();
  } else if (before != 0 && registers_.value(address) == 0) {
    give_up_command(); // requirement 132
  }
}

/// Holds the present angle, or brakes (tables of 4.7 and 4.13). unproven: that 0x20 and a start
/// without soft start change the registers as the protection does.
void Motion::give_up_command() {
  told_commands_.reset();
  switch (mode()) {
  case Mode::angle:
    registers_.set(address::command_angle, angle_decideg());
    holds_ = true;
    break;
  case Mode::speed: registers_.set(address::command_speed, 0); break;
  case Mode::torque: registers_.set(address::command_torque, 0); break;
  }
}

/// Requirement 138: the torque comes on at the present position of the shaft.
void Motion::start_in_place() {
  give_up_command();
  if (behaviour_.start_angle == StartAngle::zero) {
    told_commands_ = {0, registers_.value(address::command_speed),
                      registers_.value(address::command_torque)};
  }
}

/// Limits 0x00 to the exceeded limit, if Behaviour says so (4.31).
void Motion::limit_command() {
  if (mode() == Mode::angle && !behaviour_.keeps_limited_angle) {
    registers_.set(address::command_angle, inside_limits(registers_.value(address::command_angle)));
  }
}

/// Called when 0x25 goes off: a speed or torque command may be dropped (4.18).
void Motion::drop_disabled_command() {
  if (!registers_.controls_speed() && !behaviour_.keeps_disabled_command && mode() != Mode::angle) {
    give_up_command();
  }
}

/// Whether a command makes PWM wait (4.30, whose heading names 0x00 and 0x01).
bool Motion::silences_pwm(Address address) const {
  return behaviour_.pwm_yields_to_all || address == address::command_angle ||
         address == address::command_speed;
}

void Motion::end_soft_start() {
  soft_start_cut_ = false;
  if (soft_start_) {
    soft_start_ = false;
    heed_registers();
  }
}

/// The value read instead of the register's own, if Behaviour says so.
std::optional<std::int64_t> Motion::told_instead(Address address) const {
  if (told_commands_ && address <= address::command_torque) {
    return told_commands_->at(address.value());
  }
  const bool shows = soft_start_ && behaviour_.soft_start_shows;
  return shows && registers_.existing(address) != nullptr ? soft_start_value(address)
                                                          : std::nullopt;
}

} // namespace blactl::sim
