#pragma once
// One simulated servo as a scenario describes it.

#include "blactl/bla/parameter.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/sim/node/delayed_device.hpp"
#include "blactl/sim/servo/behaviour.hpp"
#include "blactl/sim/servo/servo_faults.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace blactl::sim {

struct ServoSetup {
  const bla::Profile* profile = nullptr; ///< from the Profiles used to read the scenario
  std::uint8_t node_id = 0;              ///< 0x46 in ROM
  dronecan::UniqueId unique_id{};
  std::int64_t serial_number = 0; ///< 0x51
  std::int64_t servo_id = 0;      ///< 0x45 in ROM
  std::int64_t model_number = 0, firmware_version = 0, hardware_version = 0;
  std::string name; ///< of GetNodeInfo; unproven: the name of real servos
  // Both hold registers other than those above.
  std::vector<std::pair<bla::Address, std::int64_t>> rom; ///< instead of the factory's values
  std::vector<std::pair<bla::Address, std::int64_t>> ram; ///< over ROM, once at power-on
  Behaviour behaviour;
  ServoFaults faults;
  SendingFaults sending;
};

} // namespace blactl::sim
