#include "dronecan/slot_table.hpp"

#include <algorithm>
#include <bit>

namespace blactl::dronecan {

SlotTable::SlotTable(std::size_t capacity)
    : capacity_(std::max<std::size_t>(capacity, 1)), buckets_(std::bit_ceil(2 * capacity_), none),
      shift_(32U - static_cast<unsigned>(std::countr_zero(buckets_.size()))) {
  slots_.reserve(capacity_);
}

SlotTable::Touched SlotTable::touch(std::uint32_t key) {
  const auto known = buckets_[find_bucket(key)];
  if (known != none) {
    unlink(known);
    link_newest(known);
    return {known, false};
  }
  const auto index = take_slot();
  slots_[index].key = key;
  buckets_[find_bucket(key)] = index;
  link_newest(index);
  return {index, true};
}

SlotTable::Index SlotTable::take_slot() {
  if (slots_.size() < capacity_) {
    slots_.emplace_back();
    return static_cast<Index>(slots_.size() - 1);
  }
  const auto idlest = oldest_;
  forget(slots_[idlest].key);
  unlink(idlest);
  return idlest;
}

// Fibonacci hashing: the multiplier is 2^32 divided by the golden ratio.
std::size_t SlotTable::home(std::uint32_t key) const {
  return (key * 0x9E37'79B9U) >> shift_;
}

// The bucket of the key, or the empty one where it belongs; there is always an empty one.
std::size_t SlotTable::find_bucket(std::uint32_t key) const {
  const auto mask = buckets_.size() - 1;
  auto bucket = home(key);
  while (buckets_[bucket] != none && slots_[buckets_[bucket]].key != key) {
    bucket = (bucket + 1) & mask;
  }
  return bucket;
}

// Closes the gap by moving back the keys behind it that would no longer be found: no tombstones, so
// the table does not slow down however many keys pass through it.
void SlotTable::forget(std::uint32_t key) {
  const auto mask = buckets_.size() - 1;
  auto gap = find_bucket(key);
  for (auto next = (gap + 1) & mask; buckets_[next] != none; next = (next + 1) & mask) {
    const auto wanted = home(slots_[buckets_[next]].key);
    if (((next - wanted) & mask) >= ((next - gap) & mask)) {
      buckets_[gap] = buckets_[next];
      gap = next;
    }
  }
  buckets_[gap] = none;
}

void SlotTable::unlink(Index index) {
  const auto [key, newer, older] = slots_[index];
  (newer == none ? newest_ : slots_[newer].older) = older;
  (older == none ? oldest_ : slots_[older].newer) = newer;
}

void SlotTable::link_newest(Index index) {
  slots_[index].newer = none;
  slots_[index].older = newest_;
  (newest_ == none ? oldest_ : slots_[newest_].newer) = index;
  newest_ = index;
}

} // namespace blactl::dronecan
