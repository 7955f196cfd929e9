#pragma once
// The faults of servos at one time: 0x18-0x1B, and the values behind their bits.

#include "blactl/base/error.hpp"
#include "blactl/bla/faults.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/snapshot.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace blactl::fleet {

struct FaultState {
  Snapshot snapshot;
  std::vector<bla::Fault> faults;         ///< the worst first
  std::optional<dronecan::Health> health; ///< of its NodeStatus
  std::vector<Error> errors;              ///< why it is incomplete; empty: complete

  /// The value of one of 0x18-0x1B; empty: unknown.
  [[nodiscard]] std::optional<std::int64_t> fault_register(bla::Address reg) const;

  /// The worst level; empty: no bit is known to be set.
  [[nodiscard]] std::optional<bla::Level> worst() const;

  /// The registers related to a fault, as far as they were read.
  [[nodiscard]] std::vector<Reading> values_of(const bla::Fault& fault) const;
};

} // namespace blactl::fleet
