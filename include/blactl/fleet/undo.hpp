#pragma once
// What takes a change back.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/plan.hpp"
#include "blactl/state/snapshot_store.hpp"

namespace blactl::fleet {

/// What is wanted of the servo of this entry so that it holds what it held before: in RAM, and in
/// ROM too where the change was saved. Errors: bad_file (a register that is no setting: the entry
/// is from a file, and must move nothing), and those of bla::make_assignment().
[[nodiscard]] Result<Wanted> to_undo(const state::SnapshotEntry& entry,
                                     const bla::Profiles& profiles);

} // namespace blactl::fleet
