#include "blactl/sim/servo/motion.hpp"

#include "sim/servo/names.hpp"
#include "sim/servo/protection.hpp"
#include "sim/servo/rounded.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::sim {

using namespace std::chrono_literals;
using bla::Address;

namespace {

/// -AB models, with a firmware that supports it.
bool has_pwm_input(const ServoSetup& setup) {
  const bla::Parameter* range = setup.profile->find(address::pwm_range);
  return setup.profile->pwm && range != nullptr && range->exists_in(setup.firmware_version);
}

/// 0x00-0x02 and 0x20: the commands that count for 4.19.
bool is_command(Address address) {
  return address <= address::command_torque || address == address::torque_output;
}

} // namespace

Motion::Motion(const ServoSetup& setup, Memory& registers, Time power_on)
    : registers_(registers), behaviour_(setup.behaviour), has_pwm_input_(has_pwm_input(setup)),
      motor_(motor_of(setup)), world_(world_of(setup)), grid_(power_on) {
  frame_.set(is_reversed(), origin_decideg());
  heed_registers();
  shaft_.angle = frame_.shaft_angle(registers.value(address::current_angle));
  shaft_.speed = frame_.sign() * registers.value(address::current_speed) * speed_per_rpm;
}

void Motion::start(Time now) {
  advance_to(now);
  registers_.start();
  heed_registers();
  runs_ = true;
  stopped_ = false;
  frame_.wrap(shaft_);
  timer_.start(now, behaviour_.pwm_waits_after_start);
  soft_start_ =
      registers_.value(address::soft_start) != 0 && registers_.value(address::torque_output) == 0;
  soft_start_cut_ = false;
  if (!soft_start_) {
    start_in_place();
  }
  look(now);
}

void Motion::stop(Time now, bool without_supply) {
  advance_to(now);
  runs_ = soft_start_ = false;
  told_commands_.reset();
  world_.warnings &= ~fault::restart_warnings;
  if (without_supply || !behaviour_.restart_keeps_failures) {
    kept_failures_ = 0;
    world_.failures &= ~fault::restart_failures;
  }
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
  const bool obeys = is_command(address) && registers_.takes(address, value);
  const std::int64_t before = registers_.value(address);
  auto answer = registers_.write(address, value);
  if (obeys) {
    told_commands_.reset();
    timer_.commanded_by_can(now, true, silences_pwm(address));
    obey(address, before);
    answer = registers_.value(address);
  } else if (address == address::speed_torque_control && before != 0) {
    drop_disabled_command();
  }
  look(now);
  return answer;
}

void Motion::command(const MotionCommand& command, Time now) {
  look(now);
  const auto value = registers_.from_array(command.address, command.value);
  if (!value) {
    return;
  }
  if (behaviour_.array_command_shows) {
    told_commands_.reset();
  } else if (!told_commands_) {
    told_commands_ = {registers_.value(address::command_angle),
                      registers_.value(address::command_speed),
                      registers_.value(address::command_torque)};
  }
  const std::int64_t before = registers_.value(command.address);
  registers_.command(command.address, *value);
  timer_.commanded_by_can(now, behaviour_.array_command_feeds_timeout,
                          silences_pwm(command.address));
  obey(command.address, before);
  look(now);
}

void Motion::initialize(Time now) {
  look(now);
  const bool was_on = registers_.value(address::torque_output) == 0;
  registers_.erase();
  told_commands_.reset();
  holds_ = false;
  heed_registers();
  if (!was_on && behaviour_.erase_holds) { // requirement 132: this switches 0x20 on
    give_up_command();
  }
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
  registers_.act_with_speed_control(soft_start_ && behaviour_.soft_start_keeps_speed);
  frame_.change(is_reversed(), origin_decideg(), shaft_);
  if (has_pwm_input_) {
    pulse_ = read_pulse(world_.pulse_us, registers_, behaviour_.pwm_end_points_move);
  }
}

bool Motion::is_reversed() const {
  return registers_.in_effect(address::reverse) != 0;
}

/// 0x44 as an angle of the shaft, CW of the horn notch.
std::int64_t Motion::origin_decideg() const {
  const std::int64_t origin = registers_.in_effect(address::origin);
  return is_reversed() && behaviour_.reverse_turns_origin ? -origin : origin;
}

void Motion::advance_to(Time now) {
  constexpr Duration grid = 1ms;
  heed_registers();
  while (grid_ + grid <= now) {
    grid_ += grid;
    if (!step()) { // nothing changes until the next event that time alone brings
      const Time until = std::min(now, timer_.next_change(grid_, timeout()) - Duration(1));
      grid_ += until > grid_ ? (until - grid_) / grid * grid : Duration::zero();
    }
  }
  if (runs_) {
    (void)obey_pulse(); // pulses continued meanwhile
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
  Faults faults = present_faults(registers_, world_, behaviour_, soft_start_);
  if (behaviour_.failures_latch) {
    kept_failures_ |= faults.failure & fault::hardware_failures;
  }
  registers_.set(address::fault_notice, faults.notice | pulse_.notices);
  registers_.set(address::fault_warning, faults.warning);
  registers_.set(address::fault_failure, faults.failure | kept_failures_);
}

/// Requirements 136, 161, 162, 170. Returns whether something changed.
bool Motion::protect() {
  const bool stops =
      stops_motor(registers_, world_, behaviour_, registers_.value(address::fault_failure));
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

} // namespace blactl::sim
