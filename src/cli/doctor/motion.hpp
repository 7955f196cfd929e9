#pragma once
// Of blactl doctor: the servos that do not move, or not as they should.

#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/characterize/findings.hpp"

#include "cli/context.hpp"
#include "cli/doctor/examination.hpp"

#include <vector>

namespace blactl::cli {

/// Reads what tells why they do not move: of the servos that -n names, else of those that another
/// node commands.
[[nodiscard]] fleet::Snapshots read_motion(Context& context, const fleet::Findings& findings,
                                           bool are_named);

/// What is found of them, and which of them could not be read, other than what a recording lacks.
[[nodiscard]] fleet::Diagnoses diagnose_motions(const fleet::Snapshots& servos, bool are_named,
                                                Context& context, const fleet::Traffic& traffic);

/// What could not be judged of the servos that -n names: what a recording lacks, or is too short
/// for.
[[nodiscard]] std::vector<Unjudged>
unjudged_motions(const fleet::Snapshots& servos, Context& context, const fleet::Traffic& traffic);

} // namespace blactl::cli
