#pragma once
// Changes of a simulated servo's surroundings as typed: "voltage=5V".

#include "blactl/base/error.hpp"
#include "blactl/sim/servo/world.hpp"

#include <functional>
#include <string_view>

namespace blactl::sim {

/// Changes one member and leaves the others.
using WorldChange = std::function<void(World&)>;

/// Follows the value grammar of parameters (contract, section 4):
///
///   voltage=5.5V  temperature=95degC  load=-30%   hand=45.0deg or hand=free   pulse=1520us or
///   pulse=none    magnet=weak         stuck=on    driver_stopped=on  rotation_abnormal=on
///   plugged=off
///
/// Errors: usage (unknown key, with the list of keys; invalid value), out_of_range.
[[nodiscard]] Result<WorldChange> parse_world_change(std::string_view key, std::string_view value);

} // namespace blactl::sim
