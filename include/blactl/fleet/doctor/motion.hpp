#pragma once
// Why a servo does not move, or not as it should: from the command to the shaft. Decided from what
// was read and heard; nothing is sent.

#include "blactl/bla/parameter.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/bus/command_watch.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/doctor/diagnosis.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <vector>

namespace blactl::fleet {

/// The motion commands of other nodes, as they concern one servo.
struct HeardCommands {
  struct Stream {
    dronecan::NodeId by{};
    Commander::Command command{};
  };

  std::vector<Stream> to_it{}; ///< those that count now
  /// By ArrayCommand to servo IDs that it does not have, now: who commands them.
  std::map<std::uint8_t, dronecan::NodeId> to_others{};
  std::set<std::uint8_t> vacant{}; ///< those of them that nothing on the bus is known to have
  /// It was listened for long enough to tell that nobody commands it. False: a file, a short log,
  /// one without times.
  bool is_long_enough = false;
};

/// What was heard of the commands to this servo up to `now`. `is_long_enough` is the caller's.
[[nodiscard]] HeardCommands commands_to(const Servo& servo, const Roster& roster, Time now);

/// Whether a servo on the bus has this servo ID, as far as known.
[[nodiscard]] bool has_servo_id(const Roster& roster, std::uint8_t servo_id);

/// The registers that diagnose_motion() needs.
[[nodiscard]] std::vector<const bla::Parameter*> registers_of_motion(const Servo& servo);

/// What keeps this servo from moving as it is commanded, in the order from the command to the
/// shaft. Unknown values are no reason for a finding. `rom`: what ROM holds, as far as known; what
/// is not known to be in RAM only is mended in ROM, too. Codes: not_commanded, commanded_other,
/// pwm_has_no_say, mode_without_effect, torque_off, fault_holds_off, torque_limit_zero,
/// speed_limit_zero, limits_without_effect, angle_limits, command_beyond_limit, torque_at_limit.
[[nodiscard]] Diagnoses diagnose_motion(const Snapshot& servo, const HeardCommands& heard,
                                        const bla::Profiles& profiles, MotionLook look,
                                        const bla::Values& rom);

} // namespace blactl::fleet
