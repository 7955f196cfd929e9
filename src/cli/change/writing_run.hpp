#pragma once
// The steps of every command that writes to servos, before it writes.

#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/change/history.hpp"

#include "cli/context.hpp"
#include "cli/options.hpp"
#include "cli/output/report.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// Whether the settings of servos before a change, and the proven contents of their ROM, are
/// recorded.
enum class Recording : std::uint8_t {
  none,
  looked_up,   ///< earlier records are read, and none is added
  if_possible, ///< a failure is noted, with no other effect
  required     ///< otherwise nothing is changed
};

/// The error if nothing is changed because a record is required.
[[nodiscard]] Error cannot_be_recorded(const Error& reason);

/// One run of such a command. Each step may end it: it returns false or empty then, and the report
/// has the reason.
class WritingRun {
 protected:
  WritingRun(Context& context, Report& report) : context_(context), report_(report) {}

  [[nodiscard]] bool open(std::string_view command, Recording recording = Recording::none);

  /// The selected servos; named ones that are missing become errors.
  [[nodiscard]] std::optional<fleet::Selection>
  choose(const fleet::Targets& targets, const fleet::Identification::Options& identification);

  /// Opens, and finds the one servo selected. Errors also: usage, if there are several.
  [[nodiscard]] std::optional<dronecan::NodeId> open_for_one(std::string_view command,
                                                             Recording recording = Recording::none);

  /// The bus was searched: servos that come later were not selected.
  void searched();

  /// The time of the search; empty: the servos were named.
  [[nodiscard]] std::optional<Time> searched_at() const { return searched_at_; }

  /// Like fleet::hear_others(), for a command that writes by its own jobs.
  [[nodiscard]] bool hear();

  /// Prints each note once.
  void tell(const std::vector<std::string>& notes);

  /// Prints each warning once, with all servos that it is true of.
  void tell_warnings(std::span<const fleet::GoalResult> results);

  /// Notes other active nodes on this bus that do not forbid writing.
  void tell_others();

  /// Notes those that came during the writing.
  void tell_newcomers();

  /// The options of changes, recorded as requested in open(). While servos restart this process
  /// allocates node IDs, if it may.
  [[nodiscard]] fleet::Manner manner(const RestartTimes& times = {}, bool restarts = true);

  /// The reason why nothing must be changed if the allocation table cannot be used; empty: it may.
  [[nodiscard]] std::optional<Error> go_without_table(const Error& reason);

  /// The earlier records; null: none.
  [[nodiscard]] fleet::History* history() { return history_ ? &*history_ : nullptr; }

  /// An empty question is not asked.
  [[nodiscard]] bool confirm(const std::string& question, std::string_view option = {});

  bool stop(Error error);

  /// Ends the run as the session broke.
  bool broken(const Error& error);

  /// Fails the target if the error has the code `refusal`; any other error broke the session.
  bool fail(const Error& error, Code refusal);

  /// Gives a hint on the state after an interruption.
  void hint_interruption(const std::string& hint);

  Context& context_;
  Report& report_;

 private:
  [[nodiscard]] bool open_record(std::string_view command, Recording recording);
  [[nodiscard]] std::optional<Error> go_unrecorded(const Error& reason);

  Recording recording_ = Recording::none;
  std::optional<fleet::History> history_;
  std::optional<Time> searched_at_;
  std::set<std::string> told_; ///< notes
};

} // namespace blactl::cli
