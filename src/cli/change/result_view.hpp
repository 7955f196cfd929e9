#pragma once
// How the changes of servos ended, as JSON and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/base/time.hpp"
#include "blactl/fleet/change/result.hpp"

#include "cli/output/page.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::cli {

/// How a command shows the results.
enum class ResultView : std::uint8_t {
  changes, ///< the single registers of each servo (`set`)
  servos,  ///< each servo as a whole (`save`)
  entries, ///< each entry of a fleet file (`apply`)
  moves    ///< nothing: every move of a node ID was a line of a stream (`alloc --static`)
};

/// The counts of a report, beside those of its servos.
[[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>>
counts(ResultView view, std::span<const fleet::GoalResult> results, bool is_plan);

/// "0.525"
[[nodiscard]] std::string seconds_text(Duration duration);

/// `changes` alone.
void write_changes(JsonWriter& json, std::span<const fleet::RegisterChange> changes);

/// `warnings`, where there are any.
void write_warnings(JsonWriter& json, std::span<const fleet::Warning> warnings);

/// How a table of changes is to be read.
struct TableStyle {
  std::optional<std::int64_t> mode_before{}, mode_after{}; ///< 0x37: the unit of 0x36
  bool was_begun = false;                                  ///< else it is a plan that is shown
};

[[nodiscard]] std::string changes_table(std::span<const fleet::RegisterChange> changes,
                                        const TableStyle& style, const Page& page);

/// `changes`, `saved` and `warnings` of one servo.
void write_changes(JsonWriter& json, const fleet::ChangeResult& result);

/// The table of its changes, and its warnings.
[[nodiscard]] std::string changes_text(const fleet::ChangeResult& result, const Page& page);

/// What is said below the changes of all: the servos that were saved, or that nothing was.
[[nodiscard]] std::string saving_text(std::span<const fleet::ChangeResult> results,
                                      const Page& page);

void write_json(JsonWriter& json, ResultView view, std::span<const fleet::ChangeResult> results);
[[nodiscard]] std::string text(ResultView view, std::span<const fleet::ChangeResult> results,
                               const Page& page);

} // namespace blactl::cli
