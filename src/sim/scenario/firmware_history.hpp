#pragma once
// The firmware releases of a model (BLA spec rev 1.11, chapter 5).

#include "blactl/bla/profile.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace blactl::sim {

/// The versions in chapter 5 with which this model left the factory, ascending. `model` may be a
/// label ("BLA21-12U-AB2") or lack its last digit. Empty: the model is not in chapter 5.
[[nodiscard]] std::vector<std::int64_t> shipped_firmware(const bla::Profiles& profiles,
                                                         std::string_view model);

} // namespace blactl::sim
