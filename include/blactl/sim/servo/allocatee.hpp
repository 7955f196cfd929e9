#pragma once
// How a servo without a node ID asks for one (section 2.3, tables 2-7 and 2-8).

#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/sim/node/random.hpp"

#include <cstdint>
#include <optional>

namespace blactl::sim {

/// Sends its unique ID in three parts; each goes out only after the allocator has repeated all
/// that came before. Any other Allocation message on the bus makes it start over (DSDL rule C;
/// unproven: the specification only says that a wrong answer does). An answer that it has had
/// already is none of these: two allocators that answer alike both help it.
class Allocatee {
 public:
  Allocatee(const dronecan::UniqueId& unique_id, std::uint64_t seed, Time now);

  /// When the next request goes out.
  [[nodiscard]] Time next_deadline() const { return due_; }

  /// The request to send now, if one is due.
  [[nodiscard]] std::optional<dronecan::Allocation> advance(Time now);

  /// An Allocation message of another node. Returns the node ID when it completes the exchange.
  [[nodiscard]] std::optional<dronecan::NodeId> receive(const dronecan::Allocation& message,
                                                        bool anonymous, Time now);

 private:
  [[nodiscard]] bool begins_with(const dronecan::Allocation& message) const;
  [[nodiscard]] bool repeats(const dronecan::Allocation& message) const;
  [[nodiscard]] Duration request_period();

  dronecan::UniqueId unique_id_;
  Random random_;
  std::uint8_t sent_ = 0;      ///< bytes of the unique ID sent in this exchange: 0, 6, 12, 16
  std::uint8_t confirmed_ = 0; ///< repeated by the allocator, the next part is due: 0, 6, 12
  std::uint8_t answered_ = 0;  ///< repeated by the allocator in this exchange: 0, 6, 12
  Time due_;
};

} // namespace blactl::sim
