#pragma once
// Which firmware a model ever had (BLA spec rev 1.11, chapter 5).

#include "blactl/bla/profile.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace blactl::sim {

/// The versions of chapter 5 that left the factory in this model, ascending. `model` may be a label
/// ("BLA21-12U-AB2") or lack its last digit. Empty: chapter 5 does not know the model.
[[nodiscard]] std::vector<std::int64_t> shipped_firmware(const bla::Profiles& profiles,
                                                         std::string_view model);

} // namespace blactl::sim
