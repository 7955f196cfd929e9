#pragma once
// The contents of a simulated bus, as a scenario file ("schema":"blactl-scenario/1").
//
//   {
//     "schema": "blactl-scenario/1",
//     "clock": "virtual",            real (default) or virtual
//     "seed": 7,                     of all random events; default 1
//     "servos": [
//       {
//         "model": "BLA21-12U-AB",   the only required key; or a label: BLA21-12U-AB2
//         "node_id": 11,             0x46 in ROM; 0 (default): asks an allocator
//         "unique_id": "00112233445566778899aabbccddeeff",   default: from the serial number
//         "serial_number": 240900558,      default 240900001 and up
//         "servo_id": 1,                   0x45 in ROM; default 0
//         "firmware_version": 1400,        default: the newest of chapter 5
//         "model_number": 61,              this and the next: default as the model has it
//         "hardware_version": 12050,
//         "name": "jp.co.futaba.bla21",    of GetNodeInfo
//         "answer_delay": "0.5ms",         a value of time; an integer counts us
//         "rom": {"angle_limit_cw": "90deg"},    what SAVE keeps; default: factory values
//         "ram": {"reverse": "on", "current_voltage": "11.8V", "fault_warning": 16},
//         "behaviour": {"out_of_range": "clamp", "rom_write_time": "80ms"},
//         "faults": {"lose_opcode_answers": 1, "return_delay": "3s",
//                    "restart_after_answer": [{"to": "write", "number": 2}]},
//         "sending": {"jitter": "2ms", "late_answers": 0.01, "late_by": "2s", "double_answers":
//         0.01}
//       }
//     ],
//     "wire": {                              random faults; default: none
//       "loss": 0.01, "duplication": 0.01, "errors": 0.001, "bit_flips": 0.001,
//       "burst_interval": "2s", "burst_length": "3ms"
//     },
//     "foreign": [
//       {
//         "kind": "node",                  or one of those below
//         "node_id": 30,
//         "name": "org.ardupilot.f405",
//         "serves_get_set": true,          answers GetSet as a node without parameters
//         "commands": {"servo_ids": [1, 2], "type": 1, "value": 0.45, "rate": 50},
//         "orders": [{"at": "2s", "to": 11, "order": "erase"},    or save, restart, initialize
//                    {"at": "3s", "to": 11, "order": "write", "address": 56, "value": 900}],
//         "armed": false,                  sends ArmingStatus
//         "actuator_id": 3,                sends actuator.Status
//         "status_period": "1s"            of NodeStatus
//       },
//       {"kind": "gnss", "node_id": 31, "rate": 5},         Fix2 and Auxiliary
//       {"kind": "esc", "node_id": 32, "index": 0, "rate": 50},      with its own parameters
//       {"kind": "autopilot", "node_id": 33, "allocates": true},     disarmed; gives node IDs
//       {"kind": "babbler", "node_id": 34, "priority": 16, "load": 0.5}
//     ],
//     "events": [                            at times after power-on
//       {"at": "2s", "servo": 240900558, "world": {"voltage": "5V", "hand": "45deg"}},
//       {"at": "3s", "clients": "cut"},      joined, cut or bus_off
//       {"at": "4s", "servo": 240900558, "happens": "power_off"}
//     ]
//   }
//
// At power-on RAM is loaded from ROM, then from "ram". A restart loads it from ROM as it is then.
// The values that "ram" gives 0x0B, 0x0C and 0x19-0x1B are not the servo's memory but its
// surroundings (World), and stay, as those from 0x50 up do; the values of 0x08 and 0x09 are the
// angle and speed of the shaft at power-on. "behaviour" has the members of Behaviour, "faults"
// those of ServoFaults, "sending" those of SendingFaults, "wire" those of WireFaults; in
// "restart_after_answer" both keys are optional: "to" defaults to "any", "number" to 1. An event
// names its servo by the serial number; "world" has the keys of parse_world_change(), "happens" is
// power_off, power_on, clock_error, watchdog_error, ram_error or rom_error (Mishap), and at least
// one of the two is required. Every kind of foreign node has the keys of "node", too. A firmware
// that the model never had (chapter 5) gives a warning. schemas/scenario.schema.json describes all
// of this for editors.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/sim/scenario/foreign_setup.hpp"
#include "blactl/sim/scenario/timeline.hpp"
#include "blactl/sim/scenario/wire_faults.hpp"
#include "blactl/sim/servo/behaviour.hpp"
#include "blactl/sim/servo/servo_setup.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::sim {

enum class Clock : std::uint8_t { real, simulated };

struct Scenario {
  Clock clock = Clock::real;
  std::uint64_t seed = 1;
  std::vector<ServoSetup> servos;
  std::vector<ForeignSetup> foreign;
  WireFaults wire;
  std::vector<TimedEvent> events;
  std::vector<std::string> warnings; ///< odd but possible: "file:line: /pointer: why"
};

/// Both refer to `profiles`, which must outlive the scenario. `usual`: the defaults for the servos'
/// "behaviour" (see facts.hpp). Errors: bad_file with file, line, JSON pointer and reason for each
/// error.
[[nodiscard]] Result<Scenario> read_scenario(const std::filesystem::path& file,
                                             const bla::Profiles& profiles,
                                             const Behaviour& usual = {});
[[nodiscard]] Result<Scenario> parse_scenario(std::string_view text, std::string file,
                                              const bla::Profiles& profiles,
                                              const Behaviour& usual = {});

/// Three servos with static IDs: BLA21-12U-AB at 11, BLA15-06U-A0 at 12, BLA34-28U-AB at 13.
[[nodiscard]] Result<Scenario> default_scenario(const bla::Profiles& profiles,
                                                const Behaviour& usual = {});

} // namespace blactl::sim
