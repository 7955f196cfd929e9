#include "blactl/sim/motion.hpp"

#include "sim/addresses.hpp"
#include "sim/fault_bits.hpp"
#include "sim/protection.hpp"
#include "sim/rounded.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::sim {

using namespace std::chrono_literals;
using bla::Address;

namespace {

/// -AB models, with a firmware that knows.
bool has_pwm_input(const ServoSetup& setup) {
  const bla::Parameter* range = setup.profile->find(address::pwm_range);
  return setup.profile->pwm && range != nullptr && range->exists_in(setup.firmware_version);
}

/// 0x00-0x02 and 0x20: what a servo takes for a command (4.19).
bool commands(Address address) {
  return address <= address::command_torque || address == address::torque_output;
}

} // namespace

Motion::Motion(const ServoSetup& setup, Registers& registers, Time power_on)
    : registers_(registers), behaviour_(setup.behaviour), has_pwm_input_(has_pwm_input(setup)),
      motor_(motor_of(setup)), world_(world_of(setup)), grid_(power_on) {
  heed_registers();
  shaft_.angle = frame_.shaft_angle(registers.value(address::current_angle));
  shaft_.speed = frame_.sign() * registers.value(address::current_speed) * speed_per_rpm;
}

void Motion::start(Time now) {
  advance_to(now);
  runs_ = true;
  stopped_ = false;
  frame_.wrap(shaft_);
  timer_.start(now, behaviour_.pwm_waits_after_start);
  soft_start_ =
      registers_.value(address::soft_start) != 0 && registers_.value(address::torque_output) == 0;
  if (!soft_start_) {
    give_up_command(); // requirement 138: the torque comes on in place
  }
  look(now);
}

void Motion::stop(Time now) {
  advance_to(now);
  runs_ = soft_start_ = false;
  told_commands_.reset();
  kept_failures_ = 0;
  world_.warnings &= ~fault::restart_warnings;
  world_.failures &= ~fault::restart_failures;
}

void Motion::look(Time now) {
  advance_to(now);
  measure();
  if (protect()) {
    measure();
  }
}

std::optional<std::int64_t> Motion::read(Address address, Time now) {
  look(now);
  if (behaviour_.get_set_feeds_timeout) {
    timer_.commanded(now);
  }
  const auto told = told_instead(address);
  return told ? told : registers_.read(address);
}

std::optional<std::int64_t> Motion::write(Address address, std::int64_t value, Time now) {
  look(now);
  if (behaviour_.get_set_feeds_timeout) {
    timer_.commanded(now);
  }
  const bool obeys = commands(address) && registers_.takes(address, value);
  const std::int64_t before = registers_.value(address);
  const auto answer = registers_.write(address, value);
  if (obeys) {
    told_commands_.reset();
    timer_.commanded_by_can(now, true);
    obey(address, before);
  }
  look(now);
  return answer;
}

void Motion::command(const MotionCommand& command, Time now) {
  look(now);
  if (!registers_.takes(command.address, command.value)) {
    return;
  }
  if (!behaviour_.array_command_shows && !told_commands_) {
    told_commands_ = {registers_.value(address::command_angle),
                      registers_.value(address::command_speed),
                      registers_.value(address::command_torque)};
  }
  const std::int64_t before = registers_.value(command.address);
  (void)registers_.write(command.address, command.value);
  timer_.commanded_by_can(now, behaviour_.array_command_feeds_timeout);
  obey(command.address, before);
  look(now);
}

void Motion::initialize(Time now) {
  look(now);
  registers_.initialize();
  told_commands_.reset();
  look(now);
}

void Motion::surround(const World& world, Time now) {
  advance_to(now);
  world_ = world;
  look(now);
}

void Motion::heed_registers() {
  tuning_ = tuning_of(motor_, registers_, soft_start_);
  tuning_.boost_in_dead_band = behaviour_.boost_in_dead_band;
  frame_.set(registers_.value(address::reverse) != 0, registers_.value(address::origin));
  if (has_pwm_input_) {
    pulse_ = read_pulse(world_.pulse_us, registers_, behaviour_.pwm_end_points_move);
  }
}

void Motion::advance_to(Time now) {
  constexpr Duration grid = 1ms;
  heed_registers();
  while (grid_ + grid <= now) {
    grid_ += grid;
    if (!step()) { // nothing will happen by itself until time alone brings something
      const Time until = std::min(now, timer_.next_change(grid_, timeout()) - Duration(1));
      grid_ += until > grid_ ? (until - grid_) / grid * grid : Duration::zero();
    }
  }
  if (runs_) {
    (void)obey_pulse(); // pulses went on while nothing happened
  }
}

/// Requirement 124.
void Motion::forget_turns() {
  if (mode() != Mode::angle && registers_.value(address::extended_angle) == 0) {
    frame_.wrap(shaft_);
  }
}

void Motion::measure() {
  forget_turns();
  const auto show = [this](Address address, std::int64_t value, std::int64_t low,
                           std::int64_t high) {
    registers_.set(address, std::clamp(value, low, high));
  };
  // The ranges of table 3-2.
  show(address::current_angle, angle_decideg(), -360'000'000, 360'000'000);
  show(address::current_speed, rounded(position().speed, speed_per_rpm), -300, 300);
  show(address::current_torque, rounded(drive_.effort, effort_per_percent), -150, 150);
  show(address::current_temperature, world_.board_celsius, -40, 120);
  show(address::current_voltage, world_.supply_decivolt, 0, 500);
  Faults faults = present_faults(registers_, world_, behaviour_);
  if (behaviour_.failures_latch) {
    kept_failures_ |= faults.failure & fault::hardware_failures;
  }
  registers_.set(address::fault_notice, faults.notice | pulse_.notices);
  registers_.set(address::fault_warning, faults.warning);
  registers_.set(address::fault_failure, faults.failure | kept_failures_);
}

/// Requirements 136, 161, 162, 170. Whether something changed.
bool Motion::protect() {
  const bool stops = stops_motor(registers_, behaviour_, registers_.value(address::fault_failure));
  if (!runs_ || stops == stopped_) {
    return false;
  }
  stopped_ = stops;
  end_soft_start();
  if (!stops) {
    give_up_command();
  }
  return true;
}

/// A command was taken; `before` it the register held that.
void Motion::obey(Address address, std::int64_t before) {
  end_soft_start();
  if (address != address::torque_output) {
    holds_ = false;
  } else if (before != 0 && registers_.value(address) == 0) {
    give_up_command(); // requirement 132
  }
}

/// Holds the present angle, or brakes (tables of 4.7 and 4.13). unproven: that 0x20 and a start
/// without soft start change the registers as protection does.
void Motion::give_up_command() {
  switch (mode()) {
  case Mode::angle:
    registers_.set(address::command_angle, angle_decideg());
    holds_ = true;
    break;
  case Mode::speed: registers_.set(address::command_speed, 0); break;
  case Mode::torque: registers_.set(address::command_torque, 0); break;
  }
}

void Motion::end_soft_start() {
  if (soft_start_) {
    soft_start_ = false;
    heed_registers();
  }
}

/// What a read tells that is not what the register holds, if the servo is set so.
std::optional<std::int64_t> Motion::told_instead(Address address) const {
  if (told_commands_ && address <= address::command_torque) {
    return told_commands_->at(address.value());
  }
  return soft_start_limit(address);
}

/// What a read of a limit tells while the soft start has its own, if the servo is set to tell it.
std::optional<std::int64_t> Motion::soft_start_limit(Address address) const {
  if (!soft_start_ || !behaviour_.soft_start_shows) {
    return std::nullopt;
  }
  if (address == address::speed_torque_control) {
    return std::int64_t{tuning_.cascade};
  }
  if (address == address::speed_limit_cw) {
    return tuning_.speed_cw / speed_per_rpm;
  }
  if (address == address::speed_limit_ccw) {
    return tuning_.speed_ccw / speed_per_rpm;
  }
  if (address == address::torque_limit_cw) {
    return tuning_.effort_cw / effort_per_percent;
  }
  return address == address::torque_limit_ccw
             ? std::optional(tuning_.effort_ccw / effort_per_percent)
             : std::nullopt;
}

} // namespace blactl::sim
