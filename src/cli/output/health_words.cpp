#include "cli/output/health_words.hpp"

#include <array>
#include <utility>

namespace blactl::cli {

std::string_view name(dronecan::Health health) {
  constexpr std::array<std::string_view, 4> words{"ok", "warning", "error", "critical"};
  return words[std::to_underlying(health) & 3U];
}

std::string_view name(dronecan::Mode mode) {
  switch (mode) {
  case dronecan::Mode::operational: return "operational";
  case dronecan::Mode::initialization: return "initialization";
  case dronecan::Mode::maintenance: return "maintenance";
  case dronecan::Mode::software_update: return "software_update";
  case dronecan::Mode::offline: return "offline";
  }
  return {};
}

} // namespace blactl::cli
