#pragma once
// The persistent table of dynamic node ID allocations. DroneCAN specification 6,
// uavcan/protocol/dynamic_node_id/1.Allocation.uavcan.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/state/access.hpp"

#include <bitset>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::state {

class StateFile;

/// A set of node IDs: bit 11 is node ID 11.
using NodeIds = std::bitset<dronecan::NodeId::max + 1>;

/// The IDs that may be given to units: 126 and 127 are for tools (1.Allocation.uavcan).
inline constexpr dronecan::NodeId first_dynamic_id{1};
inline constexpr dronecan::NodeId last_dynamic_id{125};

/// One unit and its permanent node ID.
struct AllocationEntry {
  dronecan::NodeId node_id;
  dronecan::UniqueId unique_id{};
  WallTime at; ///< when it was last given this ID, or seen with it; to an hour

  friend bool operator==(const AllocationEntry&, const AllocationEntry&) = default;
};

/// The choice of a node ID for a unit that is not in the table, or whose ID is lost.
struct AllocationChoice {
  dronecan::NodeId preferred{}; ///< by the unit; 0: no preference, as Futaba's (table 2-7)
  NodeIds taken{};              ///< in use on the bus by any node
  bool is_lost = false;         ///< another node uses the ID that the unit has in the table
  dronecan::NodeId first = first_dynamic_id; ///< of the range to choose from
  dronecan::NodeId last = last_dynamic_id;   ///< of the range, inclusive
};

/// A node ID for a unit.
struct Allocation {
  dronecan::NodeId node_id;
  bool is_new = false; ///< the unit did not have it in the table
  /// The unit which had it, and has none in the table any more: all IDs were in there, and this
  /// unit was not seen for the longest time.
  std::optional<dronecan::UniqueId> former{};

  friend bool operator==(const Allocation&, const Allocation&) = default;
};

/// The node IDs of units, in `allocations.db` of a folder: an SQLite database that several
/// processes use at once. When a function returns, its result is on disk. It is a memory, never a
/// fence: only nodes on the bus stand in the way of an ID.
///
/// A file that is not ours or was made by a newer blactl is an error, and so is damage where it is
/// met (check_state_files() meets all of it). It stays as it is, byte for byte.
///
/// Errors of every function: bad_file (not ours, damaged, of a newer blactl), permission, io (also
/// a full disk: then nothing has changed), busy (another process used it longer than our
/// patience). A store is used by one thread and must not be carried through a fork().
class AllocationStore {
 public:
  using Access = state::Access;

  /// `folder`: from state_folder(). Further errors: state: it is empty.
  [[nodiscard]] static Result<AllocationStore>
  open(const std::string& folder, Access access,
       std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty table that ends with this object.
  [[nodiscard]] static Result<AllocationStore> unshared();

  /// Used by open() and unshared().
  explicit AllocationStore(std::unique_ptr<StateFile> file);

  AllocationStore(const AllocationStore&) = delete;
  AllocationStore& operator=(const AllocationStore&) = delete;
  AllocationStore(AllocationStore&&) noexcept;
  AllocationStore& operator=(AllocationStore&&) noexcept;
  ~AllocationStore();

  /// The whole table, by node ID.
  [[nodiscard]] Result<std::vector<AllocationEntry>> entries() const;

  /// The entry of a unit; empty: it has none.
  [[nodiscard]] Result<std::optional<AllocationEntry>>
  find(const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] Result<std::optional<AllocationEntry>> find(dronecan::NodeId node_id) const;

  /// The node ID of this unit: that of the table, even if it is taken or out of range. If there is
  /// none, or it is lost, the first one from `preferred` (0: 125) upward to the end of the range,
  /// else downward to its beginning (1.Allocation.uavcan), that is neither taken nor in the table;
  /// if there is none, that of the unit which was not seen for the longest time. Never 0, 126 or
  /// 127. A unit in the table needs no disk. Errors: table_full: all IDs of the range are taken.
  [[nodiscard]] Result<Allocation> allocate(const dronecan::UniqueId& unique_id,
                                            const AllocationChoice& choice, WallTime now);

  /// A unit and the ID that the user requests for it.
  struct Wish {
    dronecan::UniqueId unique_id{};
    dronecan::NodeId node_id;
  };

  /// The fate of a unit whose ID is requested for another one.
  enum class Former : std::uint8_t {
    keeps, ///< it keeps its ID: that is an error
    yields ///< it loses its ID, and leaves the table
  };

  /// Assigns the requested IDs in place of the units' present ones: all or none. Units may swap
  /// IDs. Errors: out_of_range: not 1 to 125; duplicate_node_id: two wishes name the same, or
  /// another unit has it and keeps it.
  [[nodiscard]] Result<void> enter(std::span<const Wish> wishes, WallTime now,
                                   Former former = Former::keeps);

  /// Removes this unit and frees its ID. False: it was not in the table.
  [[nodiscard]] Result<bool> forget(const dronecan::UniqueId& unique_id);

  /// The path of its file, even if that does not exist yet; empty: it has none.
  [[nodiscard]] const std::string& path() const;

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
