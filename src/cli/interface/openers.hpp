#pragma once
// How each kind of interface is opened.

#include "blactl/base/error.hpp"

namespace blactl::cli {

struct OpenBus;
struct OpenRequest;

// Errors: interface, permission, bad_file (scenario, fleet file), usage.
[[nodiscard]] Result<OpenBus> open_socketcan(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_slcan(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_mcast(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_simulator(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_scenario(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_log(const OpenRequest& request);
[[nodiscard]] Result<OpenBus> open_fleet_file(const OpenRequest& request);

} // namespace blactl::cli
