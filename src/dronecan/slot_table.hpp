#pragma once
// A bounded map from 32-bit keys to slot numbers which forgets the key that was idle longest.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace blactl::dronecan {

/// Open addressing with linear probing, never more than half full, and a list of the slots in order
/// of use. Memory is allocated by the constructor only.
class SlotTable {
 public:
  /// `capacity`: how many keys are remembered, at least 1 (0 is taken for 1).
  explicit SlotTable(std::size_t capacity);

  struct Touched {
    std::size_t slot; ///< 0..size()-1
    bool fresh;       ///< the key was unknown: the slot is new, or taken from the idlest key
  };

  /// Finds or makes the slot of `key`, which becomes the most recently used.
  [[nodiscard]] Touched touch(std::uint32_t key);

  [[nodiscard]] std::size_t size() const { return slots_.size(); }

  [[nodiscard]] std::size_t capacity() const { return capacity_; }

  [[nodiscard]] std::uint32_t key(std::size_t slot) const { return slots_[slot].key; }

 private:
  /// Indexes into slots_; `none` ends the list.
  using Index = std::uint32_t;
  static constexpr Index none = 0xFFFF'FFFF;

  struct Slot {
    std::uint32_t key = 0;
    Index newer = none;
    Index older = none;
  };

  [[nodiscard]] std::size_t home(std::uint32_t key) const;
  [[nodiscard]] std::size_t find_bucket(std::uint32_t key) const;
  [[nodiscard]] Index take_slot();
  void forget(std::uint32_t key);
  void unlink(Index index);
  void link_newest(Index index);

  std::size_t capacity_;
  std::vector<Slot> slots_;    ///< grows to the capacity within reserved memory
  std::vector<Index> buckets_; ///< a power of two of them
  unsigned shift_;             ///< a 32-bit hash shifted right by this is a bucket
  Index newest_ = none;
  Index oldest_ = none;
};

} // namespace blactl::dronecan
