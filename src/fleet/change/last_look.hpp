#pragma once
// The last look at servos that were done before others.

#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/session.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

namespace blactl::fleet {

/// What a servo must show.
enum class LastLook : std::uint8_t {
  run,  ///< it has run on: what was proven is in RAM only
  unit, ///< it is there; that it has restarted since is learnt by the roster
};

/// A servo that was proven less than this time ago needs no last look at its ROM: what was sent to
/// others since has taken longer.
inline constexpr Duration long_ago = std::chrono::milliseconds(100);

/// Whether the servo on this node ID may have restarted, as far as heard, since it had this number
/// of boots and this health, empty: unknown. The health of a start without ROM differs.
[[nodiscard]] bool may_have_restarted(const Roster& roster, dronecan::NodeId id,
                                      std::uint32_t boots, std::optional<dronecan::Health> health);

/// Why reading proves nothing of the ROM of a servo that has restarted, and not by us: another tool
/// may have saved something, and written RAM since. Empty: it has not, as far as heard. `boots`: as
/// for may_have_restarted(). Errors: state.
[[nodiscard]] std::optional<Error> unproven_since(const Roster& roster, dronecan::NodeId id,
                                                  std::uint32_t boots);

/// Those that do not hold any more what was proven while others were still at work: state (it has
/// restarted, or cannot prove that it has not; another servo is in its place), timeout or
/// duplicate_node_id. Errors: as Session::run().
[[nodiscard]] Result<std::map<dronecan::NodeId, Error>>
look_last(Session& session, std::span<const Servo> servos, Patience patience, LastLook look);

} // namespace blactl::fleet
