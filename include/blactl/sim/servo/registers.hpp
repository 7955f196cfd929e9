#pragma once
// The memory of a simulated servo: registers that keep their own ranges (chapters 3 and 4), and the
// ROM behind those that are saved (4.11).

#include "blactl/bla/parameter.hpp"
#include "blactl/sim/servo/servo_setup.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace blactl::sim {

class Registers {
 public:
  /// As at power-on: ROM from the factory and the setup, RAM from ROM and the setup.
  explicit Registers(const ServoSetup& setup);

  /// The register at this address; null if this model with this firmware has none.
  [[nodiscard]] const bla::Parameter* existing(bla::Address address) const;

  /// What the servo answers to a read; empty: a failure.
  [[nodiscard]] std::optional<std::int64_t> read(bla::Address address) const;

  /// What the servo answers to a write: the value that is true afterwards; empty: a failure.
  /// 0x10-0x12 keep nothing: the answer is the value that was taken, 1 is an order to the servo.
  /// (unproven: what they answer; the vendor's updater waits for an answer to 0x12 of any value.)
  [[nodiscard]] std::optional<std::int64_t> write(bla::Address address, std::int64_t value);

  /// Whether write() takes a value, be it as the nearest in range: else it changes nothing.
  [[nodiscard]] bool takes(bla::Address address, std::int64_t value) const;

  /// 0x25, or what a firmware without it does (Behaviour::speed_control_before_1100).
  [[nodiscard]] bool controls_speed() const;

  /// Requirement 180: from now on commands are taken as if 0x25 were on; what it holds stays.
  void act_with_speed_control(bool act) { acts_with_speed_control_ = act; }

  /// One of 0x00-0x02 gets a value, or the nearest in range; the others become not active
  /// (requirement 114).
  void command(bla::Address address, std::int64_t value);

  /// The servo itself changes what it shows: readings, fault bits, a command that it gives up.
  void set(bla::Address address, std::int64_t value) { store(address, value); }

  /// The number in a register, also where read() would fail; 0 where there is none.
  [[nodiscard]] std::int64_t value(bla::Address address) const;

  /// The number that ROM holds for a saved register; 0 for others.
  [[nodiscard]] std::int64_t rom_value(bla::Address address) const;

  /// 4.11: what RAM holds of the saved registers goes to ROM.
  void save();

  /// 4.9: the saved registers and the commands 0x00-0x02 get their defaults; ROM keeps its own.
  void initialize();

  /// 4.10: as after power-on, from ROM. What is measured, the fault bits and what the factory wrote
  /// stay.
  void restart();

 private:
  [[nodiscard]] bool disabled_command(bla::Address address) const;
  [[nodiscard]] bool fails(const bla::Parameter& parameter, std::int64_t value) const;
  void power_on(const ServoSetup& setup);
  void store(bla::Address address, std::int64_t value);

  static constexpr std::size_t count = 0x60;

  const bla::Profile* profile_;
  std::int64_t firmware_version_;
  Behaviour behaviour_;
  bool acts_with_speed_control_ = false;
  std::array<std::int64_t, count> values_{};
  std::array<std::int64_t, count> rom_{}; ///< only of the saved registers
};

} // namespace blactl::sim
