#include "blactl/can/slcan_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace blactl::can {
namespace {

constexpr char bell = '\a';

/// All of `digits` as a hexadecimal number; there are at most eight.
std::optional<std::uint32_t> hex(std::string_view digits) {
  std::uint32_t value = 0;
  const auto [stop, error] = std::from_chars(digits.begin(), digits.end(), value, 16);
  return !digits.empty() && error == std::errc() && stop == digits.end() ? std::optional(value)
                                                                         : std::nullopt;
}

/// Reads what may follow the data: a time, and the mark of our own frame.
std::optional<SlcanLine::Kind> trailer(std::string_view rest) {
  constexpr std::size_t time_digits = 4;
  const bool own = rest.ends_with('L');
  if (own) {
    rest.remove_suffix(1);
  }
  if (!rest.empty() && (rest.size() != time_digits || !hex(rest))) {
    return std::nullopt;
  }
  return own ? SlcanLine::Kind::loopback : SlcanLine::Kind::frame;
}

std::optional<SlcanLine> parse_frame(std::string_view line) {
  Frame frame;
  frame.extended = line[0] == 'T' || line[0] == 'R';
  frame.remote = line[0] == 'R' || line[0] == 'r';
  const std::size_t id_digits = frame.extended ? 8 : 3;
  if (line.size() < 1 + id_digits + 1) {
    return std::nullopt;
  }
  const auto id = hex(line.substr(1, id_digits));
  const auto size = hex(line.substr(1 + id_digits, 1));
  if (!id || *id > (frame.extended ? extended_id_mask : 0x7FFU) || !size ||
      *size > frame.data.size()) {
    return std::nullopt;
  }
  frame.id = *id;
  frame.size = static_cast<std::uint8_t>(*size);
  line.remove_prefix(1 + id_digits + 1);
  const std::size_t carried = frame.remote ? 0 : frame.size; // a remote frame has a size, no data
  if (line.size() < 2 * carried) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < carried; ++i) {
    const auto byte = hex(line.substr(2 * i, 2));
    if (!byte) {
      return std::nullopt;
    }
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  const auto kind = trailer(line.substr(2 * carried));
  return kind ? std::optional(SlcanLine{.kind = *kind, .frame = frame}) : std::nullopt;
}

/// "V1010", "N1234", "F00"; not a word of a text, which would have other characters than letters
/// and digits, or stand among others.
bool is_told(std::string_view line) {
  constexpr std::size_t status_digits = 2;
  const std::string_view answer = line.substr(1);
  if (line[0] == 'F') {
    return answer.size() == status_digits && hex(answer);
  }
  return (line[0] == 'V' || line[0] == 'N') && !answer.empty() &&
         std::ranges::all_of(answer, [](char byte) {
           return (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                  (byte >= 'a' && byte <= 'z') || byte == '.' || byte == '-' || byte == '_';
         });
}

SlcanLine parse(std::string_view line) {
  if (line.empty() || line == "Z" || line == "z") {
    return {.kind = SlcanLine::Kind::done};
  }
  constexpr std::string_view frames = "TtRr";
  if (frames.find(line[0]) != std::string_view::npos) {
    return parse_frame(line).value_or(SlcanLine{});
  }
  if (is_told(line)) {
    return {.kind = SlcanLine::Kind::told, .told = std::string(line)};
  }
  return {};
}

} // namespace

std::string to_slcan(const Frame& frame) {
  std::string line;
  auto out = std::back_inserter(line);
  if (frame.extended) {
    fmt::format_to(out, "{}{:08X}{:X}", frame.remote ? 'R' : 'T', frame.id, frame.size);
  } else {
    fmt::format_to(out, "{}{:03X}{:X}", frame.remote ? 'r' : 't', frame.id, frame.size);
  }
  if (!frame.remote) {
    for (const std::uint8_t byte : frame.payload()) {
      fmt::format_to(out, "{:02X}", byte);
    }
  }
  line += '\r';
  return line;
}

std::optional<SlcanLine> SlcanParser::take(char byte) {
  if (byte == bell) {
    size_ = 0;
    spoilt_ = false;
    return SlcanLine{.kind = SlcanLine::Kind::refused};
  }
  if (byte == '\n' && size_ == 0 && !spoilt_) {
    return std::nullopt; // of CR LF
  }
  if (byte == '\r' || byte == '\n') {
    return finish();
  }
  if (byte == 'T') {
    size_ = 0;
    spoilt_ = false;
  }
  const bool printable = byte > ' ' && byte <= '~';
  if (spoilt_ || !printable || size_ == line_.size()) {
    spoilt_ = true;
    return std::nullopt;
  }
  line_[size_++] = byte;
  return std::nullopt;
}

SlcanLine SlcanParser::finish() {
  const SlcanLine line = spoilt_ ? SlcanLine{} : parse({line_.data(), size_});
  size_ = 0;
  spoilt_ = false;
  return line;
}

} // namespace blactl::can
