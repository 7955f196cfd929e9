#pragma once
// The results of changes, as JSON and text.

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

/// The form of the results.
enum class ResultView : std::uint8_t {
  changes, ///< the single registers of each servo (`set`)
  servos,  ///< each servo as a whole (`save`)
  entries, ///< each entry of a fleet file (`apply`)
  moves    ///< nothing: the moves of node IDs were lines of a stream (`alloc --static`)
};

/// The counts of a report, besides those of its servos.
[[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>>
counts(ResultView view, std::span<const fleet::GoalResult> results, bool is_plan);

/// "0.525"
[[nodiscard]] std::string seconds_text(Duration duration);

/// Writes `changes`.
void write_changes(JsonWriter& json, std::span<const fleet::RegisterChange> changes);

/// Writes `warnings`, if there are any.
void write_warnings(JsonWriter& json, std::span<const fleet::Warning> warnings);

/// The style of a table of changes.
struct TableStyle {
  std::optional<std::int64_t> mode_before{}, mode_after{}; ///< 0x37: the unit of 0x36
  bool was_begun = false;                                  ///< false: the table shows a plan
};

[[nodiscard]] std::string changes_table(std::span<const fleet::RegisterChange> changes,
                                        const TableStyle& style, const Page& page);

/// Writes `changes`, `saved` and `warnings` of one servo.
void write_changes(JsonWriter& json, const fleet::ChangeResult& result);

/// The table of a servo's changes, and its warnings.
[[nodiscard]] std::string changes_text(const fleet::ChangeResult& result, const Page& page);

/// The text below all changes: the servos that were saved, or that none was.
[[nodiscard]] std::string saving_text(std::span<const fleet::ChangeResult> results,
                                      const Page& page);

void write_json(JsonWriter& json, ResultView view, std::span<const fleet::ChangeResult> results);
[[nodiscard]] std::string text(ResultView view, std::span<const fleet::ChangeResult> results,
                               const Page& page);

} // namespace blactl::cli
