#pragma once
// The faults of servos at one time: 0x18-0x1B, and the values behind their bits.

#include "blactl/bla/faults.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/carry_out.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Of one servo.
struct FaultState {
  Snapshot snapshot;
  std::vector<bla::Fault> faults;         ///< the worst first
  std::optional<dronecan::Health> health; ///< of its NodeStatus
  std::vector<Error> errors;              ///< why it is not complete; empty: it is

  /// What one of 0x18-0x1B holds; empty: not known.
  [[nodiscard]] std::optional<std::int64_t> fault_register(bla::Address reg) const;

  /// Empty: no bit is set, as far as is known.
  [[nodiscard]] std::optional<bla::Level> worst() const;

  /// The registers that tell more about a fault, as far as they were read.
  [[nodiscard]] std::vector<Reading> values_of(const bla::Fault& fault) const;
};

/// Of several, in the order asked.
struct FaultStates {
  std::vector<FaultState> servos;
  std::optional<Error> broken; ///< why the session ended before
};

/// Reads 0x18 of several servos at once, and of those that it says have faults what tells more. A
/// servo whose NodeStatus tells of more than that is read once more, all four registers; on a
/// recording its faults are not_recorded, as far as none were found.
/// `profiles` outlives the states.
[[nodiscard]] FaultStates read_faults(Session& session, const bla::Profiles& profiles,
                                      std::span<const dronecan::NodeId> servos,
                                      const Identification::Options& options);

} // namespace blactl::fleet
