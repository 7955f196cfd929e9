#pragma once
// What is on a simulated bus: a scenario file ("schema":"blactl-scenario/1").
//
//   {
//     "schema": "blactl-scenario/1",
//     "clock": "virtual",            real (default) or virtual
//     "seed": 7,                     of everything that happens by chance; default 1
//     "servos": [
//       {
//         "model": "BLA21-12U-AB",   the only key that must be there
//         "node_id": 11,             0x46 in ROM; 0 (default): asks an allocator
//         "unique_id": "00112233445566778899aabbccddeeff",   default: from the serial number
//         "serial_number": 240900558,      default 240900001 and up
//         "servo_id": 1,                   0x45 in ROM; default 0
//         "firmware_version": 1400,        default: the newest of chapter 5
//         "model_number": 61,              this and the next: default as the model has it
//         "hardware_version": 12050,
//         "name": "jp.co.futaba.bla21",    of GetNodeInfo
//         "answer_delay": "0.5ms",         a value of time; an integer counts us
//         "rom": {"angle_limit_cw": "90deg"},     of 0x20-0x46; default: as from the factory
//         "ram": {"reverse": "on", "current_voltage": "11.8V", "fault_warning": 16},
//         "behaviour": {"out_of_range": "clamp", "rom_write_time": "80ms"},
//         "faults": {"lose_opcode_answers": 1, "return_delay": "3s"},
//         "sending": {"jitter": "2ms", "late_answers": 0.01, "late_by": "2s", "double_answers":
//         0.01}
//       }
//     ],
//     "wire": {                              what goes wrong by chance; default: nothing
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
//         "armed": false                   sends ArmingStatus
//       },
//       {"kind": "gnss", "node_id": 31, "rate": 5},         Fix2 and Auxiliary
//       {"kind": "esc", "node_id": 32, "index": 0, "rate": 50},      with parameters of its own
//       {"kind": "autopilot", "node_id": 33, "allocates": true},     disarmed; gives node IDs
//       {"kind": "babbler", "node_id": 34, "priority": 16, "load": 0.5}
//     ],
//     "events": [                            at times after power-on
//       {"at": "2s", "servo": 240900558, "world": {"voltage": "5V", "hand": "45deg"}},
//       {"at": "3s", "clients": "cut"}       joined, cut or bus_off
//     ]
//   }
//
// At power-on RAM is what ROM holds, then what "ram" says. A restart brings back what ROM holds by
// then; what "ram" says of 0x0B, 0x0C and 0x19-0x1B is no memory of the servo but the world around
// it (World), and stays, as 0x50 up does; of 0x08 and 0x09 how the shaft stands and turns at
// power-on. "behaviour" has the members of Behaviour, "faults" those of ServoFaults, "sending"
// those of SendingFaults, "wire" those of WireFaults; an event names its servo by the serial
// number, and "world" has the keys of parse_world_change(). Every kind of foreign node has the keys
// of "node", too. What all of this may be, schemas/scenario.schema.json says to an editor.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/bla/parameter.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/sim/delayed_device.hpp"
#include "blactl/sim/foreign_setup.hpp"
#include "blactl/sim/timeline.hpp"
#include "blactl/sim/wire_faults.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::sim {

enum class Clock : std::uint8_t { real, simulated };

/// What a servo does with a written value that is out of range (requirement 78).
enum class OutOfRange : std::uint8_t { refuse, clamp };

/// What the read of a register answers that is not there: a failure, or the value 0.
enum class MissingRead : std::uint8_t { fail, zero };

/// What a servo does with a command of ArrayCommand that is no number or infinite (requirement
/// 107).
enum class NotANumber : std::uint8_t { ignore, zero };

/// What the unused numbers of actuator.Status hold (table 2-22).
enum class UnusedFields : std::uint8_t { unknown, zero };

/// What a speed command does that is slower than the servo can turn (4.2).
enum class SlowSpeed : std::uint8_t { stands, turns_slowest };

/// What only a real servo can tell. The defaults are what is likelier.
struct Behaviour {
  OutOfRange out_of_range = OutOfRange::refuse;     ///< unproven
  MissingRead reserved_reads = MissingRead::fail;   ///< unproven: reserved addresses up to 0x5F
  MissingRead gated_reads = MissingRead::fail;      ///< unproven: registers the firmware lacks
  MissingRead write_only_reads = MissingRead::fail; ///< unproven: 0x10-0x12, 0x49
  bool index_only_access = true;                    ///< unproven: GetSet by index = address
  bool failure_with_name = false;                   ///< unproven: table 2-16 prints no name
  bool ignores_disabled_commands = true; ///< unproven: 0x01, 0x02 keep their value while 0x25 = 0
  bool answers_save_first = true; ///< unproven: SAVE and 0x12; false: there is no answer at all
  NotANumber not_a_number = NotANumber::ignore;       ///< unproven
  UnusedFields unused_fields = UnusedFields::unknown; ///< unproven: DSDL's NaN and 127, or 0
  SlowSpeed slow_speed = SlowSpeed::stands;           ///< unproven: below 10 rpm
  bool array_command_shows = true;         ///< unproven: 0x00-0x02 read what ArrayCommand brought
  bool array_command_feeds_timeout = true; ///< unproven: 4.19 lists registers only
  bool get_set_feeds_timeout = false;      ///< unproven: any other GetSet, reads too
  bool inclusive_limits = true;            ///< unproven: 4.12 as in Japanese; English: beyond only
  bool failures_latch = false;             ///< unproven: 0x1B.0, .1, .5 stay until the next start
  bool notices_warn = false;               ///< unproven: bits of 0x19 too make health 1
  bool pwm_end_points_move = true;         ///< unproven: the ends of the pulse range are valid
  bool pwm_waits_after_start = false;      ///< unproven: no pulse counts for 0x27 after the start
  bool boost_in_dead_band = false;         ///< unproven: 0x2F pushes inside the dead band, too
  bool soft_start_shows = false;           ///< unproven: reads tell the limits of the soft start
  Duration rom_write_time = std::chrono::milliseconds(50); ///< "about 0.05 s" (4.11); up to 10 s
};

/// What goes wrong with a servo. Orders are SAVE, ERASE, RestartNode with the right magic number,
/// and 1 written to 0x10, 0x11 or 0x12.
struct ServoFaults {
  std::uint32_t lose_responses = 0;      ///< the first so many answers never reach the bus
  bool mute = false;                     ///< none ever does; its messages go on
  std::uint32_t lose_opcode_answers = 0; ///< the first so many orders are obeyed without an answer
  std::uint32_t ignore_opcodes = 0;      ///< the first so many are neither obeyed nor answered
  bool refuse_opcodes = false;           ///< all are answered with ok=false, or a failure of GetSet
  bool rom_write_fails = false; ///< ok, silence, restart as ever, and counted, but ROM is as it was
  bool stays = false;           ///< answers ok and writes ROM, but does not restart
  bool never_returns = false;   ///< is dead after its first restart
  std::uint32_t restart_instead_of_answer = 0;  ///< to this request of a service, the first is 1
  std::optional<Duration> power_loss_in_save{}; ///< once, so long after the ROM write has begun
  Duration return_delay{}; ///< how much longer a restart takes than power-on; up to 600 s
};

struct ServoSetup {
  const bla::Profile* profile = nullptr; ///< of the Profiles that the scenario was read with
  std::uint8_t node_id = 0;              ///< 0x46 in ROM
  dronecan::UniqueId unique_id{};
  std::int64_t serial_number = 0; ///< 0x51
  std::int64_t servo_id = 0;      ///< 0x45 in ROM
  std::int64_t model_number = 0, firmware_version = 0, hardware_version = 0;
  std::string name; ///< of GetNodeInfo; unproven what real servos say
  Duration answer_delay = std::chrono::microseconds(500);
  // Both of other registers than those above.
  std::vector<std::pair<bla::Address, std::int64_t>> rom; ///< instead of the factory's values
  std::vector<std::pair<bla::Address, std::int64_t>> ram; ///< over ROM, once at power-on
  Behaviour behaviour;
  ServoFaults faults;
  SendingFaults sending;
};

struct Scenario {
  Clock clock = Clock::real;
  std::uint64_t seed = 1;
  std::vector<ServoSetup> servos;
  std::vector<ForeignSetup> foreign;
  WireFaults wire;
  std::vector<TimedEvent> events;
};

/// Both refer to `profiles`, which must outlive the scenario. `usual`: how a servo behaves as far
/// as its own "behaviour" says nothing else (see facts.hpp). Errors: bad_file with file, line, JSON
/// pointer and reason of every fault.
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
