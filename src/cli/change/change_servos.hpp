#pragma once
// The run common to all commands that change servos: such a command only supplies the goals, and
// the form of the results.

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
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// The goals and the servos they are for.
struct Goals {
  std::vector<fleet::Goal> goals{};
  std::vector<fleet::EntryDiff> others{}; ///< without a goal: missing, left out, extra
  std::vector<std::string> notes{};       ///< told before anything is changed
  std::vector<Error> errors{};            ///< why nothing may be changed
  bool may_wait = false; ///< missing servos may be among those that request a node ID
  /// All of those by their unique IDs; empty: some are known otherwise.
  std::optional<std::vector<dronecan::UniqueId>> missing{};
  /// With --dry-run: the servos that would get a node ID first, and then their settings. The notes
  /// tell which.
  std::size_t would_let_in = 0;
};

/// The servos that a command may be about.
struct Whom {
  const fleet::Roster& roster;
  const fleet::Targets& targets;            ///< from -n
  std::vector<dronecan::NodeId> selected{}; ///< the servos selected by it; all without -n
};

/// How the servos of a command are found.
enum class Search : std::uint8_t {
  targets,  ///< those selected by -n; without it the only servo
  everybody ///< all nodes are identified, as any ID in use may be in the way of a move
};

/// When servos that wait for a node ID get one, before -n is looked at.
enum class Waiting : std::uint8_t {
  if_missing,      ///< not then: only if Goals::may_wait says so
  unless_node_ids, ///< unless -n names node IDs only
  always
};

struct ChangeRequest {
  std::string_view command; ///< its name
  Search search = Search::targets;
  bool needs_targets = true; ///< with Search::everybody, too: without -n there must be one servo
  Waiting waiting = Waiting::if_missing;
  /// Called once the bus is known, and again when more servos are.
  std::function<Goals(const Whom& whom)> find{};
  /// Assigns node IDs to waiting servos that may be the missing ones; empty: to all that ask.
  std::function<Result<void>()> let_in{};
  /// Checks the planned changes before the question; may be empty.
  std::function<std::vector<Error>(std::span<const fleet::GoalResult> planned)> refuse{};
  /// Called for every move of a node ID; may be empty.
  fleet::Change::MoveHook moved{};
  /// Called with the results before they are shown; may be empty.
  std::function<void(std::span<const fleet::GoalResult>)> ended{};
  RestartTimes times{};
  bool dry_run = false;
  bool stops_at_failure = false;                ///< between rounds of node IDs
  bool fails_fast = false;                      ///< likewise, within a round, too
  std::string events{};                         ///< the file for them; empty: none
  Recording recording = Recording::if_possible; ///< except with dry_run
  ResultView view = ResultView::servos;
  /// Replaces the view in commands that show the results of single registers in their own way.
  std::function<void(JsonWriter&, std::span<const fleet::ChangeResult>)> json{};
  std::function<std::string(std::span<const fleet::ChangeResult>, const Page&)> text{};
};

/// The request of a command with the same goal for every servo behind -n.
[[nodiscard]] ChangeRequest request_for_all(std::string_view command, fleet::Wanted wanted,
                                            fleet::Evidence evidence = fleet::Evidence::none);

/// Changes servos. If one of them cannot be changed, none is written to.
[[nodiscard]] Report change_servos(const ChangeRequest& request, Context& context);

} // namespace blactl::cli
