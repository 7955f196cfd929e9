#pragma once
// A client's receive filter, applied as the kernel would.

#include "blactl/can/bus.hpp"

#include <algorithm>
#include <span>

namespace blactl::sim {

/// Whether a client with these filters receives the frame; without filters it receives all.
[[nodiscard]] inline bool passes(std::span<const can::Filter> filters, const can::Frame& frame) {
  return filters.empty() || std::ranges::any_of(filters, [&](const can::Filter& filter) {
           return frame.extended && !frame.remote && ((frame.id ^ filter.id) & filter.mask) == 0;
         });
}

} // namespace blactl::sim
