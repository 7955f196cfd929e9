#pragma once
// The examination by blactl doctor: the interface, the bus, its nodes, this user's rights.

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

/// What the examination could not tell, for lack of data.
struct Unjudged {
  std::optional<dronecan::NodeId> node{};
  std::string text{};
};

/// The results. It must not outlive the context or its session.
struct Examination {
  std::string interface{};                    ///< as named
  std::optional<can::Link> link{};            ///< for a network interface
  std::optional<can::SlcanAnswers> adapter{}; ///< for an adapter on a serial port
  fleet::Traffic traffic{};
  std::optional<fleet::Findings> nodes{}; ///< empty: the bus was not opened
  bool are_named = false;                 ///< `nodes` has those of -n only
  fleet::Diagnoses fixed{};               ///< fixed by --fix
  fleet::Diagnoses diagnoses{};           ///< present problems, the worst first
  std::vector<Unjudged> unjudged{};
  bool is_whole = false; ///< the examination was complete
};

/// Examines everything for `time`. Errors that prevented it are in the report; those of the bus
/// itself (bus-off, no acknowledgement) are diagnoses.
void examine(Duration time, Context& context, Examination& examination, Report& report);

} // namespace blactl::cli
