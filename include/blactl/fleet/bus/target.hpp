#pragma once
// The servos selected by -n LIST (contract, section 2).

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/roster.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// `uid:` `serial:` `servo:` `model:` with a value; the beginning of a unique ID is enough.
struct Selector {
  enum class Key : std::uint8_t { unique_id, serial_number, servo_id, model };
  Key key;
  std::string text;        ///< as typed: "serial:240900558"
  std::string value;       ///< lower case for unique IDs
  std::int64_t number = 0; ///< for serial_number and servo_id

  /// Matches identified servos only, and by their own responses only.
  [[nodiscard]] bool matches(const Member& member, const bla::Profiles& profiles) const;

  /// Whether it may match this sender of actuator.Status, which has not identified itself since it
  /// started.
  [[nodiscard]] bool may_match(const Member& member, const bla::Profiles& profiles, Time now) const;

  /// Whether it matches one unit only.
  [[nodiscard]] bool is_unique() const;

  /// Matches a servo known from elsewhere.
  [[nodiscard]] bool matches(const Servo& servo, const bla::Profiles& profiles) const;
};

/// What was heard of the unique IDs of units that wait for a node ID, where this
/// selector, not a whole unique ID, may mean them.
[[nodiscard]] std::vector<UniqueIdPrefix> waiting_like(const Selector& selector,
                                                       const Roster& roster);

struct Targets {
  bool given = false;                ///< -n was given
  bool all = false;                  ///< every BLA servo on the bus
  std::vector<dronecan::NodeId> ids; ///< ascending, each once
  std::vector<Selector> selectors;

  /// Whether the list selects this member: by its ID, or as an identified servo.
  [[nodiscard]] bool mean(const Member& member, const bla::Profiles& profiles) const;

  /// The error for a beginning of a unique ID or a serial number, which mean one unit, that matches
  /// several, or one and perhaps a unit that waits for a node ID: usage, with the list of them.
  [[nodiscard]] std::optional<Error> ambiguity(const Roster& roster,
                                               const bla::Profiles& profiles) const;

  /// Whether every servo is meant.
  [[nodiscard]] bool mean_all() const { return all || !given; }

  /// Whether the bus must be searched: plain IDs need no search.
  [[nodiscard]] bool need_search() const { return mean_all() || !selectors.empty(); }
};

/// Parses `12`, `10-14,20`, `all`, `unique_id:…`, `serial:…`, `servo:…`, `model:…`,
/// comma-separated, in upper or lower case. Errors: usage.
[[nodiscard]] Result<Targets> parse_targets(std::string_view list);

} // namespace blactl::fleet
