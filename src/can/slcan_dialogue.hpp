#pragma once
// How an slcan adapter is opened, as a state machine without I/O.

#include "blactl/base/time.hpp"
#include "blactl/can/slcan.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace blactl::can {

/// Sends one command after the other and waits for the answer to each, for a short time: many
/// adapters answer nothing, and one that stayed silent twice is not waited for any more.
///
///   dialogue.begin(now); write(dialogue.take_commands());
///   dialogue.answered(…) and dialogue.advance(now) until is_done()
class SlcanDialogue {
 public:
  /// `inquires`: before it is opened, an adapter that answers is asked for its version and serial
  /// number.
  SlcanDialogue(SlcanOpening opening, bool await_answers, bool inquires);

  void begin(Time now);

  /// The adapter has answered: CR, or BEL.
  void answered(bool accepted, Time now);

  /// The adapter has told something of itself: "V1013".
  void told(std::string_view answer, Time now);

  /// Does what is due.
  void advance(Time now);

  [[nodiscard]] Time deadline() const { return deadline_; }

  /// What is to be written now; empty: nothing.
  [[nodiscard]] std::string take_commands();

  [[nodiscard]] bool is_done() const { return next_ == commands_.size() && !waiting_; }

  /// The adapter has answered something.
  [[nodiscard]] bool adapter_answers() const { return answers_ > 0; }

  /// Answers were waited for, and none came.
  [[nodiscard]] bool waited_in_vain() const { return silences_ > 0 && answers_ == 0; }

  /// Commands without an answer, which may still come.
  [[nodiscard]] std::size_t unanswered() const { return sent_ - answers_; }

  /// The adapter refused the bit rate.
  [[nodiscard]] bool rate_refused() const { return rate_refused_; }

  /// The adapter refused to open; it may have been open.
  [[nodiscard]] bool open_refused() const { return open_refused_; }

  /// The adapter refused the bit rate and to open. A refused O alone means that it is open.
  [[nodiscard]] bool refused() const { return rate_refused_ && open_refused_; }

 private:
  void send_next(Time now);
  [[nodiscard]] bool is_left_out(std::string_view command) const;

  std::span<const std::string_view> commands_;
  bool await_answers_;
  bool inquires_;
  bool waiting_ = false;
  std::size_t next_ = 0; ///< the first command that was not sent
  std::size_t sent_ = 0;
  std::size_t answers_ = 0;
  std::size_t silences_ = 0;
  bool rate_refused_ = false;
  bool open_refused_ = false;
  std::string out_;
  Time deadline_ = never;
};

} // namespace blactl::can
