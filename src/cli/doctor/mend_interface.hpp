#pragma once
// blactl doctor --fix: sets up a network interface and brings it up, if something about it is
// wrong.

#include "cli/context.hpp"
#include "cli/doctor/examination.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

/// Asks first, and checks again afterwards: fixed findings are in the examination. Call before the
/// interface is opened. Errors go to the report: permission, busy, not_confirmed, interrupted,
/// interface.
void mend_interface(Context& context, Examination& examination, Report& report);

} // namespace blactl::cli
