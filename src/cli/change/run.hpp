#pragma once
// The one run of every command that changes servos: where its goals come from is all that such a
// command says, and how the results are shown.

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/change/change.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"

#include "cli/change/result_view.hpp"
#include "cli/change/writing_run.hpp"
#include "cli/context.hpp"
#include "cli/options.hpp"
#include "cli/output/report.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// What is to be done, and to whom.
struct Goals {
  std::vector<fleet::Goal> goals{};
  std::vector<fleet::EntryDiff> others{}; ///< of whom nothing is wished: missing, left out, extra
  std::vector<Error> errors{};            ///< why nothing may be done
  bool may_wait = false; ///< some are missing that may be among those that ask for a node ID
};

/// Whom a command may be about.
struct Whom {
  const fleet::Roster& roster;
  const fleet::Targets& targets;            ///< what -n says
  std::vector<dronecan::NodeId> selected{}; ///< the servos behind it; all, where it is not given
};

/// How the servos that a command is about are found.
enum class Search : std::uint8_t {
  targets,  ///< behind -n; without it the one servo there is
  everybody ///< all nodes are identified, for whoever has an ID stands in the way of others
};

struct ChangeRequest {
  std::string_view command; ///< its name
  Search search = Search::targets;
  bool needs_targets = true; ///< with Search::everybody, too: without -n it is about one servo
  /// Asked when the bus is known, and once more when more servos are.
  std::function<Goals(const Whom& whom)> find{};
  /// Gives node IDs to those that wait, where they may be missing; empty: to all that ask.
  std::function<Result<void>()> let_in{};
  /// Judges what is going to be done, before a question; may be empty.
  std::function<std::vector<Error>(std::span<const fleet::GoalResult> planned)> refuse{};
  /// Called for every move of a node ID; may be empty.
  fleet::Change::MoveHook moved{};
  /// Called with the results, before they are shown; may be empty.
  std::function<void(std::span<const fleet::GoalResult>)> ended{};
  RestartTimes times{};
  bool dry_run = false;
  bool stops_at_failure = false;                ///< between rounds of node IDs
  bool fails_fast = false;                      ///< the same, and within a round
  std::string events{};                         ///< the file for them; empty: none
  Recording recording = Recording::if_possible; ///< but with dry_run
  ResultView view = ResultView::servos;
  /// In place of the view, where a command has its own way to show what became of single registers.
  std::function<void(JsonWriter&, std::span<const fleet::ChangeResult>)> json{};
  std::function<std::string(std::span<const fleet::ChangeResult>, const Page&)> text{};
};

/// The request of a command that wants the same of every servo behind -n.
[[nodiscard]] ChangeRequest request_for_all(std::string_view command, fleet::Wanted wanted,
                                            fleet::Evidence evidence = fleet::Evidence::none);

/// Changes servos. If one of them refuses, none is written.
[[nodiscard]] Report change_servos(const ChangeRequest& request, Context& context);

} // namespace blactl::cli
