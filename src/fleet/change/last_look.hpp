#pragma once
// The last look at servos that were done before others.

#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/session.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// What a servo must show.
enum class LastLook : std::uint8_t {
  run,  ///< it has run on: what was proven is in RAM only
  unit, ///< it is there; that it has restarted since is learnt by the roster
};

/// A servo that was proven less than this time ago needs no last look at its ROM.
inline constexpr Duration long_ago = std::chrono::seconds(1);

/// Why a servo does not hold any more what was proven while others were still at work: of each its
/// error, state (it has restarted, or cannot prove that it has not; another servo is in its place),
/// timeout or duplicate_node_id; empty: it shows what it must. Errors: as Session::run().
[[nodiscard]] Result<std::vector<std::optional<Error>>>
look_last(Session& session, std::span<const Servo> servos, Patience patience, LastLook look);

} // namespace blactl::fleet
