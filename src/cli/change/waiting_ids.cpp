#include "cli/change/waiting_ids.hpp"

#include "cli/change/texts.hpp"
#include "cli/stores.hpp"

#include <optional>

namespace blactl::cli {

std::string would_get_id(const dronecan::UniqueId& unit, const fleet::Roster& roster,
                         std::string_view interface) {
  using Entry = std::optional<state::AllocationEntry>;
  const auto table = open_allocations(interface, state::Access::read);
  const auto known = table ? table->find(unit) : Result<Entry>();
  return known && *known && !roster.heard((*known)->node_id)
             ? say<texts::would_get_known_id>((*known)->node_id.value())
             : say<texts::would_get_free_id>();
}

} // namespace blactl::cli
