#pragma once
// The behaviour of a simulated servo where the BLA specification (rev 1.11) is silent or
// contradicts itself; only a real servo can settle it.

#include "blactl/base/time.hpp"

#include <chrono>
#include <cstdint>
#include <optional>

namespace blactl::sim {

/// The reaction to a written value out of range (requirement 78): the servo keeps the present value
/// and responds with it, takes the nearest, or responds with the failure of table 2-16.
enum class OutOfRange : std::uint8_t { refuse, clamp, fail };

/// The response to a read of a missing register: a failure, or the value 0.
enum class MissingRead : std::uint8_t { fail, zero };

/// The reaction to a command of ArrayCommand that is NaN or infinite (requirement 107).
enum class NotANumber : std::uint8_t { ignore, zero };

/// The reaction to a UNITLESS command beyond -1 to +1 (table 2-21): more than 180 deg inside the
/// limits 0x38 and 0x39, 180 deg, or none.
enum class BeyondUnitless : std::uint8_t { limits, clamp, ignore };

/// The contents of the unused fields of actuator.Status (table 2-22).
enum class UnusedFields : std::uint8_t { unknown, zero };

/// The reaction to a speed command below the servo's lowest speed (4.2).
enum class SlowSpeed : std::uint8_t { stands, turns_slowest };

/// The reaction to a speed or torque of ArrayCommand out of the range of its register (FORCE 150,
/// SPEED 400), which need not be that of GetSet.
enum class ArrayOutOfRange : std::uint8_t { ignore, clamp };

/// The value of 0x00 after a start in place (4.14): the present angle, or the 0 of table 3-1.
enum class StartAngle : std::uint8_t { present, zero };

/// unproven: all of it. The defaults are the likelier choices.
struct Behaviour {
  // Responses.
  OutOfRange out_of_range = OutOfRange::refuse;
  MissingRead reserved_reads = MissingRead::fail;   ///< reserved addresses up to 0x5F
  MissingRead gated_reads = MissingRead::fail;      ///< registers the firmware lacks
  MissingRead write_only_reads = MissingRead::fail; ///< 0x10-0x12, 0x49
  bool index_only_access = true;                    ///< GetSet accepts index = address
  bool failure_with_name = false;                   ///< table 2-16 shows no name
  bool ignores_disabled_commands = true;            ///< 0x01, 0x02 keep their value while 0x25 = 0
  bool answers_save_first = true;                   ///< SAVE and 0x12; false: no response at all
  bool array_command_shows = true; ///< 0x00-0x02 read back the values from ArrayCommand
  StartAngle start_angle = StartAngle::present;

  // Messages.
  UnusedFields unused_fields = UnusedFields::unknown; ///< DSDL's NaN and 127, or 0
  bool notices_warn = false;                          ///< bits of 0x19, too, set health to 1
  bool assignment_shows = false; ///< mode 1 (table 2-19) in the first NodeStatus under a new ID
  /// The delay from the start, or from getting an ID, to the first NodeStatus; up to 1 s. The
  /// common DroneCAN libraries send at once; section 2.2 only asks for one a second.
  Duration first_node_status{};

  // Commands.
  NotANumber not_a_number = NotANumber::ignore;
  BeyondUnitless beyond_unitless = BeyondUnitless::limits;
  SlowSpeed slow_speed = SlowSpeed::stands; ///< below 10 rpm
  ArrayOutOfRange array_out_of_range = ArrayOutOfRange::ignore;
  bool obeys_servo_id_0 = true; ///< ArrayCommand to 0: table 2-22 has that ID, table 2-20 has not
  bool array_command_feeds_timeout = true; ///< 4.19 lists registers only
  bool get_set_feeds_timeout = false;      ///< any other GetSet, reads too
  bool timeout_beats_brake = false; ///< 0x26 = OFF releases the brake of 0x20; else the brake stays
  bool keeps_disabled_command = true; ///< 0x01, 0x02 survive 0x25 = 0; else they become 0
  bool keeps_limited_angle = true;    ///< 0x00 beyond 0x38, 0x39 stays; else it becomes the limit
  bool erase_holds = true; ///< 0x10, ERASE while 0x20 is OFF or brake: as in 4.13; else to 0 deg
  bool erase_clears_rom = false; ///< 0x10, ERASE put ROM back to defaults, too (3); else RAM only
  bool speed_control_before_1100 = false; ///< a firmware without 0x25 acts as if it were ON, or OFF

  // Settings.
  bool settings_wait_for_start = false; ///< 0x23, 0x27, 0x44, 0x45 take effect at the next start
  bool reverse_turns_origin = false;    ///< with 0x23 the offset 0x44 counts the other way, too

  // Faults.
  bool inclusive_limits = true; ///< bits of 4.12 as in Japanese; in English: only beyond the limit
  bool inclusive_stops = false; ///< stops at a limit of 0x3E-0x41; else only beyond it (4.7)
  bool failures_latch = false;  ///< 0x1B.0, .1, .5 stay until the next start
  bool restart_keeps_failures = false; ///< bits of 0x1B that stay outlive all but a loss of supply
  bool command_at_limit_notifies = false; ///< 0x00 = 0x38 or 0x39 sets 0x19.8, .9 (4.12; not 4.31)
  bool restart_bits_stop = false;         ///< 0x1B.8, .9, .11 keep the motor off
  bool boost_in_dead_band = false;        ///< 0x2F is effective inside the dead band, too

  // PWM (4.30) and soft start (4.14).
  bool pwm_end_points_move = true;          ///< the ends of the pulse range are valid
  bool pwm_waits_after_start = false;       ///< no pulse is valid within 0x27 after the start
  bool pwm_yields_to_all = true;            ///< also to 0x02 and 0x20; else to 0x00 and 0x01 only
  bool soft_start_shows = false;            ///< reads show the limits of the soft start
  bool soft_start_keeps_speed = false;      ///< 0x01, 0x02 are accepted, and end it, while 0x25 = 0
  bool output_write_ends_soft_start = true; ///< 0x20 = ON: full speed; else on slowly to 0 deg
  bool soft_start_resumes = false; ///< after a cut by timeout it resumes with the next command

  Duration rom_write_time = std::chrono::milliseconds(50); ///< "about 0.05 s" (4.11); up to 10 s
  /// The delay from a request to its response; up to 10 s. A servo of a scenario has its own key
  /// for it.
  Duration answer_delay = std::chrono::microseconds(500);
  /// The time from power or restart to the first frame; up to 10 s. Empty: 50 to 150 ms, varying
  /// from start to start.
  std::optional<Duration> boot_time;
};

} // namespace blactl::sim
