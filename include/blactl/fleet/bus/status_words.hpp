#pragma once
// What NodeStatus says, in words for people. Documents have dronecan::name() instead.

#include "blactl/dronecan/types.hpp"

#include <string>

namespace blactl::fleet {

[[nodiscard]] std::string health_word(dronecan::Health health);

/// A mode that DroneCAN does not define is a number.
[[nodiscard]] std::string mode_word(dronecan::Mode mode);

} // namespace blactl::fleet
