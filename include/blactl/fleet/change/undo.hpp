#pragma once
// Undoes a change.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/state/snapshot_store.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// The change that restores the settings of this entry: in RAM, and in ROM, too, if the change was
/// saved. Errors: bad_file (a register that is not a setting: the entry is from a file, and must
/// not move anything), and those of bla::make_assignment().
[[nodiscard]] Result<Wanted> to_undo(const state::SnapshotEntry& entry,
                                     const bla::Profiles& profiles);

struct Undoing {
  /// Of a command that was repeated: of all its tries; its clock, if all have the same.
  state::SnapshotEntry entry;
  std::vector<std::int64_t> numbers{}; ///< of these tries
  bool goes_on = false;                ///< an undo of it has begun and did not end
  /// Tries that were to save broke off, and whether one did is unknown: when the first of them
  /// began. Empty: it is known.
  std::optional<WallTime> perhaps_saved_since{};
  std::map<std::uint8_t, std::set<std::int64_t>> written{}; ///< by all tries
  bool is_after_trial = false; ///< a change in RAM only came before it: ROM may hold what it wrote
};

/// A value of a register of this entry as people read it, in the unit that the entry tells.
[[nodiscard]] std::string displayed(const state::SnapshotEntry& entry, bla::Address address,
                                    std::int64_t raw, const bla::Profiles& profiles);

/// The change as far as the servo on this node ID shows it, where it broke off. One that has run on
/// since has saved nothing; of what a restart has brought back only what the tries have written is
/// theirs. A node ID always goes back. A change in RAM only that a restart has brought back counts
/// as saved: another tool has done so. Errors: as Session::run().
[[nodiscard]] Result<Undoing> as_left(Undoing change, dronecan::NodeId id, Session& session,
                                      const bla::Profiles& profiles,
                                      const Identification::Options& options);

/// The last change of this unit; empty: none is known. For an undo that did not end, the change
/// that it was to undo. Errors: those of the store.
[[nodiscard]] Result<std::optional<Undoing>>
last_change(const state::SnapshotStore& store, const dronecan::UniqueId& unique_id,
            std::optional<std::int64_t> serial_number = std::nullopt);

/// The changes of the last command; if that is an undo which did not end, those still to be undone.
/// Errors: those of the store.
[[nodiscard]] Result<std::vector<Undoing>> last_changes(const state::SnapshotStore& store);

/// Everything since before the command with this number (its entry's `run`), as one change of each
/// unit. What a restart has taken before ROM was changed, and nobody wrote again, stays out: ROM
/// never held it. Errors: not_found (no such command is recorded), and those of the store.
[[nodiscard]] Result<std::vector<Undoing>> changes_since(const state::SnapshotStore& store,
                                                         std::int64_t run);

} // namespace blactl::fleet
