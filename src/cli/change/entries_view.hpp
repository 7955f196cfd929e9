#pragma once
// The plans and results of apply and undo, as JSON and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/change/change.hpp"
#include "blactl/fleet/files/fleet_diff.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// The word of the contract; for a plan the state before it: different or unchanged.
[[nodiscard]] fleet::EntryStatus entry_status(const fleet::GoalResult& result, bool is_plan);

/// All errors, including that a servo was not started because of others.
[[nodiscard]] std::vector<Error> errors_of(const fleet::GoalResult& result, bool is_plan);

/// "nodes", with the keys of the contract, section 5, `diff apply`; `action` of a plan: "nothing",
/// "restart" (to check ROM), "save", "write"; `saves`: whether it writes to ROM, too.
void write_json(JsonWriter& json, std::span<const fleet::GoalResult> results,
                std::span<const fleet::EntryDiff> others, bool is_plan);

/// A plan lists the changes; a result has one line per servo, and the changes of failed ones. If
/// there are more servos than lines on the screen, successful ones are only counted.
[[nodiscard]] std::string text(std::span<const fleet::GoalResult> results,
                               std::span<const fleet::EntryDiff> others, bool is_plan,
                               const Page& page);

} // namespace blactl::cli
