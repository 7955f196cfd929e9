#include "can/slcan_dialogue.hpp"

#include <array>
#include <chrono>
#include <utility>

namespace blactl::can {
namespace {

// An empty line ends what a program before us left unfinished. C, because an open channel refuses
// another bit rate. S8 is 1 Mbit/s.
constexpr std::string_view set_rate = "S8\r";
constexpr std::string_view open_channel = "O\r";
constexpr std::array<std::string_view, 4> full{"\r", "C\r", set_rate, open_channel};
constexpr std::array<std::string_view, 1> plain{open_channel};

/// Longer than a USB converter holds bytes back (FTDI: 16 ms) and an autopilot needs for a turn.
constexpr Duration answer_time = std::chrono::milliseconds(250);

/// Many adapters do not answer an empty line.
constexpr Duration empty_line_time = std::chrono::milliseconds(100);

constexpr std::size_t most_silences = 2;

} // namespace

SlcanDialogue::SlcanDialogue(SlcanOpening opening, bool await_answers)
    : commands_(opening == SlcanOpening::plain ? std::span<const std::string_view>(plain)
                                               : std::span<const std::string_view>(full)),
      // The vendor's program waits for none, and whether its adapter sends any is unknown.
      await_answers_(await_answers && opening != SlcanOpening::plain) {}

void SlcanDialogue::begin(Time now) {
  send_next(now);
}

void SlcanDialogue::send_next(Time now) {
  waiting_ = false;
  deadline_ = never;
  while (next_ < commands_.size() && !waiting_) {
    const std::string_view command = commands_[next_++];
    out_ += command;
    if (await_answers_) {
      waiting_ = true;
      deadline_ = now + (command == "\r" ? empty_line_time : answer_time);
    }
  }
}

void SlcanDialogue::answered(bool accepted, Time now) {
  if (!waiting_) {
    return;
  }
  ++answers_;
  const std::string_view command = commands_[next_ - 1];
  rate_refused_ = rate_refused_ || (!accepted && command == set_rate);
  open_refused_ = open_refused_ || (!accepted && command == open_channel);
  send_next(now);
}

void SlcanDialogue::advance(Time now) {
  if (!waiting_ || now < deadline_) {
    return;
  }
  ++silences_;
  await_answers_ = answers_ > 0 || silences_ < most_silences;
  send_next(now);
}

std::string SlcanDialogue::take_commands() {
  return std::exchange(out_, {});
}

} // namespace blactl::can
