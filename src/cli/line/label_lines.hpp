#pragma once
// Lines from stdin while a session lives: one for each servo of a production line.

#include "blactl/fleet/bus/session.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::cli {

class LabelLines {
 public:
  /// Longer ones are split, and are no labels then.
  static constexpr std::size_t longest = 4096;

  /// Where lines come from.
  enum class Source : std::uint8_t { stdin_itself, keys };

  /// The session outlives this.
  LabelLines(fleet::Session& session, Source source);
  ~LabelLines();
  LabelLines(const LabelLines&) = delete;
  LabelLines& operator=(const LabelLines&) = delete;

  /// Takes what was typed: a backspace takes back, Ctrl-D on an empty line ends the input.
  void type(std::string_view text);

  /// The line that is being typed.
  [[nodiscard]] std::string_view unfinished() const;

  /// How many whole lines that are not blank wait for next().
  [[nodiscard]] std::size_t waiting() const;

  /// Takes out the whole lines that wait and are no labels; returns the last of them, else empty.
  [[nodiscard]] std::string
  take_out_unless(const std::function<bool(const std::string& line)>& is_label);

  /// Whether a whole line is there, or stdin has ended.
  [[nodiscard]] bool is_ready() const;

  /// The next line that is not blank; empty: none yet, or no more. The last one may lack its end.
  [[nodiscard]] std::optional<std::string> next();

  [[nodiscard]] bool has_ended() const { return ended_ && text_.empty(); }

  /// How many lines were taken: the number of the last one.
  [[nodiscard]] std::size_t number() const { return number_; }

 private:
  void read();
  [[nodiscard]] std::optional<std::string> take_line();

  void listen();

  fleet::Session& session_;
  Source source_;
  std::string text_;
  std::size_t number_ = 0;
  bool ended_ = false;
};

} // namespace blactl::cli
