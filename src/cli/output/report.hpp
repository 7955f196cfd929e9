#pragma once
// What a command has to say when it ends, for any of the renderers.

#include "blactl/base/error.hpp"
#include "blactl/base/json_writer.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace blactl::cli {

/// The outcome of one command: data for three renderers, errors, and the exit status of each
/// servo it was about.
struct Report {
  std::string command{};   ///< empty: the command line was not understood
  std::string interface{}; ///< empty: none was named or opened

  /// Writes the members of the document that this command adds ("nodes": […], …).
  std::function<void(JsonWriter&)> json{};
  /// The data for a person; ends with a line break.
  std::function<std::string()> text{};
  /// The data as comma-separated values with a header line; empty: this command has no tables.
  std::function<std::string()> csv{};

  std::vector<Error> errors{};
  /// How each target ended; empty: the errors speak for the command as a whole.
  std::vector<int> statuses{};
  std::vector<std::pair<std::string, std::uint64_t>> counts{};
  int signal = 0; ///< that ended the command
  /// A stream has printed its data: what is left is one last line, without nodes.
  bool is_stream = false;

  /// A failure of the command as a whole.
  void fail(Error error) { errors.push_back(std::move(error)); }

  /// The exit status by the contract, section 3: 3 outranks all, a failure outranks 8, different
  /// ends of several servos are 6.
  [[nodiscard]] int exit_status() const;
};

} // namespace blactl::cli
