#pragma once
// The state to which one servo is to be brought, and the proof of it that is asked for.

#include "blactl/base/error.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/change/plan.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::fleet {

/// The evidence that RAM and ROM hold a goal already, for which nothing is sent.
enum class Evidence : std::uint8_t {
  none,    ///< nothing spares it: the goal is carried out as it stands
  record,  ///< RAM holds it, and ROM is on record to hold it; else it is carried out
  restart, ///< the same; where nothing is on record a restart shows what ROM holds, without a SAVE
  ram,     ///< RAM holds it, and nothing is on record that speaks against ROM
};

/// What is to be done to one servo.
struct Goal {
  dronecan::NodeId id; ///< where it is
  /// The unit that must be there; empty: whichever unit is.
  std::optional<dronecan::UniqueId> unique_id{};
  std::string name{}; ///< for people; may be empty
  Wanted wanted{};
  Evidence evidence = Evidence::none;

  [[nodiscard]] bool saves() const { return wanted.restart == RestartKind::save; }
};

/// The same for each of these servos. Errors: as refuse_together().
[[nodiscard]] Result<std::vector<Goal>> goals_for_all(const Wanted& wanted, Evidence evidence,
                                                      std::span<const dronecan::NodeId> servos);

/// What has to be done for a goal.
enum class Need : std::uint8_t {
  nothing, ///< RAM holds it, and so does ROM as far as that is asked
  prove,   ///< RAM holds it; whether ROM does only a restart tells
  save,    ///< RAM holds it, ROM is known to hold something else
  write,   ///< RAM holds something else, or the goal is carried out as it stands
};
[[nodiscard]] std::string_view name(Need need);

/// RAM holds every value that the goal names.
[[nodiscard]] bool holds(const bla::Values& values, const Goal& goal);

/// The need of a goal for a servo that holds `held`. `rom`: what its ROM is proven to hold; empty:
/// nothing is on record.
[[nodiscard]] Need need_of(const Goal& goal, const Snapshot& held,
                           const std::optional<bla::Values>& rom);

} // namespace blactl::fleet
