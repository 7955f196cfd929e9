#pragma once
// The configuration of a node that is not a BLA servo, from a scenario.

#include "blactl/base/time.hpp"
#include "blactl/dronecan/ids.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace blactl::sim {

/// A stream of ArrayCommand, as sent by an autopilot.
struct CommanderSetup {
  std::vector<std::uint8_t> servo_ids;
  std::uint8_t type = 1; ///< table 2-21
  float value = 0;
  Duration period = std::chrono::milliseconds(20);
};

/// A request to a servo, as sent by another tool.
struct OrderSetup {
  Duration at{}; ///< after power-on
  std::uint8_t to = 1;
  enum class Order : std::uint8_t { erase, save, restart, initialize, write } order = Order::erase;
  std::uint8_t address = 0; ///< of the register to write
  std::int64_t value = 0;   ///< for it
};

/// A node with the behaviour common to all nodes, and nothing else.
struct PlainSetup {};

/// A satellite receiver.
struct GnssSetup {
  Duration period = std::chrono::milliseconds(200); ///< of Fix2: the default of such receivers
};

/// An electronic speed controller.
struct EscSetup {
  std::uint8_t index = 0;                          ///< esc_index of esc.Status, 0..31
  Duration period = std::chrono::milliseconds(20); ///< of esc.Status
};

/// A flight controller.
struct AutopilotSetup {
  bool allocates = false; ///< answers requests for node IDs
};

/// A node that floods the bus.
struct BabblerSetup {
  dronecan::Priority priority = dronecan::priority_medium;
  double load = 0.5; ///< share of the bus, 0 to 1
};

struct ForeignSetup {
  std::uint8_t node_id = 1;
  std::string name;
  dronecan::UniqueId unique_id{};
  bool serves_get_set = false;
  std::optional<CommanderSetup> commands;
  std::vector<OrderSetup> orders;          ///< in the order of time
  std::optional<bool> armed;               ///< empty: sends no ArmingStatus
  Duration joins{};                        ///< when it is switched on, after power-on
  Duration begins{};                       ///< of `commands`, and of being armed, after that
  std::optional<std::uint8_t> actuator_id; ///< empty: sends no actuator.Status
  Duration status_period =
      std::chrono::seconds(1); ///< of NodeStatus and ArmingStatus; 0: sends none
  std::variant<PlainSetup, GnssSetup, EscSetup, AutopilotSetup, BabblerSetup> kind;
};

} // namespace blactl::sim
