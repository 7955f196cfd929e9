// A servo from the command to the shaft.

#include "blactl/fleet/doctor/motion.hpp"

#include "fleet/doctor/motion_findings.hpp"

#include <array>

namespace blactl::fleet {

namespace at = bla::address;

std::vector<const bla::Parameter*> registers_of_motion(const Servo& servo) {
  return servo.identity.registers(std::array{
      at::command_angle,
      at::command_speed,
      at::command_torque,
      at::current_speed,
      at::current_torque,
      at::current_temperature,
      at::current_voltage,
      at::fault_summary,
      at::fault_notice,
      at::fault_warning,
      at::fault_failure,
      at::torque_output,
      at::soft_start,
      at::speed_torque_control,
      at::timeout_action,
      at::timeout_time,
      at::pwm_output_range,
      at::pwm_mode,
      at::angle_limit_cw,
      at::angle_limit_ccw,
      at::speed_limit_cw,
      at::speed_limit_ccw,
      at::torque_limit_cw,
      at::torque_limit_ccw,
      at::temperature_limit_high,
      at::temperature_limit_low,
      at::voltage_limit_high,
      at::voltage_limit_low,
  });
}

Diagnoses diagnose_motion(const Snapshot& servo, const HeardCommands& heard,
                          const bla::Profiles& profiles, MotionLook look, const bla::Values& rom) {
  const MotionFacts facts(servo, heard, profiles, rom);
  MotionFindings found(servo.servo.id, look);
  find_in_commands(facts, found);
  find_in_output(facts, found);
  return found.take();
}

} // namespace blactl::fleet
