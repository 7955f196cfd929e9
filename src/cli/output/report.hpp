#pragma once
// The result of a command, for any of the renderers.

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

/// The end of one target of a command, usually a servo.
struct Target {
  std::vector<Error> errors{};
  bool has_found = false; ///< it succeeded and found something: exit status 8
};

/// The outcome of one command: data for three renderers, and errors.
struct Report {
  std::string command{};   ///< empty: the command line could not be parsed
  std::string interface{}; ///< empty: none was given or opened

  /// Writes the command's own members of the document ("nodes": […], …).
  std::function<void(JsonWriter&)> json{};
  /// The data for people; ends with a line break.
  std::function<std::string(const Page&)> text{};
  /// The data as comma-separated values with a header line; empty: this command has no tables.
  std::function<std::string()> csv{};

  std::vector<Error> errors{}; ///< of the command as a whole: they outrank those of targets
  std::vector<Target> targets{};
  std::vector<std::pair<std::string, std::uint64_t>> counts{};
  int signal = 0; ///< that ended the command
  /// A stream has printed its data: only one last line without nodes follows.
  bool is_stream = false;

  void fail(Error error) { errors.push_back(std::move(error)); }

  void fail_target(Error error) { targets.push_back({.errors = {std::move(error)}}); }

  /// Adds "nodes" and "failed" to the counts, the same in every command: the number of targets, and
  /// of those with errors. `all`: the number of targets if `targets` does not contain all of them,
  /// because the command ended early.
  void count_targets(std::optional<std::size_t> all = std::nullopt);

  /// Errors of the command, then those of its targets.
  [[nodiscard]] std::vector<Error> all_errors() const;

  /// The exit status by the contract, section 3: 3 outranks all, a failure outranks 8, different
  /// ends of several servos give 6.
  [[nodiscard]] int exit_status() const;
};

} // namespace blactl::cli
