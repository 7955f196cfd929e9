#pragma once
// blactl doctor --report: one file for the support. People read its comments; the frames after them
// are a candump log for -i replay:.

#include "cli/context.hpp"
#include "cli/doctor/examination.hpp"
#include "cli/output/report.hpp"

#include <string>

namespace blactl::cli {

/// Call before the interface is opened: from then on all frames go to the file. Errors: usage
/// (--record, or stdout), io.
[[nodiscard]] Result<void> prepare_report(const std::string& file, Context& context);

/// Reads the parameters of every servo, and puts everything above the frames.
void write_report(const std::string& file, const Examination& examination, Context& context,
                  Report& report);

} // namespace blactl::cli
