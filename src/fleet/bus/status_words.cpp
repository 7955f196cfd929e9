#include "blactl/fleet/bus/status_words.hpp"

#include "blactl/fleet/bus/texts.hpp"

#include <utility>

namespace blactl::fleet {

std::string health_word(dronecan::Health health) {
  using dronecan::Health;
  switch (health) {
  case Health::ok: return say<texts::health_ok>();
  case Health::warning: return say<texts::health_warning>();
  case Health::error: return say<texts::health_error>();
  case Health::critical: break;
  }
  return say<texts::health_critical>();
}

std::string mode_word(dronecan::Mode mode) {
  using dronecan::Mode;
  switch (mode) {
  case Mode::operational: return say<texts::mode_operational>();
  case Mode::initialization: return say<texts::mode_initialization>();
  case Mode::maintenance: return say<texts::mode_maintenance>();
  case Mode::software_update: return say<texts::mode_software_update>();
  case Mode::offline: return say<texts::mode_offline>();
  }
  return std::to_string(std::to_underlying(mode));
}

} // namespace blactl::fleet
