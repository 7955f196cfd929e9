#pragma once
// What a change does to the shaft and the load: one judgement for every command that writes
// (contract, section 4).

#include "blactl/bla/values.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace blactl::bla {

/// The registers whose present values may_move() needs to judge a change of `address`.
[[nodiscard]] std::vector<Address> values_needed(Address address);

/// Whether writing `requested` to `address` can move the shaft or let go of the load, while the
/// servo holds `now` (values_needed() of it). What is not known may be the worst.
[[nodiscard]] bool may_move(Address address, std::int64_t requested, const Values& now);

/// The switch that must be on for the servo to take a value of `address` (4.2, 4.3); empty: none.
[[nodiscard]] std::optional<Address> needs_on(Address address);

/// Whether the manufacturer advises to leave it as it is (4.26-4.29).
[[nodiscard]] bool should_stay_at_default(Address address);

/// What a restart does to the shaft (4.11, 4.14).
enum class RestartMotion : std::uint8_t {
  none, ///< torque is off before and after
  soft, ///< the output drops, then the shaft runs slowly to 0 deg
  hard, ///< the output drops, then torque returns where the shaft is
};

/// `configuration`: what the servo starts with. What is not known may be the worst.
[[nodiscard]] RestartMotion restart_motion(const Values& configuration);

} // namespace blactl::bla
