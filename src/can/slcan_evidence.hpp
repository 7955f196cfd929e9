#pragma once
// What speaks against an adapter: whether what it says is slcan at all, and whether it takes
// frames.

#include "blactl/can/slcan_adapter.hpp"
#include "blactl/can/slcan_line.hpp"

#include "can/mavlink_watch.hpp"

#include <cstddef>

namespace blactl::can {

/// Counts, and judges by what it counted; without I/O.
///
///   evidence.heard(byte); evidence.understood(line);       all that comes
///   evidence.dialogue_ended(answered); evidence.frame_answered(accepted);
class SlcanEvidence {
 public:
  void heard(char byte);
  void understood(const SlcanLine& line);
  void frame_answered(bool accepted);

  /// The opening dialogue is over; what follows is judged by itself.
  void dialogue_ended(bool answered);

  /// Sure enough to give up: at the end of a dialogue in which nothing was answered, or later.
  [[nodiscard]] bool is_no_slcan() const;

  /// What came was garbage, and not one line of it could be understood.
  [[nodiscard]] bool only_garbage() const { return any_garbage_ && understood_ == 0; }

  /// What it is instead.
  [[nodiscard]] ForeignSpeech speech() const;

  /// Not one byte came.
  [[nodiscard]] bool is_mute() const { return bytes_ == 0; }

  /// Frames that were refused, if none was ever taken; else 0.
  [[nodiscard]] std::size_t refused_all() const { return accepted_ == 0 ? refused_ : 0; }

  [[nodiscard]] bool took_frames() const { return accepted_ > 0; }

 private:
  [[nodiscard]] bool mostly_garbage(std::size_t least) const;

  MavlinkWatch mavlink_;
  std::size_t bytes_ = 0;
  std::size_t strange_bytes_ = 0; ///< that no line can hold
  std::size_t strange_lines_ = 0; ///< without meaning
  std::size_t understood_ = 0;
  std::size_t accepted_ = 0;
  std::size_t refused_ = 0;
  bool any_garbage_ = false;
  // Since the dialogue ended, or since the port was opened.
  std::size_t garbage_ = 0; ///< bytes that no line can hold; a line without meaning is some
  std::size_t lines_ = 0;   ///< understood
  bool in_dialogue_ = true;
  bool spoke_clearly_ = false; ///< in the dialogue: what comes then is trouble of the moment
};

} // namespace blactl::can
