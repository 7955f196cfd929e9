#pragma once
// What blactl alloc shows: a line for each thing that happens, or the list of the units as it is.

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/fleet/change/id_moves.hpp"

#include "cli/output/page.hpp"
#include "cli/trace/time.hpp"

#include <string>

namespace blactl::cli {

/// The object of the contract, section 5, with its line end; empty: that is no event of it.
[[nodiscard]] std::string json_line(UnixTime time, fleet::AllocationService::Event event,
                                    const fleet::AllocatedUnit& unit);

/// The same for people.
[[nodiscard]] std::string text_line(UnixTime time, fleet::AllocationService::Event event,
                                    const fleet::AllocatedUnit& unit);

/// The same of a move to a static node ID; one that is only temporary is no event of the contract.
[[nodiscard]] std::string json_line(UnixTime time, const fleet::IdMove& move);
[[nodiscard]] std::string text_line(UnixTime time, const fleet::IdMove& move);

/// A servo that has its node ID for good already.
struct StaticUnit {
  dronecan::UniqueId unique_id{};
  dronecan::NodeId node_id;
};

[[nodiscard]] std::string json_line(UnixTime time, const StaticUnit& unit);
[[nodiscard]] std::string text_line(UnixTime time, const StaticUnit& unit);

/// Who has which ID, by node ID, and how many still ask.
[[nodiscard]] std::string text(const fleet::AllocationService& service, const fleet::Roster& roster,
                               const Page& page);

} // namespace blactl::cli
