#pragma once
// Which run of this machine a clock that waits belongs to.

#include <string_view>

namespace blactl::state {

/// The kernel's name for the present run of this machine; empty: unknown.
[[nodiscard]] std::string_view boot_id();

} // namespace blactl::state
