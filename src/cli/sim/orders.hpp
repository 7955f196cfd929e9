#pragma once
// Orders from a person or a script to running simulated servos, one per line.

#include "blactl/base/error.hpp"
#include "blactl/sim/scenario/timeline.hpp"
#include "blactl/sim/scenario/world_change.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

namespace blactl::cli {

/// `240900001 voltage=5V hand=45deg`: changes the surroundings of the servos with this serial
/// number.
struct ChangeWorld {
  std::int64_t serial_number;
  std::vector<sim::WorldChange> changes;
};

/// `clients cut`, `clients joined`, `clients bus_off`.
struct LinkClients {
  sim::ClientLink link;
};

/// `hold N`: stops virtual time until this number of clients is attached.
struct HoldClock {
  std::size_t clients;
};

/// `dump`: prints the memories.
struct DumpState {};

using SimOrder = std::variant<ChangeWorld, LinkClients, HoldClock, DumpState>;

/// Parses one line without its end. Errors: usage, out_of_range, with the possible orders as a
/// hint.
[[nodiscard]] Result<SimOrder> parse_sim_order(std::string_view line);

} // namespace blactl::cli
