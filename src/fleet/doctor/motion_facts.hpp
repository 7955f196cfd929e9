#pragma once
// What is known of a servo between the command and the shaft, and how it is put into words.

#include "blactl/bla/address.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/fleet/doctor/motion.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace blactl::fleet {

class MotionFacts {
 public:
  using Address = bla::Address;

  /// What 0x25 means for speed, torque, and their limits (4.18, 4.32, 4.33).
  enum class Control : std::uint8_t {
    unknown,
    on,
    off,
    missing ///< not in this firmware: what then holds is unproven
  };

  /// What arrives at the PWM input (4.30).
  enum class Pulses : std::uint8_t {
    unknown, ///< or there is no such input
    none,
    too_short,
    too_long,
    valid
  };

  /// All of them outlive this.
  MotionFacts(const Snapshot& servo, const HeardCommands& heard, const bla::Profiles& profiles,
              const bla::Values& rom)
      : servo_(servo.servo), values_(servo.values()), heard_(heard), profiles_(profiles),
        rom_(rom) {}

  [[nodiscard]] const Servo& servo() const { return servo_; }

  [[nodiscard]] std::uint8_t id() const { return servo_.id.value(); }

  [[nodiscard]] const bla::Values& values() const { return values_; }

  [[nodiscard]] const HeardCommands& heard() const { return heard_; }

  [[nodiscard]] const bla::Profiles& profiles() const { return profiles_; }

  /// Empty: it was not read.
  [[nodiscard]] std::optional<std::int64_t> held(Address reg) const;
  [[nodiscard]] Control control() const;
  [[nodiscard]] Pulses pulses() const;
  [[nodiscard]] bool has_pulses() const;
  [[nodiscard]] bool is_commanded() const;
  /// Whether another register than this one is known not to be commanded: by what is heard, else by
  /// what 0x00-0x02 hold.
  [[nodiscard]] bool is_asked_only(Address reg) const;
  /// The command that sets this, after who commands the servo has stopped. The name only, if what
  /// to set is not known.
  [[nodiscard]] std::string set(Address reg, std::optional<std::int64_t> raw) const;
  /// Likewise, to the factory's values.
  [[nodiscard]] std::string set_defaults(std::span<const Address> registers) const;
  /// The latter command alone.
  [[nodiscard]] std::string defaults_command(std::span<const Address> registers) const;
  /// The value with its unit.
  [[nodiscard]] std::string shown(Address reg, std::int64_t raw) const;
  [[nodiscard]] std::string name_of(Address reg) const;
  /// "speed_limit_cw 60 rpm, torque_limit_cw 50 %"
  [[nodiscard]] std::string listed(std::span<const Address> registers) const;
  /// What the output does after a pause in the commands (4.19); empty: it stays, or is unknown.
  [[nodiscard]] std::string timeout_text() const;

 private:
  [[nodiscard]] std::string setting(Address reg, std::optional<std::int64_t> raw) const;
  [[nodiscard]] std::string command(const std::string& settings,
                                    std::span<const Address> registers) const;
  [[nodiscard]] std::string when_stopped(std::string command) const;
  [[nodiscard]] bool is_in_rom(Address reg) const;

  const Servo& servo_;
  bla::Values values_;
  const HeardCommands& heard_;
  const bla::Profiles& profiles_;
  const bla::Values& rom_; ///< as far as known
};

} // namespace blactl::fleet
