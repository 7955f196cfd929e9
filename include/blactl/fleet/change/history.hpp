#pragma once
// The persistent record of changes: the servos' settings before, and the proven contents of their
// ROM after.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/fleet/change/result.hpp"
#include "blactl/fleet/change/survey.hpp"
#include "blactl/state/proof_store.hpp"
#include "blactl/state/snapshot_store.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// The name of an erase that keeps the IDs, as typed.
inline constexpr std::string_view erase_keeping_ids = "erase --keep-ids";

/// The name of the command that records what it may change, and not what it writes.
inline constexpr std::string_view characterizing = "characterize";

/// The name of the command that gives a new servo the place of a broken one.
inline constexpr std::string_view replacing = "replace";

/// What ROM holds, as far as proofs and the record of changes tell.
struct ToldRom {
  bla::Values values{};
  bool is_proven = false; ///< else what changes in RAM only have replaced since the start
  std::set<bla::Address> perhaps_saved{}; ///< whether these changes were saved is not known
  std::map<bla::Address, dronecan::NodeId> written_by{}; ///< other nodes, heard since its start
};

/// IDs that an ERASE by this program has taken from RAM, was to keep, and did not write back: it
/// broke off.
struct LostIds {
  bla::Values ids{};
  bool is_certain = false; ///< it has run on since; else 0 may be what somebody wants by now
};

/// The record of one command, over all of its rounds. Errors of its functions are those of the
/// stores: the record is incomplete then, with no other effect.
class History {
 public:
  /// `command`: its name as typed.
  History(std::string command, state::SnapshotStore snapshots, state::ProofStore proofs)
      : command_(std::move(command)), snapshots_(std::move(snapshots)), proofs_(std::move(proofs)) {
  }

  /// Before all: of the units that this command is to save, also those that need nothing. If some
  /// of them are left from tries of it that failed, this command goes on with all of these.
  [[nodiscard]] Result<void> go_on(std::span<const Servo> units, WallTime now);

  /// Before the first request of a round: removes the proofs of ROM of servos that restart or are
  /// erased in it, which become outdated.
  [[nodiscard]] Result<void> drop_proofs(std::span<const Plan> plans);

  /// Before the first request of a round: records the present settings of the servos changed in it,
  /// those that a restart takes from RAM, as far as ROM is known, among them.
  /// For one changed in an earlier round the existing record is kept. If apply, undo, alloc
  /// --static or erase --keep-ids were killed or failed, and the same command is repeated, undo
  /// goes back to the state before the first try, as far as its changes are still there.
  [[nodiscard]] Result<void> keep(std::span<const Plan> plans, const Session& session);

  /// After a round: records the result of each servo, also what a restart that has shown ROM took
  /// from RAM, and the proofs of those whose configuration was read, complete and as expected,
  /// after a restart.
  [[nodiscard]] Result<void> conclude(std::span<const ChangeResult> results,
                                      const Session& session);

  /// At the end of a command that is repeated as a whole after a failure (see keep()): these units
  /// have reached its goal. `are_all`: so have all others; an apply or alloc --static that has
  /// failed for one goes on for every servo, also where that one has no record as it took nothing.
  [[nodiscard]] Result<void> end(std::span<const dronecan::UniqueId> units, bool are_all);

  /// This command has restored these units: there is nothing to undo, and the change before it is
  /// the last one again.
  [[nodiscard]] Result<void> take_back(std::span<const dronecan::UniqueId> units);

  /// The ROM of these units is not known any more.
  [[nodiscard]] Result<void> doubt_rom(std::span<const dronecan::UniqueId> units);

  /// The changes of a servo in RAM only since its start, the newest first. With `ram`, also those
  /// that the clock puts before its start, which RAM still shows: clocks are set.
  [[nodiscard]] std::vector<state::SnapshotEntry>
  unsaved(const Servo& servo, const Session& session, const Snapshot* ram = nullptr) const;

  /// Restarts have lost these changes, and they were written to RAM again, or may have been: from
  /// now on they belong to the servo's present run.
  [[nodiscard]] Result<void> renew(std::vector<state::SnapshotEntry> changes,
                                   const Session& session);

  /// Likewise this command's own change of this unit, after those before it.
  [[nodiscard]] Result<void> renew_own(const dronecan::UniqueId& unit,
                                       std::vector<state::SnapshotEntry> before,
                                       const Session& session);

  /// The contents of this servo's ROM, if proven and it has not restarted since; else empty, also
  /// if the record cannot be read.
  [[nodiscard]] std::optional<bla::Values> proven_rom(const Servo& servo, const Session& session);

  /// The values that changes of this program in RAM only have replaced since this servo started:
  /// its ROM holds them, as far as recorded; and which of them may be saved by now.
  [[nodiscard]] ToldRom recorded_rom(const Snapshot& ram, const Session& session) const;

  /// The latest possible start of this servo, by its uptime. Empty: it has not told it.
  [[nodiscard]] static std::optional<WallTime> start_of(const Servo& servo, const Session& session);

  /// What its ROM holds, as far as proven, else as far as recorded.
  [[nodiscard]] bla::Values known_rom(const Snapshot& ram, const Session& session);

  /// What a SAVE of this program has put into its ROM, perhaps, since this servo started: it has
  /// not restarted as it should.
  [[nodiscard]] bla::Values saved_since_start(const Servo& servo, const Session& session) const;

  /// The units that wait for a node ID, and whose ROM held a static one when it was last proven:
  /// none changes it without SAVE. Empty also if the record cannot be read.
  [[nodiscard]] std::vector<Waiting> waiting(const Roster& roster) const;

  /// The IDs that the ROM of this servo held when it was last proven, however long ago: where it
  /// could not be read since, it may hold them. Empty also if the record cannot be read.
  [[nodiscard]] bla::Values last_proven_ids(const Servo& servo) const;

  /// Empty: none, or they were changed on purpose since.
  [[nodiscard]] LostIds lost_ids(const Snapshot& ram, const Session& session) const;

  /// Whether a restart by this program did not help a servo to read its ROM, and it has not
  /// restarted since.
  [[nodiscard]] bool is_rom_unread(const Servo& servo, const Session& session);

 private:
  [[nodiscard]] std::optional<state::RomProof> proof(const Servo& servo, const Session& session);
  using Roms = std::map<dronecan::UniqueId, state::Registers>;

  void keep_ids(const Plan& plan);
  void keep_rom(const Plan& plan, const state::Registers& held, const Session& session);
  [[nodiscard]] Roms roms_before(std::span<const Plan> plans, const Session& session);
  [[nodiscard]] Result<void> keep_lasting(std::span<const Plan> plans, const Roms& roms,
                                          const Session& session);
  [[nodiscard]] std::optional<state::SnapshotEntry> entry_of(const Plan& plan, const Roms& roms,
                                                             const Session& session);
  [[nodiscard]] bla::Values taken_from_ram(const Plan& plan, const Session& session);
  [[nodiscard]] state::SnapshotEntry new_entry(const Servo& servo, const Session& session) const;
  [[nodiscard]] Result<void> store(std::vector<state::SnapshotEntry> entries, WallTime now);
  [[nodiscard]] Result<void> keep_what_was_taken(std::span<const ChangeResult> results,
                                                 const Session& session);
  [[nodiscard]] Result<void> leave_what_was_lost(std::span<const ChangeResult> results,
                                                 WallTime now);
  struct Settled;
  void settle(const ChangeResult& result, WallTime wall, Settled& settled);
  [[nodiscard]] Result<void> settle(std::span<const ChangeResult> results, WallTime wall);
  [[nodiscard]] Result<std::optional<state::SnapshotEntry>> last_of(const Servo& servo) const;
  [[nodiscard]] Result<std::optional<state::SnapshotEntry>> unfinished(const Servo& servo) const;
  [[nodiscard]] Result<void> gather(std::span<const state::SnapshotEntry> tries, WallTime now);
  [[nodiscard]] Result<void> resume(const Plan& plan, const Session& session);
  [[nodiscard]] static bool is_over(const state::SnapshotEntry& tried, const Snapshot& ram,
                                    const Session& session);
  [[nodiscard]] Result<void> join_done(std::span<const Plan> plans, const Session& session);
  [[nodiscard]] Result<void> join(state::SnapshotEntry tried, const Plan& plan,
                                  const Session& session);
  [[nodiscard]] bool is_half_undone() const;
  [[nodiscard]] bool is_another_try(const dronecan::UniqueId& unit) const;
  [[nodiscard]] std::vector<std::int64_t>
  former_numbers(std::span<const state::SnapshotEntry> entries) const;
  [[nodiscard]] bool is_in_rom(const state::SnapshotEntry& change) const;

  /// The entry of one servo, and its certain state.
  struct Kept {
    state::SnapshotEntry entry;
    bool was_changed = false; ///< in any round
    bool was_saved = false;
    bool is_another_try = false;   ///< the entry is of one that ended half way
    bool is_empty = false;         ///< a restart has shown that nothing was replaced
    std::set<std::uint8_t> lost{}; ///< what a restart has taken from RAM
  };

  std::string command_;
  state::SnapshotStore snapshots_;
  state::ProofStore proofs_;
  std::map<dronecan::UniqueId, Kept> kept_;
  std::int64_t run_ = 0;                    ///< of all entries of this command; 0: no record
  std::int64_t joined_ = 0;                 ///< of an earlier try that is continued; 0: none
  std::set<dronecan::UniqueId> unproven_{}; ///< their proofs were removed
  Roms ids_in_rom_{}; ///< of these units, as proven or to be saved: ROM that is not read may hold
                      ///< them

  /// Where an entry holds what ROM held before a save: what RAM did; else the other way about.
  Roms in_ram_{}, in_rom_{};

  Roms before_proof_{}; ///< what RAM held before a restart that is to show ROM

  /// Changes in RAM that SAVE makes permanent, as they were before.
  std::map<dronecan::UniqueId, std::vector<state::SnapshotEntry>> lasting_{};
};

/// As state::RomProof::clock, now.
[[nodiscard]] WallTime clock_of(const Session& session);

/// Whether two of SnapshotEntry::clock are of one run of a clock; one that is not known is of none.
[[nodiscard]] bool is_same_clock(std::optional<WallTime> one, std::optional<WallTime> other);

/// Whether the wall times of this change and of now are of one clock: nobody has set it since, and
/// this machine has not restarted or slept.
[[nodiscard]] bool is_of_this_clock(const state::SnapshotEntry& change, const Session& session);

/// Whether a servo that seems to have `started` then was running at the time `at` for certain:
/// clocks differ by 50 ppm, and are set by a few seconds.
[[nodiscard]] bool started_before(WallTime started, WallTime at, WallTime now);

/// Likewise, whether it has started after that time, by a clock that nobody has set since.
[[nodiscard]] bool started_after(WallTime started, WallTime at, WallTime now);

/// No write of this change came later: the servo may have restarted between record and write.
[[nodiscard]] WallTime last_write(const state::SnapshotEntry& change);

/// Whether RAM holds a value that this change has put there; empty: no register of it was read. One
/// that it has put back shows nothing.
[[nodiscard]] std::optional<bool> is_shown(const state::SnapshotEntry& change, const Snapshot& ram);

/// The settings that this plan replaces, with their present values; all writable ones for ERASE,
/// and where any may be changed.
[[nodiscard]] bla::Values replaced_by(const Plan& plan);

} // namespace blactl::fleet
