#pragma once
// Carries the plans of several servos out, each by a job of its own, all at once.

#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/change_job.hpp"
#include "blactl/fleet/change/history.hpp"
#include "blactl/state/allocation_store.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// How far the servos are, for a person who waits.
struct Progress {
  std::size_t servos = 0;
  std::size_t ended = 0;                   ///< well or not
  std::vector<dronecan::NodeId> at_work{}; ///< are asked, written or read
  std::vector<dronecan::NodeId> away{};    ///< were told to save or to restart, and are not back
  Duration elapsed{};
};

/// How all of them are treated.
struct Manner {
  Identification::Options identification{};
  Duration stagger{};                  ///< between the requests to restart
  std::optional<Duration> come_back{}; ///< empty: 5 s, and 2 s for each that will ask for an ID
  bool stops_at_failure = false;       ///< one that fails stops all that are not saved yet
  bool while_driven = false;           ///< also what moves a servo that another node drives
  /// Nobody else of this machine allocates on the interface: this process may.
  bool may_allocate = false;
  /// Opens the allocation table, when a servo asks for an ID. Where it cannot be used, or this is
  /// empty, each gets the ID that it had, and that is not kept.
  std::function<Result<state::AllocationStore>()> allocations{};
  /// Called once, why the table cannot be used; the reason why nothing is changed then. Empty: all
  /// is, all the same.
  std::function<std::optional<Error>(const Error&)> not_kept{};
  std::function<void(const Progress&)> progress{}; ///< called once a second; may be empty
  StageHook entered{};                             ///< called for each servo; may be empty
  History* history = nullptr;                      ///< records it; null: nothing is kept
  History* proofs = nullptr; ///< knows what was proven of ROM before; null: nothing is known
  /// Called with why it cannot be recorded; the reason why nothing is changed then. Empty: all is,
  /// all the same.
  std::function<std::optional<Error>(const Error&)> not_recorded{};
  /// Told why it is not recorded how that ended; may be empty.
  std::function<void(const Error&)> end_not_recorded{};
};

struct CarriedOut {
  std::vector<ChangeResult> servos; ///< in the order of the plans
  /// Why the session ended in between: `error` of each servo tells how far it was.
  std::optional<Error> broken{};
};

/// Records what the servos hold that are going to be changed, for carry_out() in several rounds:
/// whatever the disk does then, it is recorded of all. Why nothing must be changed; empty: it may.
[[nodiscard]] std::optional<Error> record(Session& session, std::span<const Plan> plans,
                                          const Manner& manner);

/// Records how carry_out() ended; what nothing was sent of is forgotten.
void record_end(Session& session, std::span<const ChangeResult> results, const Manner& manner);

/// A servo that asks for a node ID gets that of the allocation table; one that is not in there the
/// one it had, or a free one if that is another's in the table. Unless another allocator is heard.
/// What is recorded is on the disk before the first request.
[[nodiscard]] CarriedOut carry_out(Session& session, const bla::Profiles& profiles,
                                   std::span<const Plan> plans, const Manner& manner);

} // namespace blactl::fleet
