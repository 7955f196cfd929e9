#include "can/slcan_dialogue.hpp"

#include <array>
#include <chrono>
#include <utility>

namespace blactl::can {
namespace {

// An empty line ends a command left unfinished by an earlier program. C, because an open channel
// refuses another bit rate. S8 is 1 Mbit/s.
constexpr std::string_view ask_version = "V\r", ask_serial_number = "N\r";
constexpr std::string_view set_rate = "S8\r";
constexpr std::string_view open_channel = "O\r";
constexpr std::array<std::string_view, 6> full{
    "\r", "C\r", ask_version, ask_serial_number, set_rate, open_channel};
constexpr std::array<std::string_view, 1> plain{open_channel};

/// Longer than a USB converter buffers (FTDI: 16 ms) and an autopilot's loop takes.
constexpr Duration answer_time = std::chrono::milliseconds(250);

/// Many adapters do not answer an empty line.
constexpr Duration empty_line_time = std::chrono::milliseconds(100);

constexpr std::size_t most_silences = 2;

} // namespace

SlcanDialogue::SlcanDialogue(SlcanOpening opening, bool await_answers, bool inquires)
    : commands_(opening == SlcanOpening::plain ? std::span<const std::string_view>(plain)
                                               : std::span<const std::string_view>(full)),
      // The vendor's program waits for none, and whether its adapter sends any is unknown.
      await_answers_(await_answers && opening != SlcanOpening::plain), inquires_(inquires) {}

void SlcanDialogue::begin(Time now) {
  send_next(now);
}

void SlcanDialogue::send_next(Time now) {
  waiting_ = false;
  deadline_ = never;
  while (next_ < commands_.size() && !waiting_) {
    const std::string_view command = commands_[next_++];
    if (is_left_out(command)) {
      continue;
    }
    ++sent_;
    out_ += command;
    if (await_answers_) {
      waiting_ = true;
      deadline_ = now + (command == "\r" ? empty_line_time : answer_time);
    }
  }
}

/// Whether to skip an inquiry: an adapter without any answer so far might be confused by it.
bool SlcanDialogue::is_left_out(std::string_view command) const {
  const bool is_inquiry = command == ask_version || command == ask_serial_number;
  return is_inquiry && (!inquires_ || !await_answers_ || answers_ == 0);
}

void SlcanDialogue::told(std::string_view answer, Time now) {
  if (waiting_ && commands_[next_ - 1].front() == answer.front()) {
    answered(true, now);
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
