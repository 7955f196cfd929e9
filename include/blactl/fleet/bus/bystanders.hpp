#pragma once
// An ArrayCommand reaches all servos: who else may obey it.

#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <cstdint>
#include <map>
#include <optional>

namespace blactl::fleet {

/// The other nodes at the moment when it was made.
class Bystanders {
 public:
  explicit Bystanders(const Roster& roster);

  /// A node other than this servo that may obey commands to this servo ID: it reports that ID, or
  /// it appeared or restarted since, so that its servo ID is not known.
  [[nodiscard]] std::optional<dronecan::NodeId> obeys(const Roster& roster, const Servo& servo,
                                                      std::int64_t servo_id) const;

 private:
  std::map<dronecan::NodeId, std::uint32_t> boots_{};
};

} // namespace blactl::fleet
