#pragma once
// Evidence against an adapter: whether its output is slcan at all, and whether it accepts frames.

#include "blactl/can/slcan_adapter.hpp"
#include "blactl/can/slcan_line.hpp"

#include "can/mavlink_watch.hpp"

#include <cstddef>

namespace blactl::can {

/// Counts, and judges by the counts; without I/O.
///
///   evidence.heard(byte); evidence.understood(line);       all input
///   evidence.dialogue_ended(answered); evidence.frame_answered(accepted);
class SlcanEvidence {
 public:
  void heard(char byte);
  void understood(const SlcanLine& line);
  void frame_answered(bool accepted);

  /// Ends the opening dialogue; later input is judged separately.
  void dialogue_ended(bool answered);

  /// Whether it is sure enough to give up: at the end of a dialogue without answers, or later.
  [[nodiscard]] bool is_no_slcan() const;

  /// Whether all input was garbage without one recognisable line.
  [[nodiscard]] bool only_garbage() const { return any_garbage_ && understood_ == 0; }

  /// The kind of traffic it is instead.
  [[nodiscard]] ForeignSpeech speech() const;

  /// Whether not one byte came.
  [[nodiscard]] bool is_mute() const { return bytes_ == 0; }

  /// The number of frames refused, if none was ever accepted; else 0.
  [[nodiscard]] std::size_t refused_all() const { return accepted_ == 0 ? refused_ : 0; }

  [[nodiscard]] bool took_frames() const { return accepted_ > 0; }

 private:
  [[nodiscard]] bool mostly_garbage(std::size_t least) const;

  MavlinkWatch mavlink_;
  std::size_t bytes_ = 0;
  std::size_t strange_bytes_ = 0; ///< bytes that no line can hold
  std::size_t strange_lines_ = 0; ///< without meaning
  std::size_t understood_ = 0;
  std::size_t accepted_ = 0;
  std::size_t refused_ = 0;
  bool any_garbage_ = false;
  // Since the dialogue ended, or since the port was opened.
  std::size_t garbage_ = 0; ///< bytes that no line can hold; a meaningless line counts as some
  std::size_t lines_ = 0;   ///< understood
  bool in_dialogue_ = true;
  bool spoke_clearly_ = false; ///< in the dialogue: later garbage is a transient fault
};

} // namespace blactl::can
