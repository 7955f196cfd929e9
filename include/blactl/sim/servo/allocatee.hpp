#pragma once
// The allocation request of a servo without a node ID (section 2.3, tables 2-7 and 2-8).

#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/sim/node/random.hpp"

#include <cstdint>
#include <optional>

namespace blactl::sim {

/// Sends its unique ID in three parts; each is sent only after the allocator has repeated all those
/// before. Any other Allocation message on the bus makes it start over (DSDL rule C; unproven: the
/// specification only says so of a wrong response). A response that it has already received is not
/// one of these: two allocators with identical responses both help it.
class Allocatee {
 public:
  Allocatee(const dronecan::UniqueId& unique_id, std::uint64_t seed, Time now);

  /// The time of the next request.
  [[nodiscard]] Time next_deadline() const { return due_; }

  /// The request to send now, if one is due.
  [[nodiscard]] std::optional<dronecan::Allocation> advance(Time now);

  /// Handles an Allocation message of another node. Returns the node ID when the exchange is
  /// complete.
  [[nodiscard]] std::optional<dronecan::NodeId> receive(const dronecan::Allocation& message,
                                                        bool anonymous, Time now);

 private:
  [[nodiscard]] bool begins_with(const dronecan::Allocation& message) const;
  [[nodiscard]] bool repeats(const dronecan::Allocation& message) const;
  [[nodiscard]] Duration request_period();

  dronecan::UniqueId unique_id_;
  Random random_;
  std::uint8_t sent_ = 0;      ///< bytes of the unique ID sent in this exchange: 0, 6, 12, 16
  std::uint8_t confirmed_ = 0; ///< repeated by the allocator, next part is due: 0, 6, 12
  std::uint8_t answered_ = 0;  ///< repeated by the allocator in this exchange: 0, 6, 12
  Time due_;
};

} // namespace blactl::sim
