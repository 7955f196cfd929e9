#pragma once
// The table of dynamic node ID allocations that outlives a process.
// DroneCAN specification 6, uavcan/protocol/dynamic_node_id/1.Allocation.uavcan.

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

/// What may be given to units: 126 and 127 are for tools (1.Allocation.uavcan).
inline constexpr dronecan::NodeId first_dynamic_id{1};
inline constexpr dronecan::NodeId last_dynamic_id{125};

/// One unit and the node ID that it has for ever.
struct AllocationEntry {
  dronecan::NodeId node_id;
  dronecan::UniqueId unique_id{};
  WallTime at; ///< when it got this ID

  friend bool operator==(const AllocationEntry&, const AllocationEntry&) = default;
};

/// Which node ID a unit gets that is not in the table yet.
struct AllocationChoice {
  dronecan::NodeId preferred{}; ///< by the unit; 0: it does not mind, as Futaba's (table 2-7)
  NodeIds taken{};              ///< in use on the bus, by whomever
  dronecan::NodeId first = first_dynamic_id; ///< of the range to choose from
  dronecan::NodeId last = last_dynamic_id;   ///< of it, included
};

/// Which unit has which node ID, in `allocations.db` of a folder: an SQLite database that several
/// processes use at once. What a function has told is on the disk. A unit keeps its ID until the
/// user forgets it or wishes another one.
///
/// A file that is not ours, is damaged or was made by a newer blactl is an error and stays as it
/// is, byte for byte.
///
/// Errors of every function: bad_file (no table of ours, damaged, of a newer blactl), permission,
/// io (also a full disk: then nothing has changed), busy (another process wrote for longer than
/// our patience). A store is used by one thread and must not be carried through a fork().
class AllocationStore {
 public:
  using Access = state::Access;

  /// `folder`: what state_folder() said. Errors beside those of all: state: it is empty.
  [[nodiscard]] static Result<AllocationStore>
  open(const std::string& folder, Access access,
       std::chrono::milliseconds patience = usual_patience);

  /// For a bus that no other process can reach: an empty table that ends with this object.
  [[nodiscard]] static Result<AllocationStore> unshared();

  /// As open() and unshared() make it.
  explicit AllocationStore(std::unique_ptr<StateFile> file);

  AllocationStore(const AllocationStore&) = delete;
  AllocationStore& operator=(const AllocationStore&) = delete;
  AllocationStore(AllocationStore&&) noexcept;
  AllocationStore& operator=(AllocationStore&&) noexcept;
  ~AllocationStore();

  /// All of the table, by node ID.
  [[nodiscard]] Result<std::vector<AllocationEntry>> entries() const;

  /// Empty: it is not in the table.
  [[nodiscard]] Result<std::optional<AllocationEntry>>
  find(const dronecan::UniqueId& unique_id) const;
  [[nodiscard]] Result<std::optional<AllocationEntry>> find(dronecan::NodeId node_id) const;

  /// The node ID of this unit. One that is in the table has the ID that stands there, also if that
  /// is in use on the bus or out of the range: what to do then is for the caller to judge. A new
  /// one gets the first that is free from `preferred` (0: 125) upward to the end of the range, else
  /// downward to its begin (1.Allocation.uavcan); never 0, 126 or 127.
  /// Errors: table_full: none of the range is free.
  [[nodiscard]] Result<dronecan::NodeId> assign(const dronecan::UniqueId& unique_id,
                                                const AllocationChoice& choice, WallTime now);

  /// A unit and the ID that the user wishes for it.
  struct Wish {
    dronecan::UniqueId unique_id{};
    dronecan::NodeId node_id;
  };

  /// What becomes of a unit that has an ID which is wished for another one.
  enum class Former : std::uint8_t {
    keeps, ///< its ID: that is an error
    yields ///< and is not in the table any more
  };

  /// Gives units the IDs that the user wishes for them, in place of those that they had: all, or
  /// none of them. They may exchange theirs. Errors: out_of_range: not 1 to 125; duplicate_node_id:
  /// two wishes are for the same, or another unit has it and keeps it.
  [[nodiscard]] Result<void> put(std::span<const Wish> wishes, WallTime now,
                                 Former former = Former::keeps);

  /// Drops this unit; its ID is free. False: it was not in the table.
  [[nodiscard]] Result<bool> forget(const dronecan::UniqueId& unique_id);

  /// The path of its file, also while it is not there; empty: it never is.
  [[nodiscard]] const std::string& path() const;

 private:
  std::unique_ptr<StateFile> file_;
};

} // namespace blactl::state
