#pragma once
// The memory of a simulated servo: registers that enforce their ranges (chapters 3 and 4), and the
// ROM behind the saved ones (4.11).

#include "blactl/bla/parameter.hpp"
#include "blactl/sim/servo/servo_setup.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace blactl::sim {

class Memory {
 public:
  /// The state at power-on: ROM from the factory and the setup, RAM from ROM and the setup.
  explicit Memory(const ServoSetup& setup);

  /// The register at this address; null if this model with this firmware has none.
  [[nodiscard]] const bla::Parameter* existing(bla::Address address) const;

  /// The response to a read; empty: a failure.
  [[nodiscard]] std::optional<std::int64_t> read(bla::Address address) const;

  /// The response to a write: the value in effect afterwards; empty: a failure. 0x10-0x12 store
  /// nothing: the response is the accepted value, and 1 is an order to the servo. (unproven: their
  /// response; the vendor's updater waits for a response to 0x12 of any value.)
  [[nodiscard]] std::optional<std::int64_t> write(bla::Address address, std::int64_t value);

  /// Whether write() accepts a value, perhaps as the nearest in range; else it changes nothing.
  [[nodiscard]] bool takes(bla::Address address, std::int64_t value) const;

  /// The value that a command of ArrayCommand sets 0x00-0x02 to; empty: none, it is ignored.
  [[nodiscard]] std::optional<std::int64_t> from_array(bla::Address address,
                                                       std::int64_t value) const;

  /// The value of a setting that acts: its own, or for 0x23, 0x27, 0x44, 0x45 that of the last
  /// start (Behaviour::settings_wait_for_start).
  [[nodiscard]] std::int64_t in_effect(bla::Address address) const;

  /// The servo starts: from now on the present settings are in effect.
  void start() { at_start_ = values_; }

  /// 0x25, or the equivalent of a firmware without it (Behaviour::speed_control_before_1100).
  [[nodiscard]] bool controls_speed() const;

  /// Requirement 180: from now on commands are accepted as if 0x25 were on; its value stays.
  void act_with_speed_control(bool act) { acts_with_speed_control_ = act; }

  /// Sets one of 0x00-0x02 to a value, or the nearest in range; the others become not active
  /// (requirement 114).
  void command(bla::Address address, std::int64_t value);

  /// Sets a register on behalf of the servo: readings, fault bits, a command that it drops.
  void set(bla::Address address, std::int64_t value) { store(address, value); }

  /// The number in a register, even if read() would fail; 0 if there is no such register.
  [[nodiscard]] std::int64_t value(bla::Address address) const;

  /// The number in ROM for a saved register; 0 for others.
  [[nodiscard]] std::int64_t rom_value(bla::Address address) const;

  /// 4.11: copies the saved registers from RAM to ROM.
  void save();

  /// 4.9: sets the saved registers and the commands 0x00-0x02 to their defaults; ROM is not
  /// changed.
  void initialize();

  /// ERASE and 0x10: initialize(), and ROM as well if Behaviour says so.
  void erase();

  /// 4.10: reloads from ROM, as after power-on. Readings, fault bits and factory data stay.
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
  std::array<std::int64_t, count> rom_{}; ///< saved registers only
  std::array<std::int64_t, count> at_start_{};
};

} // namespace blactl::sim
