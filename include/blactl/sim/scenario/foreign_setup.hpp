#pragma once
// What a scenario says of a node that is no BLA servo.

#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace blactl::sim {

/// A stream of ArrayCommand, as an autopilot sends it.
struct CommanderSetup {
  std::vector<std::uint8_t> servo_ids;
  std::uint8_t type = 1; ///< table 2-21
  float value = 0;
  Duration period = std::chrono::milliseconds(20);
};

/// Nothing but what every node does.
struct PlainSetup {};

/// A satellite receiver.
struct GnssSetup {
  Duration period = std::chrono::milliseconds(200); ///< of Fix2: what such receivers default to
};

/// An electronic speed controller.
struct EscSetup {
  std::uint8_t index = 0;                          ///< esc_index of esc.Status, 0..31
  Duration period = std::chrono::milliseconds(20); ///< of esc.Status
};

/// A flight controller.
struct AutopilotSetup {
  bool allocates = false; ///< gives node IDs to those who ask
};

/// A node that talks without end.
struct BabblerSetup {
  dronecan::Priority priority = dronecan::priority_medium;
  double load = 0.5; ///< of the bus, 0 to 1
};

struct ForeignSetup {
  std::uint8_t node_id = 1;
  std::string name;
  dronecan::UniqueId unique_id{};
  bool serves_get_set = false;
  std::optional<CommanderSetup> commands;
  std::optional<bool> armed; ///< empty: sends no ArmingStatus
  std::variant<PlainSetup, GnssSetup, EscSetup, AutopilotSetup, BabblerSetup> kind;
};

} // namespace blactl::sim
