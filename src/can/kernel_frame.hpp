#pragma once
// Frames, filters, error frames and time stamps as raw CAN sockets have them (linux/can.h).

#include "blactl/can/bus.hpp"

#include <linux/can.h>

#include <optional>
#include <span>
#include <vector>

namespace blactl::can {

[[nodiscard]] can_frame to_kernel(const Frame& frame);

/// A data or remote frame; not for error frames (CAN_ERR_FLAG).
[[nodiscard]] Frame from_kernel(const can_frame& raw);

/// The filters for a raw socket: these and the echoes, or one for everything if there are no
/// filters or more than a socket takes (CAN_RAW_FILTER_MAX). Never empty, which would let nothing
/// pass. Source: linux/can/raw.h, CAN_RAW_FILTER.
[[nodiscard]] std::vector<can_filter> kernel_filters(std::span<const Filter> filters,
                                                     const std::optional<Filter>& echoes);

/// Widens `filter` to match `id` too, and as little else as one filter can; false if it already
/// did.
bool widen(std::optional<Filter>& filter, std::uint32_t id);

/// The error classes that faults() recognises, for CAN_RAW_ERR_FILTER.
inline constexpr can_err_mask_t fault_classes = 0x0000'01ED;

/// The faults in an error frame, the gravest first; of the error states only the worst. Empty:
/// nothing of interest (lost arbitration, counters). Source: linux/can/error.h.
[[nodiscard]] std::vector<FaultKind> faults(const can_frame& error);

/// Converts a wall clock stamp to the bus clock, both clocks now being `now` and `wall`. Frames
/// stay in order even if the wall clock is set: not before `previous`, not after `now`.
[[nodiscard]] Time bus_time(WallTime stamp, Time now, WallTime wall, Time previous);

} // namespace blactl::can
