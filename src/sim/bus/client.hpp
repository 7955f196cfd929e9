#pragma once
// The kernel's part for a client of the simulated bus: its receive filter, and its backlog.

#include "blactl/can/bus.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace blactl::sim {

/// Whether a client with these filters receives the frame; without filters it receives all.
[[nodiscard]] inline bool passes(std::span<const can::Filter> filters, const can::Frame& frame) {
  return filters.empty() || std::ranges::any_of(filters, [&](const can::Filter& filter) {
           return frame.extended && !frame.remote && ((frame.id ^ filter.id) & filter.mask) == 0;
         });
}

/// Frames kept for a client while it does not run, in addition to those in its socket: as many as
/// can::SocketCan asks the kernel for, 2.5 s of a full bus. Further frames are lost, and reported
/// as such. The socket alone holds some 280, 37 ms: on a busy machine a process may wait longer
/// than that.
constexpr std::size_t backlog_capacity = 20'000;

} // namespace blactl::sim
