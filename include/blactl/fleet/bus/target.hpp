#pragma once
// Which servos a command means: -n LIST (contract, section 2).

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
  std::int64_t number = 0; ///< of serial_number and servo_id

  /// Only an identified servo matches, and only what it said of itself.
  [[nodiscard]] bool matches(const Member& member, const bla::Profiles& profiles) const;

  /// The same of what is known of a servo from elsewhere.
  [[nodiscard]] bool matches(const Servo& servo, const bla::Profiles& profiles) const;
};

struct Targets {
  bool given = false;                ///< -n was there
  bool all = false;                  ///< every BLA servo on the bus
  std::vector<dronecan::NodeId> ids; ///< ascending, each once
  std::vector<Selector> selectors;

  /// Whether the list names this member: its ID, or as a servo that was identified.
  [[nodiscard]] bool mean(const Member& member, const bla::Profiles& profiles) const;

  /// That the beginning of a unique ID means several units: usage, with the list of them.
  [[nodiscard]] std::optional<Error> ambiguity(const Roster& roster,
                                               const bla::Profiles& profiles) const;

  /// Whether the bus must be searched: IDs alone need no search.
  [[nodiscard]] bool need_search() const { return !given || all || !selectors.empty(); }
};

/// Reads `12`, `10-14,20`, `all`, `unique_id:…`, `serial:…`, `servo:…`, `model:…`, comma-separated;
/// letters of either case. Errors: usage.
[[nodiscard]] Result<Targets> parse_targets(std::string_view list);

} // namespace blactl::fleet
