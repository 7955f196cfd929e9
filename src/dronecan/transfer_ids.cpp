#include "blactl/dronecan/transfer_ids.hpp"

#include <utility>

namespace blactl::dronecan {

TransferId TransferIds::next(Kind kind, std::uint16_t data_type_id, NodeId destination) {
  constexpr std::uint32_t in_use = 0x8000'0000;
  const std::uint32_t key = in_use | static_cast<std::uint32_t>(std::to_underlying(kind)) << 23 |
                            static_cast<std::uint32_t>(data_type_id) << 7 | destination.value();
  const std::size_t home = (key * 2654435769U) >> 22; // Fibonacci hashing to 10 bits
  for (std::size_t i = 0; i < slots; ++i) {
    const std::size_t index = (home + i) % slots;
    Slot& slot = table_[index];
    if (slot.key == 0) {
      slot = {key, first_};
    }
    if (slot.key == key) {
      const auto id = static_cast<TransferId>(slot.next++ % transfer_id_modulus);
      if (changed_) {
        changed_(index);
      }
      return id;
    }
  }
  // More than a thousand descriptors: more than one process of this tool ever talks to.
  return static_cast<TransferId>(first_++ % transfer_id_modulus);
}

} // namespace blactl::dronecan
