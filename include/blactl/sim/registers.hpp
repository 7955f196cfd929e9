#pragma once
// The RAM of a simulated servo: registers that keep their own ranges (chapters 3 and 4).

#include "blactl/bla/parameter.hpp"
#include "blactl/sim/scenario.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace blactl::sim {

class Registers {
 public:
  /// Defaults of the model, then what the setup says.
  explicit Registers(const ServoSetup& setup);

  /// What the servo answers to a read; empty: a failure.
  [[nodiscard]] std::optional<std::int64_t> read(bla::Address address) const;

  /// What the servo answers to a write: the value that is true afterwards; empty: a failure.
  [[nodiscard]] std::optional<std::int64_t> write(bla::Address address, std::int64_t value);

  /// The number in a register, also where read() would fail; 0 where there is none.
  [[nodiscard]] std::int64_t value(bla::Address address) const;

 private:
  [[nodiscard]] const bla::Parameter* existing(bla::Address address) const;
  [[nodiscard]] bool disabled_command(bla::Address address) const;
  void load_defaults();
  void store(bla::Address address, std::int64_t value);

  static constexpr std::size_t count = 0x60;

  const bla::Profile* profile_;
  std::int64_t firmware_version_;
  Behaviour behaviour_;
  std::array<std::int64_t, count> values_{};
};

} // namespace blactl::sim
