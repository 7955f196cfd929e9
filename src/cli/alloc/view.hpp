#pragma once
// Output of blactl alloc: a line for each event, or the list of units.

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/fleet/change/id_moves.hpp"

#include "cli/output/page.hpp"
#include "cli/trace/time.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace blactl::cli {

/// The object of the contract, section 5, with its line end; empty: the event is not in the
/// contract.
[[nodiscard]] std::string json_line(UnixTime time, fleet::AllocationService::Event event,
                                    const fleet::AllocatedUnit& unit);

/// The line for people.
[[nodiscard]] std::string text_line(WallTime time, fleet::AllocationService::Event event,
                                    const fleet::AllocatedUnit& unit);

/// The object for a move to a static node ID; a temporary move is not an event of the contract.
[[nodiscard]] std::string json_line(UnixTime time, const fleet::IdMove& move);
[[nodiscard]] std::string text_line(WallTime time, const fleet::IdMove& move,
                                    std::optional<std::int64_t> serial_number);

/// A servo whose node ID is already static.
struct StaticUnit {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId node_id;
};

[[nodiscard]] std::string json_line(UnixTime time, const StaticUnit& unit);
[[nodiscard]] std::string text_line(WallTime time, const StaticUnit& unit,
                                    std::optional<std::int64_t> serial_number);

/// The units by node ID, and the number of units that still ask.
[[nodiscard]] std::string text(const fleet::AllocationService& service, const fleet::Roster& roster,
                               const Page& page);

} // namespace blactl::cli
