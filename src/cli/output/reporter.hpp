#pragma once
// The only part that prints: stdout carries data, stderr everything else.

#include "blactl/base/error.hpp"

#include "cli/output/page.hpp"
#include "cli/output/report.hpp"

#include <string>
#include <string_view>

namespace blactl::cli {

enum class Format : unsigned char { text, json, csv };
enum class Colour : unsigned char { automatic, always, never };

/// Owns stdout and stderr. A terminal gets colour and questions, but the same format of data.
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

  /// The page for texts on stdout.
  [[nodiscard]] Page page() const;

  /// Whether stdin and stderr are terminals, so that questions may be asked.
  [[nodiscard]] static bool has_terminal();

  /// Prints a note on stderr; not with --quiet.
  void note(std::string_view text) const;
  /// Prints details on stderr, with -v; not with --quiet.
  void detail(std::string_view text) const;
  void error(const Error& error) const;

  /// Shows progress in one line on stderr, if that is a terminal, until the next line replaces it.
  /// Not with --quiet.
  void progress(std::string_view text) const;

  /// Redirects notes and errors to `held` instead of stderr, while a screen covers the terminal;
  /// null: to stderr again.
  void hold(std::string* held) const { held_ = held; }

  void repeat(std::string_view held) const { print(held); }

  /// Prints a question on stderr, whose answer the caller reads from stdin; or a warning that is
  /// shown even with --quiet.
  void ask(std::string_view question) const;

  /// Prints data on stdout at once. A reader that has left is not a failure. Errors: io.
  [[nodiscard]] Result<void> data(std::string_view text) const;
  /// Prints data of a stream: false if the reader has left, which ends the stream. Errors: io.
  [[nodiscard]] Result<bool> stream(std::string_view text) const;

  /// Whether stdout accepts a line at once.
  [[nodiscard]] static bool has_room();

  /// Whether stdout is a terminal whose contents may be redrawn.
  [[nodiscard]] bool has_screen() const;

  /// Replaces the previous list on the screen, if there is one, cut to what fits. Notes are above
  /// it. False if the reader has left. Errors: io.
  [[nodiscard]] Result<bool> show(std::string_view list) const;

  /// Like data(), for a command that must not wait for a slow reader: false, without printing, if
  /// stdout has no room for a line now. Errors: io.
  [[nodiscard]] Result<bool> offer(std::string_view line) const;

  /// Prints the report and returns the exit status: 1 if stdout could not be written.
  [[nodiscard]] int finish(const Report& report) const;

 private:
  /// Whether output to this descriptor is coloured: the only place that evaluates --color,
  /// NO_COLOR and TERM.
  [[nodiscard]] bool use_colour(int descriptor) const;
  /// The page behind stdout or stderr.
  [[nodiscard]] Page page(int descriptor) const;
  [[nodiscard]] std::string render(const Report& report) const;
  void print(std::string_view text) const;
  void clear_progress() const;
  [[nodiscard]] std::string clear_list() const;

  Options options_;
  mutable bool has_progress_ = false;   ///< it is in the last line of the terminal
  mutable std::string list_;            ///< the last lines of the terminal behind stdout
  mutable std::string* held_ = nullptr; ///< see hold()
};

/// The document of the contract, section 5.
[[nodiscard]] std::string render_json(const Report& report);

} // namespace blactl::cli
