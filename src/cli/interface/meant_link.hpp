#pragma once
// The network interface of this machine behind -i.

#include "blactl/can/link.hpp"

#include <optional>
#include <string>

namespace blactl::cli {

/// Whether -i may name a network interface: by its kind, or because it is missing.
[[nodiscard]] bool may_be_link(const std::string& interface);

/// The network interface behind -i, or the only candidate; empty: none.
[[nodiscard]] std::optional<can::Link> meant_link(const std::string& interface);

} // namespace blactl::cli
