#pragma once
// What format a log has, told by its content.

#include "blactl/can/log_line.hpp"

#include "can/log/asc.hpp"
#include "can/log/trc.hpp"

#include <optional>
#include <string_view>
#include <variant>

namespace blactl::can {

/// The first line that is a header of ASC or TRC, or a frame of candump, decides for the whole log.
class LogFormat {
 public:
  /// Empty: not a line of this format. The strings are valid until the next call. Never allocates.
  [[nodiscard]] std::optional<LogLine> parse(std::string_view line);

 private:
  struct Unknown {};

  struct Candump {};

  void recognize(std::string_view line);

  std::variant<Unknown, Candump, AscLog, TrcLog> format_;
};

} // namespace blactl::can
