#pragma once
// Carries out the plans of several servos, each by its own job, all at once.

#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/change_job.hpp"
#include "blactl/fleet/change/history.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Progress for the user.
struct Progress {
  std::size_t servos = 0;
  std::size_t ended = 0;                   ///< successfully or not
  std::vector<dronecan::NodeId> at_work{}; ///< being asked, written or read
  std::vector<dronecan::NodeId> away{};    ///< ordered to save or restart, and not back yet
  Duration elapsed{};
};

/// Options for all servos.
struct Manner {
  Identification::Options identification{};
  Duration stagger{};           ///< between the requests to restart
  Time* next_restart = nullptr; ///< when the next one may be sent, from round to round
  /// As in RestartPace, of all rounds.
  std::set<dronecan::UniqueId> own{};
  Time surveyed = never;
  std::optional<Duration> come_back{}; ///< empty: 5 s, and 2 s for each that will ask for an ID
  bool stops_at_failure = false;       ///< a failure stops all that are not saved yet
  bool overwrite_rom = false;          ///< agreed: also ROM that could not be read
  bool while_driven = false;           ///< also changes that move a servo which another node drives
  /// Whether this process may allocate: no other on this machine does so on the interface.
  bool may_allocate = false;
  /// Opens the allocation table when a servo asks for an ID. If it cannot be used, or this is
  /// empty, each servo gets its previous ID, which is not stored then.
  std::function<Result<state::AllocationStore>()> allocations{};
  /// Called once with the error of the table; returns the reason why nothing is changed then.
  /// Empty: everything is changed all the same.
  std::function<std::optional<Error>(const Error&)> not_kept{};
  std::function<void(const Progress&)> progress{}; ///< called once a second; may be empty
  StageHook entered{};                             ///< called for each servo; may be empty
  History* history = nullptr;                      ///< records it; null: no record
  History* proofs = nullptr;                       ///< has earlier proofs of ROM; null: none
  /// Called with the error of the record; returns the reason why nothing is changed then. Empty:
  /// everything is changed all the same.
  std::function<std::optional<Error>(const Error&)> not_recorded{};
  /// Called with the error if the end cannot be recorded; may be empty.
  std::function<void(const Error&)> end_not_recorded{};
};

struct CarriedOut {
  std::vector<ChangeResult> servos; ///< in the order of the plans
  /// The error that ended the session early: `error` of each servo shows its progress.
  std::optional<Error> broken{};
};

/// Records the settings of all servos that are going to be changed, for carry_out() in several
/// rounds, so that later disk errors do not matter. Returns the reason why nothing must be changed;
/// empty: it may.
[[nodiscard]] std::optional<Error> record(Session& session, std::span<const Plan> plans,
                                          const Manner& manner);

/// Records the results of carry_out(); servos to which nothing was sent are removed from the
/// record.
void record_end(Session& session, std::span<const ChangeResult> results, const Manner& manner);

/// A servo that asks for a node ID gets the one in the allocation table; if it is not in there its
/// previous one, or a free one if the table has that for another. Not if another allocator is
/// heard. The record is on the disk before the first request.
[[nodiscard]] CarriedOut carry_out(Session& session, const bla::Profiles& profiles,
                                   std::span<const Plan> plans, const Manner& manner);

} // namespace blactl::fleet
