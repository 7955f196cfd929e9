#pragma once
// How the changes of servos ended, as JSON and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/result.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>

namespace blactl::cli {

/// What a command tells of each servo: its single registers (`set`), or the servo as a whole.
enum class ResultView : unsigned char { changes, servos };

void write_json(JsonWriter& json, ResultView view, std::span<const fleet::ChangeResult> results);
[[nodiscard]] std::string text(ResultView view, std::span<const fleet::ChangeResult> results,
                               const Page& page);

} // namespace blactl::cli
