#pragma once
// The network interface of this machine that -i means.

#include "blactl/can/link.hpp"

#include <optional>
#include <string>

namespace blactl::cli {

/// What stands behind -i can be a network interface: its kind is one, or nothing was named.
[[nodiscard]] bool may_be_link(const std::string& interface);

/// The network interface behind -i, or the only one that could be meant; empty: there is none.
[[nodiscard]] std::optional<can::Link> meant_link(const std::string& interface);

} // namespace blactl::cli
