#pragma once
// What may not be written now, and what is asked first (contract, section 4).

#include "blactl/fleet/read_job.hpp"
#include "blactl/fleet/session.hpp"
#include "blactl/fleet/write_job.hpp"

#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// The registers whose present values may_move() needs to judge a change of `address`.
[[nodiscard]] std::vector<bla::Address> values_needed(bla::Address address);

/// Whether this change is asked first. `values` holds values_needed().
[[nodiscard]] bool may_move(const Change& change, const ReadJob& values);

/// Whether the bus must have been heard for 1.1 s before these changes: that long takes
/// ArmingStatus, and a second unit with the same node ID. So before every write.
[[nodiscard]] bool needs_watch(std::span<const Change> changes);

/// That nothing is written to a node ID which two units have: duplicate_node_id.
[[nodiscard]] Error doubled(dronecan::NodeId id);

/// Why nothing at all may be sent to this servo now that changes it, as far as the bus was heard.
/// Errors: duplicate_node_id, state (it restarted since it was identified), armed, and driven
/// unless `while_driven`, if what shall be sent `moves` it.
[[nodiscard]] std::optional<Error> forbidden(Session& session, const Member& servo, bool moves,
                                             bool while_driven);

/// Why these changes must not be written to this servo now, as far as the bus was heard.
/// Errors: as above; out_of_range (a static node ID that another node has).
[[nodiscard]] std::optional<Error> forbidden(Session& session, std::span<const Change> changes,
                                             const ReadJob& values, bool while_driven);

} // namespace blactl::fleet
