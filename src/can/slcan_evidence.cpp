#include "can/slcan_evidence.hpp"

namespace blactl::can {
namespace {

/// The weight of a meaningless line: satellite receivers and modems send printable text.
constexpr std::size_t line_without_meaning = 16;

/// At a wrong baud rate some bytes look like an empty line; a few of those prove nothing.
constexpr std::size_t garbage_for_a_line = 8;

/// The first line may have lost its beginning.
constexpr std::size_t least_text_lines = 2;

/// Enough garbage in a dialogue without any answer, and enough in a channel that should be open.
constexpr std::size_t least_in_dialogue = 4;
constexpr std::size_t least_afterwards = 64;

bool is_of_a_line(char byte) {
  return (byte >= ' ' && byte <= '~') || byte == '\r' || byte == '\n' || byte == '\a';
}

} // namespace

void SlcanEvidence::heard(char byte) {
  ++bytes_;
  mavlink_.take(static_cast<std::uint8_t>(byte));
  if (!is_of_a_line(byte)) {
    ++strange_bytes_;
    ++garbage_;
    any_garbage_ = true;
  }
}

void SlcanEvidence::understood(const SlcanLine& line) {
  if (line.kind == SlcanLine::Kind::other) {
    ++strange_lines_;
    garbage_ += line_without_meaning;
    any_garbage_ = true;
    return;
  }
  if (line.kind == SlcanLine::Kind::refused || line.kind == SlcanLine::Kind::told) {
    return; // a single byte occurs in any garbage, a word in any text
  }
  ++understood_;
  ++lines_;
}

void SlcanEvidence::frame_answered(bool accepted) {
  ++(accepted ? accepted_ : refused_);
}

void SlcanEvidence::dialogue_ended(bool answered) {
  spoke_clearly_ = answered && garbage_ == 0;
  in_dialogue_ = false;
  garbage_ = 0;
  lines_ = 0;
}

bool SlcanEvidence::mostly_garbage(std::size_t least) const {
  return garbage_ >= least && garbage_ > garbage_for_a_line * lines_;
}

ForeignSpeech SlcanEvidence::speech() const {
  if (mavlink_.has_heard()) {
    return ForeignSpeech::mavlink;
  }
  const bool is_text =
      strange_lines_ >= least_text_lines && strange_lines_ > understood_ && strange_bytes_ == 0;
  return is_text ? ForeignSpeech::text : ForeignSpeech::none;
}

bool SlcanEvidence::is_no_slcan() const {
  return in_dialogue_ ? mostly_garbage(least_in_dialogue)
                      : !spoke_clearly_ && mostly_garbage(least_afterwards);
}

} // namespace blactl::can
