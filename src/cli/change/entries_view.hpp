#pragma once
// What apply and undo are going to do, or have done, as JSON and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/change/change.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// The word of the contract; of a plan what it is before: different or unchanged.
[[nodiscard]] fleet::EntryStatus entry_status(const fleet::GoalResult& result, bool is_plan);

/// All that went wrong, and that a servo was not begun because of others.
[[nodiscard]] std::vector<Error> errors_of(const fleet::GoalResult& result, bool is_plan);

/// "nodes", with the keys of the contract, section 5, `diff apply`; what a plan is going to do is
/// `action`: "nothing", "restart" (to see what ROM holds), "save", "write"; whether that is for ROM
/// too is `saves`.
void write_json(JsonWriter& json, std::span<const fleet::GoalResult> results,
                std::span<const fleet::EntryDiff> others, bool is_plan);

/// A plan shows what changes; what was done is a line a servo, and its changes where they failed.
/// Of more servos than a screen has lines those that are well are only counted.
[[nodiscard]] std::string text(std::span<const fleet::GoalResult> results,
                               std::span<const fleet::EntryDiff> others, bool is_plan,
                               const Page& page);

} // namespace blactl::cli
