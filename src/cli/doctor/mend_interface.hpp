#pragma once
// blactl doctor --fix: the network interface is set up and raised, where something of it is wrong.

#include "cli/context.hpp"
#include "cli/doctor/examination.hpp"
#include "cli/output/report.hpp"

namespace blactl::cli {

/// Asks first, and looks again afterwards: what of the findings is gone is in the examination. To
/// be called before the interface is opened. Errors go to the report: permission, busy,
/// not_confirmed, interrupted, interface.
void mend_interface(Context& context, Examination& examination, Report& report);

} // namespace blactl::cli
