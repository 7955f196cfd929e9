#pragma once
// Lines that come in on stdin while a command runs.

#include "blactl/can/loop.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace blactl::cli {

/// Never waits: the loop does. A terminal is read only while the command stands in its foreground;
/// whether it does is looked at with every event.
class LineInput {
 public:
  /// A longer line is cut into lines of this length.
  static constexpr std::size_t longest = 4096;

  /// `loop` must outlive this.
  explicit LineInput(can::Loop& loop);

  /// Reads what is there, if the event says that something is.
  void handle(const can::Event& event);

  /// The next whole line without its end; empty: there is none yet.
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
