#pragma once
// The next transfer ID for every transfer descriptor that this node uses.

#include "blactl/dronecan/ids.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>

namespace blactl::dronecan {

/// Counts modulo 32 for each (kind, data type, destination), as the specification 4.1 demands: a
/// strict receiver takes a repeated transfer ID within 2 s for a duplicate. The counters live in
/// the caller's memory, so that the next process can continue where this one stopped.
class TransferIds {
 public:
  /// One counter; all zero: free.
  struct Slot {
    std::uint32_t key;
    std::uint32_t next;
  };

  static constexpr std::size_t slots = 1024;

  /// `table` outlives this object. `first` is where a counter without a slot starts; `changed` is
  /// called with the index of each slot that counted.
  explicit TransferIds(std::span<Slot, slots> table, TransferId first = 0,
                       std::function<void(std::size_t)> changed = {})
      : table_(table), first_(first), changed_(std::move(changed)) {}

  /// The ID for the next transfer of this descriptor; counts it as used.
  [[nodiscard]] TransferId next(Kind kind, std::uint16_t data_type_id, NodeId destination);

 private:
  std::span<Slot, slots> table_;
  TransferId first_;
  std::function<void(std::size_t)> changed_;
};

} // namespace blactl::dronecan
