#pragma once
// What blactl doctor looks at: the interface, the bus, its nodes, this user's rights.

#include "blactl/can/link.hpp"
#include "blactl/fleet/bus/traffic.hpp"
#include "blactl/fleet/characterize/findings.hpp"
#include "blactl/fleet/doctor/diagnosis.hpp"

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// All that was found. It outlives neither the context nor its session.
struct Examination {
  std::string interface{};                    ///< as it was named
  std::optional<can::Link> link{};            ///< of a network interface
  std::optional<can::SlcanAnswers> adapter{}; ///< of an adapter at a serial port
  fleet::Traffic traffic{};
  std::optional<fleet::Findings> nodes{}; ///< empty: the bus was not opened
  fleet::Diagnoses fixed{};               ///< what --fix has mended
  fleet::Diagnoses diagnoses{};           ///< what is wrong now, the worst first
  bool is_whole = false;                  ///< nothing kept it from looking
};

/// Looks at everything for `time`. What kept it from looking is in the report; what the bus itself
/// forbade (bus-off, nobody acknowledges) is a diagnosis.
void examine(Duration time, Context& context, Examination& examination, Report& report);

} // namespace blactl::cli
