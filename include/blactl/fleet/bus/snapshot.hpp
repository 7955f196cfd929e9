#pragma once
// What one servo held at one time: plain data, wherever it came from.

#include "blactl/base/error.hpp"
#include "blactl/bla/parameter.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// What one register held: its number, narrowed to its width, or why it is not known.
struct Reading {
  const bla::Parameter* parameter = nullptr;
  Result<std::int64_t> raw;
};

struct Snapshot {
  Servo servo{};
  std::vector<Reading> readings{}; ///< in the order in which they were asked for
  /// The servo restarted while it was read: what was in RAM only is lost.
  bool has_restarted = false;
  /// Why nothing was read: the node was not identified, is no BLA servo, or was refused.
  std::optional<Error> error{};

  /// What register `address` held, if it was read.
  [[nodiscard]] std::optional<std::int64_t> raw(bla::Address address) const;

  /// 0x37, which the unit of 0x36 depends on; empty: it was not read.
  [[nodiscard]] std::optional<std::int64_t> pwm_mode() const;

  /// All that was read.
  [[nodiscard]] bla::Values values() const;

  /// Why it is not complete; empty: it is.
  [[nodiscard]] std::optional<Error> first_error() const;

  /// All that went wrong; what a recording lacks is one error.
  [[nodiscard]] std::vector<Error> errors() const;
};

/// Whether `after` holds what is expected. Errors: mismatch with the registers that differ; the
/// reason why it is not complete.
[[nodiscard]] std::optional<Error> compare(const Snapshot& after, const bla::Values& expected);

/// The register that tells after a restart whether ROM could be read (4.12); null: there is none.
[[nodiscard]] const bla::Parameter* rom_state(const bla::Identity& servo);

/// Errors: mismatch, if that register was read and tells that the servo has found its ROM
/// unreadable and holds initial values.
[[nodiscard]] std::optional<Error> check_rom(const Snapshot& after);

} // namespace blactl::fleet
