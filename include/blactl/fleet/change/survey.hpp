#pragma once
// Who else has, or will have, the IDs that plans give: two units on one ID are written together.

#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// What the units on the bus say of their IDs.
struct Survey {
  struct Neighbour {
    dronecan::NodeId id{};
    std::optional<dronecan::UniqueId> unique_id{};
    std::optional<std::int64_t> servo_id{}, static_node_id{}; ///< in RAM
  };

  std::map<dronecan::NodeId, dronecan::UniqueId> holders; ///< of the node IDs that plans give
  std::vector<Neighbour> servos;                          ///< all that are heard
  std::vector<dronecan::NodeId> silent;                   ///< of those, who did not tell its IDs
};

/// Asks who has the node IDs that the plans give, and all servos for their IDs in RAM. Plans that
/// give none cost nothing. Errors: those that end a session.
[[nodiscard]] Result<Survey> survey(Session& session, const bla::Profiles& profiles,
                                    std::span<const Plan> plans,
                                    const Identification::Options& options);

/// Why `plan` must not be carried out together with the others. Errors: duplicate_node_id,
/// duplicate_servo_id.
[[nodiscard]] std::optional<Error> conflict(const Survey& survey, std::span<const Plan> plans,
                                            const Plan& plan);

/// The same of the servo ID alone.
[[nodiscard]] std::optional<Error> servo_id_conflict(const Survey& survey,
                                                     std::span<const Plan> plans, const Plan& plan);

} // namespace blactl::fleet
