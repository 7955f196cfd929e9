#include "cli/line/station_name.hpp"

#include <unistd.h>

#include <array>

namespace blactl::cli {

std::optional<std::string> unless_empty(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(text);
}

state::LedgerRecord record_of_station(const std::string& station) {
  std::array<char, 256> host{};
  const bool is_named = gethostname(host.data(), host.size() - 1) == 0;
  state::LedgerRecord record;
  record.machine = is_named ? host.data() : "localhost";
  record.station = station.empty() ? record.machine : station;
  record.tool_version = BLACTL_VERSION;
  return record;
}

} // namespace blactl::cli
