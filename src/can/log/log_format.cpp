#include "can/log/log_format.hpp"

#include "blactl/can/candump.hpp"

namespace blactl::can {

std::optional<LogLine> LogFormat::parse(std::string_view line) {
  if (std::holds_alternative<Unknown>(format_)) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; // of editors on Windows
    line.remove_prefix(line.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
    recognize(line);
  }
  if (auto* const asc = std::get_if<AscLog>(&format_)) {
    return asc->parse(line);
  }
  if (auto* const trc = std::get_if<TrcLog>(&format_)) {
    return trc->parse(line);
  }
  auto parsed = parse_line(line);
  if (parsed && parsed->kind != LogLine::Kind::other) {
    format_ = Candump();
  }
  return parsed;
}

void LogFormat::recognize(std::string_view line) {
  if (AscLog::begins(line)) {
    format_ = AscLog();
  } else if (TrcLog::begins(line)) {
    format_ = TrcLog();
  }
}

} // namespace blactl::can
