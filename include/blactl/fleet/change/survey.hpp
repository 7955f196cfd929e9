#pragma once
// Other holders, present or future, of the IDs that plans assign: two units on one ID are written
// together.

#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

class History;

/// Another servo, or an actuator of another make, and its IDs in RAM; empty: it did not tell them.
struct Neighbour {
  dronecan::NodeId id{};
  std::optional<dronecan::UniqueId> unique_id{};
  std::optional<std::int64_t> servo_id{}; ///< by which ArrayCommand reaches it
  std::optional<std::int64_t> static_node_id{};
  std::optional<std::int64_t> rom_servo_id{}; ///< that its next restart brings, as far as known
  std::optional<std::int64_t> rom_static_node_id{}; ///< likewise
  bool is_foreign = false;                          ///< of another make
  bool is_rom_unread = false; ///< it runs on initial values, its IDs in ROM may be others
};

/// A unit that waits for a node ID: it could not read its ROM, if that holds one.
struct Waiting {
  dronecan::UniqueId unique_id{};
  std::int64_t rom_static_node_id{}; ///< by the last proof
};

/// Nodes that send no actuator.Status, and that nobody has identified. Asking what they are costs a
/// second and more where one does not answer; where servo IDs matter, it may be a servo.
enum class Unidentified : std::uint8_t { asked, left_out };

/// All of them that were heard, asked for their IDs. Errors: those that end a session.
[[nodiscard]] Result<std::vector<Neighbour>>
neighbours(Session& session, const bla::Profiles& profiles, const Identification::Options& options,
           Unidentified unidentified, std::optional<dronecan::NodeId> except = std::nullopt);

/// The IDs of the units on the bus.
struct Survey {
  /// Of the node IDs that plans assign; empty: it did not tell its own.
  std::map<dronecan::NodeId, std::optional<dronecan::UniqueId>> holders;
  std::vector<Neighbour> servos;        ///< all servos heard
  std::vector<dronecan::NodeId> silent; ///< of those, the ones that did not respond
  std::vector<Waiting> waiting;         ///< those whose ROM holds a static node ID, as far as known
};

/// Asks for the holders of the node IDs that the plans assign, and all servos for their IDs in RAM.
/// Plans that assign none cost nothing. `record` knows what their ROM holds; null: nobody does.
/// Errors: those that end a session.
[[nodiscard]] Result<Survey> survey(Session& session, const bla::Profiles& profiles,
                                    std::span<const Plan> plans,
                                    const Identification::Options& options, History* record);

/// The reason why `plan` must not be carried out together with the others. Errors:
/// duplicate_node_id, duplicate_servo_id.
[[nodiscard]] std::optional<Error> conflict(const Survey& survey, std::span<const Plan> plans,
                                            const Plan& plan);

/// The same check for the servo ID only.
[[nodiscard]] std::optional<Error> servo_id_conflict(const Survey& survey,
                                                     std::span<const Plan> plans, const Plan& plan);

/// Whether another servo, whose ROM stays as it is, has the given node ID in it as far as known; it
/// may wait for a node ID.
[[nodiscard]] std::optional<Error>
rom_node_id_conflict(const Survey& survey, std::span<const Plan> plans, const Plan& plan);

/// Likewise, of a servo that was first heard after the survey, by the servo ID that it sends.
[[nodiscard]] std::optional<Error> newcomer_conflict(const Roster& roster, Time surveyed,
                                                     const Plan& plan);

} // namespace blactl::fleet
