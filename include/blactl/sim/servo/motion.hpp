#pragma once
// The motion of a simulated servo: commands, readings, protection, soft start, timeouts (chapter
// 4). Without CAN: it has only registers and surroundings.

#include "blactl/base/time.hpp"
#include "blactl/sim/servo/angle_frame.hpp"
#include "blactl/sim/servo/array_entry.hpp"
#include "blactl/sim/servo/command_timer.hpp"
#include "blactl/sim/servo/controller.hpp"
#include "blactl/sim/servo/memory.hpp"
#include "blactl/sim/servo/motor.hpp"
#include "blactl/sim/servo/pwm_input.hpp"
#include "blactl/sim/servo/servo_setup.hpp"
#include "blactl/sim/servo/shaft.hpp"
#include "blactl/sim/servo/world.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace blactl::sim {

/// Computed in steps of 1 ms from power-on, and only on demand; the result does not depend on how
/// often it is demanded. While nothing moves, time costs nothing.
class Motion {
 public:
  /// `registers` must outlive this. The motor is off until start().
  Motion(const ServoSetup& setup, Memory& registers, Time power_on);

  /// The servo begins to run: the angle comes back within one turn (requirement 46), then soft
  /// start.
  void start(Time now);

  /// The servo goes down: the motor is off. The cause of its last restart by itself is cleared, of
  /// 0x1B perhaps only if the supply was lost (Behaviour::restart_keeps_failures).
  void stop(Time now, bool without_supply = false);

  /// Brings the readings 0x08-0x0C and 0x18-0x1B up to `now`.
  void look(Time now);

  /// GetSet, as in Memory.
  [[nodiscard]] std::optional<std::int64_t> read(bla::Address address, Time now);
  std::optional<std::int64_t> write(bla::Address address, std::int64_t value, Time now);

  /// ArrayCommand.
  void command(const MotionCommand& command, Time now);

  /// ERASE and 0x10 (4.9).
  void initialize(Time now);

  [[nodiscard]] const World& world() const { return world_; }

  /// Changes the surroundings of the servo.
  void surround(const World& world, Time now);

  [[nodiscard]] const Shaft& shaft() const { return shaft_; }

 private:
  // Requests (motion.cpp).
  void advance_to(Time now);
  void heed_registers();
  [[nodiscard]] bool is_reversed() const;
  [[nodiscard]] std::int64_t origin_decideg() const;
  void forget_turns();
  void measure();
  bool protect();

  // Effects of a command (motion_command.cpp).
  void obey(bla::Address address, std::int64_t before);
  void give_up_command();
  void start_in_place();
  void limit_command();
  void drop_disabled_command();
  [[nodiscard]] bool silences_pwm(bla::Address address) const;
  void end_soft_start();
  [[nodiscard]] std::optional<std::int64_t> told_instead(bla::Address address) const;

  // One millisecond (motion_step.cpp).
  bool step();
  bool obey_pulse();
  [[nodiscard]] Drive drive();
  [[nodiscard]] Drive::Kind output() const;
  [[nodiscard]] Mode mode() const;
  [[nodiscard]] Aim aim() const;
  [[nodiscard]] std::int64_t inside_limits(std::int64_t decideg) const;
  void heed_soft_start(Drive::Kind kind);
  [[nodiscard]] Duration timeout() const;

  [[nodiscard]] Position position() const { return frame_.position(shaft_); }

  [[nodiscard]] std::int64_t angle_decideg() const { return frame_.decideg(shaft_); }

  Memory& registers_;
  Behaviour behaviour_;
  bool has_pwm_input_;
  Motor motor_;

  // Of the registers and surroundings as last changed.
  PulseReading pulse_{};
  Tuning tuning_;
  AngleFrame frame_;

  World world_;
  Shaft shaft_;
  Controller controller_;
  Drive drive_;
  CommandTimer timer_;
  std::optional<std::array<std::int64_t, 3>> told_commands_; ///< reads of 0x00-0x02, if hidden
  Time grid_;                                                ///< of the last step
  std::int64_t kept_failures_ = 0;                           ///< those latched until the next start
  bool runs_ = false;
  bool stopped_ = false; ///< by the protection
  bool holds_ = false;   ///< 0x00, inside its angle limits or not, until the next command
  bool soft_start_ = false;
  bool soft_start_cut_ = false; ///< by a timeout; it resumes with the next command
};

} // namespace blactl::sim
