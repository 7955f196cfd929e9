#pragma once
// What a command has to say when it ends, for any of the renderers.

#include "blactl/base/error.hpp"
#include "blactl/base/json_writer.hpp"

#include "cli/output/page.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace blactl::cli {

/// How one of the things that a command was about ended, a servo most often.
struct Target {
  std::vector<Error> errors{};
  bool has_found = false; ///< it ran well and found something: exit status 8
};

/// The outcome of one command: data for three renderers, and what went wrong.
struct Report {
  std::string command{};   ///< empty: the command line was not understood
  std::string interface{}; ///< empty: none was named or opened

  /// Writes the members of the document that this command adds ("nodes": […], …).
  std::function<void(JsonWriter&)> json{};
  /// The data for a person; ends with a line break.
  std::function<std::string(const Page&)> text{};
  /// The data as comma-separated values with a header line; empty: this command has no tables.
  std::function<std::string()> csv{};

  std::vector<Error> errors{}; ///< of the command as a whole: they outrank those of targets
  std::vector<Target> targets{};
  std::vector<std::pair<std::string, std::uint64_t>> counts{};
  int signal = 0; ///< that ended the command
  /// A stream has printed its data: what is left is one last line, without nodes.
  bool is_stream = false;

  /// A failure of the command as a whole.
  void fail(Error error) { errors.push_back(std::move(error)); }

  /// A failure of one target.
  void fail_target(Error error) { targets.push_back({.errors = {std::move(error)}}); }

  /// "nodes" and "failed" among the counts, the same in every command: how many targets there were,
  /// and how many of them have errors. `all`: how many there were, where `targets` are not all
  /// of them, because the command stopped before each had an end of its own.
  void count_targets(std::optional<std::size_t> all = std::nullopt);

  /// Errors of the command, then those of its targets.
  [[nodiscard]] std::vector<Error> all_errors() const;

  /// The exit status by the contract, section 3: 3 outranks all, a failure outranks 8, different
  /// ends of several servos are 6.
  [[nodiscard]] int exit_status() const;
};

} // namespace blactl::cli
