#pragma once
// What a person or a script tells running simulated servos, a line at a time.

#include "blactl/base/error.hpp"
#include "blactl/sim/scenario/timeline.hpp"
#include "blactl/sim/scenario/world_change.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

namespace blactl::cli {

/// `240900001 voltage=5V hand=45deg`: around the servos of this serial number.
struct ChangeWorld {
  std::int64_t serial_number;
  std::vector<sim::WorldChange> changes;
};

/// `clients cut`, `clients joined`, `clients bus_off`.
struct LinkClients {
  sim::ClientLink link;
};

/// `hold N`: virtual time stands until so many clients are there.
struct HoldClock {
  std::size_t clients;
};

/// `dump`: what the memories hold.
struct DumpState {};

using SimOrder = std::variant<ChangeWorld, LinkClients, HoldClock, DumpState>;

/// One line without its end. Errors: usage, out_of_range, with what can be said as hint.
[[nodiscard]] Result<SimOrder> parse_sim_order(std::string_view line);

} // namespace blactl::cli
