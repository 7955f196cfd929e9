#pragma once
// What takes a change back.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/state/snapshot_store.hpp"

#include <optional>
#include <vector>

namespace blactl::fleet {

/// What is wanted of the servo of this entry so that it holds what it held before: in RAM, and in
/// ROM too where the change was saved. Errors: bad_file (a register that is no setting: the entry
/// is from a file, and must move nothing), and those of bla::make_assignment().
[[nodiscard]] Result<Wanted> to_undo(const state::SnapshotEntry& entry,
                                     const bla::Profiles& profiles);

/// A change that undo takes back.
struct Undoing {
  state::SnapshotEntry entry;
  bool goes_on = false; ///< an undo of it has begun and did not end
};

/// The last change of this unit; empty: none is known. Of an undo that did not end, what it was to
/// take back. Errors: those of the store.
[[nodiscard]] Result<std::optional<Undoing>> last_change(const state::SnapshotStore& store,
                                                         const dronecan::UniqueId& unique_id);

/// The changes of the last command; where that is an undo which did not end, what is left of those
/// that it was to take back. Errors: those of the store.
[[nodiscard]] Result<std::vector<Undoing>> last_changes(const state::SnapshotStore& store);

} // namespace blactl::fleet
