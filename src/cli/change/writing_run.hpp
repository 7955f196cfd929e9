#pragma once
// What every command that writes to servos does before it writes.

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

/// Whether what servos held, and what their ROM was proven to hold, is recorded.
enum class Recording : std::uint8_t {
  none,
  looked_up,   ///< what was recorded before is read, and nothing is added
  if_possible, ///< else that is said, and nothing else comes of it
  required     ///< else nothing is changed
};

/// Why nothing is changed where that is required.
[[nodiscard]] Error cannot_be_recorded(const Error& reason);

/// One run of such a command. Each step may end it: then it is false or empty, and the report says
/// why.
class WritingRun {
 protected:
  WritingRun(Context& context, Report& report) : context_(context), report_(report) {}

  [[nodiscard]] bool open(std::string_view command, Recording recording = Recording::none);

  /// The servos that are meant; those that are named and not there are its errors.
  [[nodiscard]] std::optional<fleet::Selection>
  choose(const fleet::Targets& targets, const fleet::Identification::Options& identification);

  /// Opens, and chooses the one servo that is meant. Errors also: usage, where several are.
  [[nodiscard]] std::optional<dronecan::NodeId> open_for_one(std::string_view command);

  /// The bus was searched: who comes from now on was not chosen.
  void searched();

  /// When the bus was searched; empty: the servos that are meant were named.
  [[nodiscard]] std::optional<Time> searched_at() const { return searched_at_; }

  /// As fleet::hear_others(), for a command that writes by jobs of its own.
  [[nodiscard]] bool hear();

  /// Each note once.
  void tell(const std::vector<std::string>& notes);

  /// The warnings of each servo, each once.
  void tell_warnings(std::span<const fleet::GoalResult> results);

  /// Says who else acts on this bus, where that forbids nothing.
  void tell_others();

  /// The same of those who came while it wrote.
  void tell_newcomers();

  /// How servos are changed, and recorded as open() was told. Where they restart this process
  /// allocates node IDs, if it may.
  [[nodiscard]] fleet::Manner manner(const RestartTimes& times = {}, bool restarts = true);

  /// Why nothing must be changed, where the allocation table cannot be used; empty: it may.
  [[nodiscard]] std::optional<Error> go_without_table(const Error& reason);

  /// What was recorded before; null: nothing is known.
  [[nodiscard]] fleet::History* history() { return history_ ? &*history_ : nullptr; }

  /// An empty question is none.
  [[nodiscard]] bool confirm(const std::string& question);

  bool stop(Error error);

  /// The session broke.
  bool broken(const Error& error);

  /// An error with the code `refusal` is an answer; any other one broke the session.
  bool fail(const Error& error, Code refusal);

  /// What an interruption leaves behind.
  void hint_interruption(const std::string& hint);

  Context& context_;
  Report& report_;

 private:
  [[nodiscard]] bool open_record(std::string_view command);
  [[nodiscard]] std::optional<Error> go_unrecorded(const Error& reason);

  Recording recording_ = Recording::none;
  std::optional<fleet::History> history_;
  std::optional<Time> searched_at_;
  std::set<std::string> told_; ///< notes
};

} // namespace blactl::cli
