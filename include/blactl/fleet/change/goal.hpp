#pragma once
// The target state of one servo, and the required proof of it.

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

/// The evidence that RAM and ROM already hold a goal, so that nothing is sent.
enum class Evidence : std::uint8_t {
  none,    ///< none is accepted: the goal is carried out as it stands
  record,  ///< RAM holds it, and ROM by the record; else it is carried out
  restart, ///< the same; without a record a restart shows the contents of ROM, without a SAVE
  ram,     ///< RAM holds it, and no record contradicts it for ROM
};

struct Goal {
  dronecan::NodeId id; ///< its node ID
  /// The required unit; empty: any.
  std::optional<dronecan::UniqueId> unique_id{};
  std::optional<std::int64_t> serial_number{}; ///< likewise
  std::string name{};                          ///< for people; may be empty
  Wanted wanted{};
  Evidence evidence = Evidence::none;

  [[nodiscard]] bool saves() const { return wanted.restart == RestartKind::save; }
};

/// The same goal for each of these servos. Errors: as refuse_together().
[[nodiscard]] Result<std::vector<Goal>> goals_for_all(const Wanted& wanted, Evidence evidence,
                                                      std::span<const dronecan::NodeId> servos);

/// The action needed for a goal.
enum class Need : std::uint8_t {
  nothing, ///< RAM holds it, and so does ROM as far as required
  prove,   ///< RAM holds it; only a restart shows whether ROM does
  save,    ///< RAM holds it, ROM is known to differ
  write,   ///< RAM differs, or the goal is carried out as it stands
};
[[nodiscard]] std::string_view name(Need need);

/// Whether RAM holds every value of the goal.
[[nodiscard]] bool holds(const bla::Values& values, const Goal& goal);

/// The need of a goal for a servo with the values `held`. `rom`: the proven contents of its ROM;
/// empty: no record.
[[nodiscard]] Need need_of(const Goal& goal, const Snapshot& held,
                           const std::optional<bla::Values>& rom);

} // namespace blactl::fleet
