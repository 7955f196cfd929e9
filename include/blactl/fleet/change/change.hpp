#pragma once
// The only way to change servos: goals in, all refusals out, one question, results (contract,
// sections 4 and 6). Nothing else writes settings, saves, erases or restarts.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/change/goal.hpp"
#include "blactl/fleet/change/history.hpp"
#include "blactl/fleet/change/id_moves.hpp"
#include "blactl/fleet/change/result.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

class Rounds;
struct UnitChange;
struct UnitTask;

/// Call prepare(), then carry_out(). Guard, survey, promised IDs, cross-checks, history, proofs and
/// the allocation table apply, whatever the goals.
class Change {
 public:
  struct Options {
    Manner manner{};
    bool stops_at_failure = false; ///< nothing begins after a round with a failed servo
    bool knows_ids = false;        ///< the bus was searched, with the static node IDs
    /// The time of the last frame heard in the search for the selected servos: nodes that came
    /// since may be among them. Empty: they were named.
    std::optional<Time> searched{};
    /// The return of a loan: the bus was heard before, and one that refuses does not prevent the
    /// others.
    bool gives_back = false;
  };

  /// Called for every proven move of a node ID.
  using MoveHook = std::function<void(const IdMove& move)>;

  /// Both references outlive this.
  Change(Session& session, const bla::Profiles& profiles, Options options);
  ~Change();
  Change(const Change&) = delete;
  Change(Change&&) = delete;
  Change& operator=(const Change&) = delete;
  Change& operator=(Change&&) = delete;

  /// Reads the servos, plans each change, and hears the bus; if one refuses none is changed.
  /// Errors, all of them: why a servo could not be read; as make_plan(), plan_id_moves(),
  /// conflict() and forbidden(); state (a servo has come since, frames were lost); rom_unread (SAVE
  /// of a servo that could not read its ROM, without a restart of ours since); one that ends a
  /// session is the only one.
  [[nodiscard]] std::vector<Error> prepare(std::vector<Goal> goals);

  /// Notes for the user before the question, each once.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// The one question before everything; empty: none needed.
  [[nodiscard]] std::string question() const;

  /// Whether the question is about ROM that could not be read and is going to be replaced: a
  /// general yes is no answer to that.
  [[nodiscard]] bool overwrites_rom() const { return !overwritten_.empty(); }

  /// Asks the guard again, after a question; then brings each servo to its goal. Errors: why it did
  /// not begin or go on; those of single servos are in results().
  [[nodiscard]] std::vector<Error> carry_out(const MoveHook& moved = {});

  /// In the order of the goals, after prepare(): the plans, then the results.
  [[nodiscard]] const std::vector<GoalResult>& results() const { return results_; }

 private:
  using Snapshots = std::vector<Snapshot>;
  using Lost = std::map<dronecan::NodeId, Error>; ///< why they do not hold their goals any more

  [[nodiscard]] Result<Snapshots> read(std::span<const std::size_t> goals);
  [[nodiscard]] std::optional<Error> refuse(const Goal& goal, const Snapshot& held) const;
  [[nodiscard]] std::optional<bla::Values> proven_rom(const Goal& goal, const Servo& servo);
  [[nodiscard]] std::optional<Error> refuse_unread_rom(const GoalResult& result,
                                                       const Snapshot& held, Need need);
  [[nodiscard]] static std::optional<Error> refuse_lost_ids(const LostIds& lost,
                                                            const Snapshot& held);
  [[nodiscard]] std::vector<Error> hear();
  [[nodiscard]] std::vector<Error> refuse_copies(std::span<const std::size_t> goals);
  [[nodiscard]] std::vector<Error> prepare(std::span<const std::size_t> goals);
  [[nodiscard]] std::vector<Error> judge(std::span<const std::size_t> goals, Snapshots snapshots,
                                         std::vector<UnitTask>& tasks);
  [[nodiscard]] std::vector<Error> make_rounds(std::vector<UnitTask> tasks);
  [[nodiscard]] std::vector<Error> make_rounds_of_willing(std::vector<UnitTask> tasks);
  void note(std::span<const std::string> notes);
  void conclude();
  void conclude(const UnitChange& unit, GoalResult& result);
  [[nodiscard]] std::vector<Error> write_what_rom_lacks();
  [[nodiscard]] std::vector<Error> refusals_after_restart(std::vector<Error> errors);
  [[nodiscard]] Result<Lost> look_last();
  [[nodiscard]] std::vector<Servo> left_unchanged() const;
  [[nodiscard]] std::vector<Servo> proven_long_ago() const;
  [[nodiscard]] Result<Lost> look_at_restarted();
  [[nodiscard]] bool has_restarted_since(const GoalResult& result) const;
  void look_back(const Lost& lost);
  void look_back_once_more();
  [[nodiscard]] std::optional<Error> lost_unchanged(const GoalResult& result,
                                                    const Lost& lost) const;
  void look_back(GoalResult& result, const Lost& lost) const;
  void look_back_at_failed(GoalResult& result, dronecan::NodeId id, const Lost& lost) const;
  void go_on_with_record();
  void end_record();

  Session& session_;
  const bla::Profiles& profiles_;
  Options options_;
  Time next_restart_{}; ///< Manner::next_restart
  std::unique_ptr<Rounds> rounds_;
  std::vector<GoalResult> results_;
  std::vector<std::size_t> begun_; ///< the goals behind the units of rounds_
  std::vector<std::string> notes_;
  std::string overwritten_; ///< the part of the question about ROM that could not be read
};

} // namespace blactl::fleet
