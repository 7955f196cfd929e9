#pragma once
// Lines from stdin while a command runs.

#include "blactl/can/loop.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace blactl::cli {

/// Never waits: the loop does. A terminal is read only while the command is in its foreground,
/// which is checked with every event.
class LineInput {
 public:
  /// Longer lines are split.
  static constexpr std::size_t longest = 4096;

  /// `loop` must outlive this.
  explicit LineInput(can::Loop& loop);

  /// Reads available input, if the event announces it.
  void handle(const can::Event& event);

  /// The next whole line without its end; empty: none yet.
  [[nodiscard]] std::optional<std::string> next();

 private:
  void look();

  can::Loop& loop_;
  bool is_terminal_;
  std::string text_;
  bool is_watched_ = false;
  bool ended_ = false;
};

} // namespace blactl::cli
