#pragma once
// blactl doctor --report: one file for the support. People read its comments; the frames behind
// them are a candump log that -i replay: takes.

#include "cli/context.hpp"
#include "cli/doctor/examination.hpp"
#include "cli/output/report.hpp"

#include <string>

namespace blactl::cli {

/// To be called before the interface is opened: from then on all frames go to the file. Errors:
/// usage (--record, or stdout), io.
[[nodiscard]] Result<void> prepare_report(const std::string& file, Context& context);

/// Reads what every servo holds, and puts it all above the frames.
void write_report(const std::string& file, const Examination& examination, Context& context,
                  Report& report);

} // namespace blactl::cli
