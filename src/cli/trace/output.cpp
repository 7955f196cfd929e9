#include "cli/trace/output.hpp"

#include <array>
#include <utility>

namespace blactl::cli {

std::string_view name(TraceError error) {
  constexpr std::array<std::string_view, trace_errors> words{
      "crc", "toggle", "missing_start", "transfer_id", "truncated", "timeout", "short"};
  return words[std::to_underlying(error)];
}

std::string_view name(dronecan::Kind kind) {
  constexpr std::array<std::string_view, 3> words{"message", "request", "response"};
  return words[std::to_underlying(kind)];
}

} // namespace blactl::cli
