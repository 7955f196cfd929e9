#pragma once
// The one place that prints: stdout carries data, stderr everything else.

#include "blactl/base/error.hpp"

#include "cli/output/page.hpp"
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

  /// What a text on stdout is laid out for.
  [[nodiscard]] Page page() const;

  /// stdin and stderr are terminals: questions may be asked.
  [[nodiscard]] static bool has_terminal();

  /// Something worth knowing, on stderr; not with --quiet.
  void note(std::string_view text) const;
  /// Details on stderr, with -v; not with --quiet.
  void detail(std::string_view text) const;
  void error(const Error& error) const;

  /// How far the command is: one line on stderr, where a terminal is there, until the next line of
  /// whatever takes its place. Not with --quiet.
  void progress(std::string_view text) const;

  /// From now on notes and errors go here instead of stderr, while a screen covers the terminal;
  /// null: to stderr again.
  void hold(std::string* held) const { held_ = held; }

  /// What was held, on stderr.
  void repeat(std::string_view held) const { print(held); }

  /// A question on stderr, answered on stdin by the caller; or a warning that not even --quiet
  /// keeps back.
  void ask(std::string_view question) const;

  /// A piece of data on stdout at once. A reader that has left is no failure: there is nobody to
  /// tell. Errors: io.
  [[nodiscard]] Result<void> data(std::string_view text) const;
  /// The same for streams: false if the reader has left, which ends them. Errors: io.
  [[nodiscard]] Result<bool> stream(std::string_view text) const;

  /// stdout takes a line at once.
  [[nodiscard]] static bool has_room();

  /// stdout is a terminal, and what it is shown may change in place.
  [[nodiscard]] bool has_screen() const;

  /// The list in place of the one before, where there is a screen, cut to what fits on it. Notes
  /// stand above it. False if the reader has left. Errors: io.
  [[nodiscard]] Result<bool> show(std::string_view list) const;

  /// As data(), for a command that must not wait for a slow reader: false if stdout has no room for
  /// a line now, then nothing is printed. Errors: io.
  [[nodiscard]] Result<bool> offer(std::string_view line) const;

  /// Prints the report and returns the exit status: 1 if stdout could not be written.
  [[nodiscard]] int finish(const Report& report) const;

 private:
  /// Whether what goes to this descriptor is coloured: --color and NO_COLOR are judged here alone.
  [[nodiscard]] bool use_colour(int descriptor) const;
  /// The page behind stdout or stderr.
  [[nodiscard]] Page page(int descriptor) const;
  [[nodiscard]] std::string render(const Report& report) const;
  void print(std::string_view text) const;
  void clear_progress() const;
  [[nodiscard]] std::string clear_list() const;

  Options options_;
  mutable bool has_progress_ = false;   ///< it stands in the last line of the terminal
  mutable std::string list_;            ///< the last lines of the terminal behind stdout
  mutable std::string* held_ = nullptr; ///< see hold()
};

/// The document of the contract, section 5.
[[nodiscard]] std::string render_json(const Report& report);

} // namespace blactl::cli
