#pragma once
// How an slcan adapter is opened, as a state machine without I/O.

#include "blactl/base/time.hpp"
#include "blactl/can/slcan.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace blactl::can {

/// Sends one command after the other and waits a short time for each answer: many adapters answer
/// nothing, and after two silences it waits no more.
///
///   dialogue.begin(now); write(dialogue.take_commands());
///   dialogue.answered(…) and dialogue.advance(now) until is_done()
class SlcanDialogue {
 public:
  /// `inquires`: before opening, ask an adapter that answers for its version and serial number.
  SlcanDialogue(SlcanOpening opening, bool await_answers, bool inquires);

  void begin(Time now);

  /// To be called when the adapter has answered: CR, or BEL.
  void answered(bool accepted, Time now);

  /// To be called with an answer about the adapter itself: "V1013".
  void told(std::string_view answer, Time now);

  /// Takes the steps that are due.
  void advance(Time now);

  [[nodiscard]] Time deadline() const { return deadline_; }

  /// The bytes to write now; empty: none.
  [[nodiscard]] std::string take_commands();

  [[nodiscard]] bool is_done() const { return next_ == commands_.size() && !waiting_; }

  /// Whether the adapter has answered anything.
  [[nodiscard]] bool adapter_answers() const { return answers_ > 0; }

  /// Whether answers were awaited and none came.
  [[nodiscard]] bool waited_in_vain() const { return silences_ > 0 && answers_ == 0; }

  /// The number of commands whose answer may still come.
  [[nodiscard]] std::size_t unanswered() const { return sent_ - answers_; }

  /// Whether the adapter refused the bit rate.
  [[nodiscard]] bool rate_refused() const { return rate_refused_; }

  /// Whether the adapter refused to open; it may have been open already.
  [[nodiscard]] bool open_refused() const { return open_refused_; }

  /// Whether it refused both the bit rate and to open. A refused O alone means that it is open.
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
