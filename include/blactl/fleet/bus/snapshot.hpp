#pragma once
// The registers of one servo at one moment: plain data, from any source.

#include "blactl/base/error.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/parameter.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// One register: its number, narrowed to its width, or the reason why it is unknown.
struct Reading {
  const bla::Parameter* parameter = nullptr;
  Result<std::int64_t> raw;
};

struct Snapshot {
  Servo servo{};
  std::vector<Reading> readings{}; ///< in the order of the requests
  /// The servo restarted while it was read: changes in RAM only are lost.
  bool has_restarted = false;
  /// The reason why nothing was read: the node was not identified, is not a BLA servo, or was
  /// refused.
  std::optional<Error> error{};

  /// The value of register `address`, if it was read.
  [[nodiscard]] std::optional<std::int64_t> raw(bla::Address address) const;

  /// 0x37, on which the unit of 0x36 depends; empty: not read.
  [[nodiscard]] std::optional<std::int64_t> pwm_mode() const;

  /// All values read.
  [[nodiscard]] bla::Values values() const;

  /// The first reason why it is incomplete; empty: complete.
  [[nodiscard]] std::optional<Error> first_error() const;

  /// All errors; everything missing in a recording is one error.
  [[nodiscard]] std::vector<Error> errors() const;
};

/// Compares `after` with the expected values. Errors: mismatch with the registers that differ; the
/// reason why it is incomplete.
[[nodiscard]] std::optional<Error> compare(const Snapshot& after, const bla::Values& expected);

/// 0x36 in deg or rpm must agree with 0x37: with the servo's, unless one is wanted beside it.
/// Errors: usage.
[[nodiscard]] std::optional<Error> check_unit(std::span<const bla::Assignment> wanted,
                                              const Snapshot& before,
                                              const bla::Profiles& profiles);

/// The register that shows after a restart whether ROM could be read (4.12); null: there is none.
[[nodiscard]] const bla::Parameter* rom_state(const bla::Identity& servo);

/// Errors: mismatch, if that register was read and shows that ROM was unreadable, so that the servo
/// holds initial values.
[[nodiscard]] std::optional<Error> check_rom(const Snapshot& after);

} // namespace blactl::fleet
