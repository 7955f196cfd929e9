#pragma once
// What outlives a change of servos: what they held before it, and what their ROM was proven to hold
// after it.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/fleet/change/result.hpp"
#include "blactl/state/proof_store.hpp"
#include "blactl/state/snapshot_store.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// The record of one command, in however many rounds it changes servos. Errors of its functions are
/// those of the stores: what was to be kept is not, and nothing else has changed.
class History {
 public:
  /// `command`: its name, as people type it.
  History(std::string command, state::SnapshotStore snapshots, state::ProofStore proofs)
      : command_(std::move(command)), snapshots_(std::move(snapshots)), proofs_(std::move(proofs)) {
  }

  /// Before the first request of a round: what was proven of the ROM of servos that restart in it
  /// ends with that, and must not be believed of what is saved then.
  [[nodiscard]] Result<void> drop_proofs(std::span<const Plan> plans);

  /// Before the first request of a round: what the servos hold that are changed in it. Of one that
  /// an earlier round has changed the record goes on: it tells what that one has found. So it does
  /// where apply, undo or alloc --static were killed or failed, and the same command comes again:
  /// what the first try has found is what undo goes back to.
  [[nodiscard]] Result<void> keep(std::span<const Plan> plans, WallTime now);

  /// After a round: what became of each servo, and the proofs of those whose configuration was
  /// read, complete and as expected, after a restart.
  [[nodiscard]] Result<void> conclude(std::span<const ChangeResult> results,
                                      const Session& session);

  /// At the end of a command that is repeated as a whole where it failed (see keep()): these units
  /// are as it was to make them.
  [[nodiscard]] Result<void> end(std::span<const dronecan::UniqueId> units);

  /// This command has given these units back what they held: there is nothing to undo, and the
  /// change before it is the last one again.
  [[nodiscard]] Result<void> take_back(std::span<const dronecan::UniqueId> units);

  /// What the ROM of this servo holds, if that was proven and it has run on since; else empty, also
  /// where what was recorded cannot be read.
  [[nodiscard]] std::optional<bla::Values> proven_rom(const Servo& servo, const Session& session);

 private:
  [[nodiscard]] Result<std::optional<state::Settlement>>
  made_lasting(const ChangeResult& result) const;
  [[nodiscard]] Result<void> settle(std::span<const ChangeResult> results);
  [[nodiscard]] Result<void> resume(const dronecan::UniqueId& unique_id);
  [[nodiscard]] bool is_half_undone() const;

  /// The entry of one servo, and what is certain of it.
  struct Kept {
    state::SnapshotEntry entry;
    bool was_changed = false; ///< in any round
    bool was_saved = false;
  };

  std::string command_;
  state::SnapshotStore snapshots_;
  state::ProofStore proofs_;
  std::map<dronecan::UniqueId, Kept> kept_;
  std::int64_t run_ = 0;                    ///< of all entries of this command; 0: none is kept
  std::set<dronecan::UniqueId> unproven_{}; ///< have no proof any more
};

/// The settings whose values this plan replaces, as they are; of ERASE all that can be written.
[[nodiscard]] bla::Values replaced_by(const Plan& plan);

} // namespace blactl::fleet
