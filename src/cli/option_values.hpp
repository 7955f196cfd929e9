#pragma once
// The values of options, from text to number: checked after parsing, exactly.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"

#include <CLI/App.hpp>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::cli {

/// Declares options whose values the parser hands over as text, and checks them when the parser is
/// done: CLI11 would take "nan" for a number and rounds silently. An option that is not given
/// leaves its destination alone. Destinations outlive check().
class OptionValues {
 public:
  /// Any text but an empty one. The first error counts.
  void text(CLI::App& app, const char* names, const char* help, const char* type,
            std::optional<std::string>& out);

  /// Seconds with up to six decimals.
  void seconds(CLI::App& app, const char* names, const char* help, Duration& out, Duration min,
               Duration max);
  void seconds(CLI::App& app, const char* names, const char* help, std::optional<Duration>& out,
               Duration min, Duration max);

  void whole(CLI::App& app, const char* names, const char* help, const char* type,
             std::function<void(std::uint64_t)> take, std::uint64_t min, std::uint64_t max);

  template <class Choice>
  void word(CLI::App& app, const char* names, const char* help, const char* type, Choice& out,
            std::initializer_list<std::pair<std::string_view, Choice>> choices) {
    add(app, names, help, type, [this, &out, choices = std::vector(choices)](const Given& given) {
      std::string known;
      for (const auto& [name, value] : choices) {
        if (name == given.text) {
          out = value;
          return;
        }
        known += known.empty() ? "" : ", ";
        known += name;
      }
      refuse_word(given, known);
    });
  }

  /// A failure of the command line that the parser cannot see; the first one counts.
  void failed(std::string message, std::string hint);

  /// Checks what was given. Errors: usage.
  [[nodiscard]] Result<void> check();

  /// Names of the options that take the next argument as their value: "--node".
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  struct Given {
    std::string name;    ///< "--node"
    std::string command; ///< empty: an option of all commands
    std::string text;
  };

  void add(CLI::App& app, const char* names, const char* help, const char* type,
           std::function<void(const Given&)> check);
  void take_seconds(const Given& given, Duration min, Duration max,
                    const std::function<void(Duration)>& take);
  void refuse_word(const Given& given, const std::string& known);
  void refuse(const Given& given, std::string message);

  struct Slot {
    Given given;
    bool is_given = false;
    std::function<void(const Given&)> check;
  };

  std::vector<std::unique_ptr<Slot>> slots_; ///< the parser keeps their addresses
  std::vector<std::string> names_;
  std::optional<Error> error_;
};

} // namespace blactl::cli
