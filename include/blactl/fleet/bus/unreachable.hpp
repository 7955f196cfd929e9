#pragma once
// Reasons why a node ID cannot be addressed: absent, silent, or doubled.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/target.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// Whether servos ask for a node ID, and none that has one was heard.
[[nodiscard]] bool all_wait_for_id(const Roster& roster);

/// What to type when a node is not there: who is there, or how waiting servos get a node ID.
[[nodiscard]] std::string not_found_hint(const Roster& roster);

/// The error for a node that has identified itself as another device: not_found.
[[nodiscard]] Error not_a_servo(dronecan::NodeId id, std::string_view name);

/// No servo on the bus matches: not_found.
[[nodiscard]] Error nothing_matches(const Roster& roster, const Selector& selector);

/// Senders of actuator.Status that are there, and have not said since their start who they are.
[[nodiscard]] std::vector<dronecan::NodeId> unidentified(const Roster& roster);

/// Those of them that a selector may mean beside the servos that it matches.
[[nodiscard]] std::vector<dronecan::NodeId>
may_be_meant(const Roster& roster, const Selector& selector, const bla::Profiles& profiles);

/// One that `what`, a selector or an entry of a file, may mean: timeout; not_recorded, if the bus
/// is a recording; duplicate_node_id.
[[nodiscard]] Error not_identified(const Roster& roster, dronecan::NodeId id, std::string_view what,
                                   bool is_recording);

/// Whether a selector matches a servo that is alone on its node ID.
[[nodiscard]] bool is_met(const Roster& roster, const Selector& selector,
                          const bla::Profiles& profiles);

/// The selectors that match nobody (not_found, duplicate_node_id), and those that may match more:
/// as not_identified().
[[nodiscard]] std::vector<Error> unmet(const Roster& roster, std::span<const Selector> selectors,
                                       const bla::Profiles& profiles, bool is_recording);

/// It is in a recording, but not what it is: not_recorded.
[[nodiscard]] Error identity_unrecorded(dronecan::NodeId id);

/// There is no BLA servo, with the nodes that are there: not_found.
[[nodiscard]] Error no_servo(const Roster& roster);

/// A recording has nothing of this node: not_recorded.
[[nodiscard]] Error unrecorded(dronecan::NodeId id);

/// Two units use this node ID, named by their unique IDs if both are known: duplicate_node_id.
/// Reads may be answered by either, writes reach both.
[[nodiscard]] Error doubled(const Roster& roster, dronecan::NodeId id);

/// Of something that was looked for in vain: it may be one of two units on an ID, which cannot be
/// read. Then that is the error, as doubled().
[[nodiscard]] Error unless_shared(const Roster& roster, Error error);

/// Why the unique ID of this unit does not tell it from others: another has it as well, or it is
/// blank: duplicate_unique_id. Empty: it does, as far as known.
[[nodiscard]] std::optional<Error> not_unique(const Roster& roster, dronecan::NodeId id);

/// No response from this node ID: duplicate_node_id if two units use it, timeout if it was heard,
/// else not_found.
[[nodiscard]] Error silent(const Roster& roster, dronecan::NodeId id);

/// Of a servo with the unique ID of the unit with this serial number: has_other_serial().
[[nodiscard]] Error other_serial(const Servo& servo, std::int64_t serial);

} // namespace blactl::fleet
