#pragma once
// A saved plan: the document of `apply --dry-run --json`. It is carried out only if nothing has
// changed since it was made (contract, section 5, `diff apply`).

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/fleet/change/change.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

struct SavedStep {
  Need need = Need::nothing;
  bool saves = true;
  bla::Values before{}; ///< of every register of the entry
  std::string model{};
  std::int64_t firmware_version = 0; ///< 0x52
  std::string settings_sha256{};     ///< as settings_sha256(); empty: not in the plan
};

struct SavedPlan {
  FleetFile fleet;              ///< the servos, by unique ID, and their wanted settings
  std::vector<SavedStep> steps; ///< of the entries of `fleet`, in their order
  bool trusts_ram = false;      ///< made with --trust-ram

  /// The step of the entry; `entry` is one of `fleet`.
  [[nodiscard]] const SavedStep& step(const FleetEntry& entry) const {
    return steps[static_cast<std::size_t>(&entry - fleet.servos.data())];
  }
};

/// A digest of all settings that were read of this servo for the plan, named or not.
[[nodiscard]] std::string settings_sha256(const GoalResult& result);

/// "-" reads stdin. Errors: bad_file with all its errors: another document, one that reports
/// errors, a servo without a unique ID or listed twice, values that no model accepts.
[[nodiscard]] Result<SavedPlan> read_saved_plan(const std::filesystem::path& file,
                                                const bla::Profiles& profiles);

/// The changes since: stale_plan for every servo affected. `results` are those of Change::prepare()
/// for entries of the plan.
[[nodiscard]] std::vector<Error> stale(const SavedPlan& plan, std::span<const GoalResult> results);

} // namespace blactl::fleet
