#pragma once
// Faults of servos as JSON and text.

#include "blactl/base/json_writer.hpp"
#include "blactl/fleet/live/fault_job.hpp"

#include "cli/output/page.hpp"

#include <span>
#include <string>

namespace blactl::cli {

/// "WARNING", in the user's language.
[[nodiscard]] std::string level_word(bla::Level level);

/// "nodes", with the faults from `level` up.
void write_json(JsonWriter& json, std::span<const fleet::FaultState> servos, bla::Level level);

/// Text for people, the worst servo first.
[[nodiscard]] std::string text(std::span<const fleet::FaultState> servos, bla::Level level,
                               const Page& page);

/// The members of one fault: register, bit, level, group, code, latched, text, condition, action,
/// values.
void write_fault(JsonWriter& json, const fleet::FaultState& servo, const bla::Fault& fault);

/// One line: "WARNING  Temperature upper limit  0x1A.8 temperature_high".
[[nodiscard]] std::string fault_line(const bla::Fault& fault, const Page& page);

} // namespace blactl::cli
