#pragma once
// What every command that writes to servos does before it writes.

#include "blactl/fleet/discovery.hpp"

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// One run of such a command. Each step may end it: then it is false or empty, and the report says
/// why.
class WritingRun {
 protected:
  WritingRun(Context& context, Report& report) : context_(context), report_(report) {}

  [[nodiscard]] bool open(std::string_view command);

  /// The servos that are meant; those that are named and not there are its errors.
  [[nodiscard]] std::optional<fleet::Selection>
  choose(const fleet::Targets& targets, const fleet::Identification::Options& identification);

  /// Hears the bus long enough to know who else acts on it. A servo that came since they were
  /// chosen may be one of those that are meant; one without a node ID is none of them, and that is
  /// said.
  [[nodiscard]] bool hear();

  /// Says who else acts on this bus, where that forbids nothing.
  void tell_others();

  /// The same of those who came while it wrote.
  void tell_newcomers();

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
  void tell(const std::vector<std::string>& notes);

  bool has_searched_ = false; ///< the bus, for the servos that are meant
  Time chosen_at_{};
  std::set<std::string> told_; ///< who else acts
};

} // namespace blactl::cli
