#pragma once
// The way of the commands that bring several servos each to what is wished of it: apply and undo.

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/change/apply.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"

#include "cli/context.hpp"
#include "cli/options.hpp"
#include "cli/output/report.hpp"
#include "cli/writing_run.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// What is wished, of whom.
struct Goals {
  std::vector<fleet::Goal> goals{};
  std::vector<fleet::EntryDiff> others{}; ///< of whom nothing is: missing, left out, extra
  std::vector<Error> errors{};            ///< why nothing may be done
  bool may_wait = false; ///< some are missing that may be among those that ask for a node ID
};

/// Whom a command may be about.
struct Whom {
  const fleet::Roster& roster;
  const fleet::Targets& targets;            ///< what -n says
  std::vector<dronecan::NodeId> selected{}; ///< the servos behind it; all, where it is not given
};

struct ApplyRequest {
  std::string_view command; ///< its name
  /// Asked when the bus is known, and once more when more servos are.
  std::function<Goals(const Whom& whom)> find{};
  /// Judges what is going to be done, before a question; may be empty.
  std::function<std::vector<Error>(std::span<const fleet::GoalResult> planned)> refuse{};
  /// Told how it ended; may be empty.
  std::function<void(std::span<const fleet::GoalResult>)> ended{};
  bool needs_targets = false; ///< without -n it is about the one servo there is
  RestartTimes times{};
  bool dry_run = false;
  bool trusts_ram = false;
  bool fails_fast = false;
  std::string events{};                         ///< the file for them; empty: none
  Recording recording = Recording::if_possible; ///< but with dry_run
};

/// If one of the servos refuses, none is written.
[[nodiscard]] Report apply_goals(const ApplyRequest& request, Context& context);

} // namespace blactl::cli
