#pragma once
// The one place that prints: stdout carries data, stderr everything else.

#include "blactl/base/error.hpp"

#include "cli/output/report.hpp"

#include <string>
#include <string_view>

namespace blactl::cli {

enum class Format : unsigned char { text, json, csv };
enum class Colour : unsigned char { automatic, always, never };

/// Owns stdout and stderr. Whether a terminal listens changes colour and questions, never the
/// format of the data.
class Reporter {
 public:
  struct Options {
    Format format = Format::text;
    Colour colour = Colour::automatic;
    bool quiet = false;
    int verbosity = 0;
  };

  explicit Reporter(Options options) : options_(options) {}

  [[nodiscard]] Format format() const { return options_.format; }

  /// stdin and stderr are terminals: questions may be asked.
  [[nodiscard]] static bool has_terminal();

  /// Something worth knowing, on stderr; not with --quiet.
  void note(std::string_view text) const;
  /// Details on stderr, with -v.
  void detail(std::string_view text) const;
  void error(const Error& error) const;

  /// A question on stderr, answered on stdin by the caller.
  void ask(std::string_view question) const;

  /// A piece of data on stdout at once. A reader that has left is no failure: there is nobody to
  /// tell. Errors: io.
  [[nodiscard]] Result<void> data(std::string_view text) const;
  /// The same for streams: false if the reader has left, which ends them. Errors: io.
  [[nodiscard]] Result<bool> stream(std::string_view text) const;

  /// As data(), for a command that must not wait for a slow reader: false if stdout has no room for
  /// a line now, then nothing is printed. Errors: io.
  [[nodiscard]] Result<bool> offer(std::string_view line) const;

  /// Prints the report and returns the exit status: 1 if stdout could not be written.
  [[nodiscard]] int finish(const Report& report) const;

 private:
  [[nodiscard]] bool use_colour() const;
  [[nodiscard]] std::string render(const Report& report) const;

  Options options_;
};

/// The document of the contract, section 5.
[[nodiscard]] std::string render_json(const Report& report);

} // namespace blactl::cli
