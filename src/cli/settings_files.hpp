#pragma once
// Reads the files with settings that a command is given.

#include "blactl/fleet/files/fleet_file.hpp"
#include "blactl/fleet/files/fleet_match.hpp"

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// Reads a fleet file, a recipe or a parameter file, and notes skipped parts; empty: the report has
/// the reason. The profiles must have been read. Errors: bad_file.
[[nodiscard]] std::optional<fleet::FleetFile> read_settings(const std::string& file,
                                                            const Context& context, Report& report);

/// Why a recipe cannot be carried out or compared: it has counters, whose numbers only provision
/// knows. Empty: it can, or it is another file. Errors: usage.
[[nodiscard]] std::optional<Error> refuse_counters(const fleet::FleetFile& file);

/// A recipe needs -n. Errors: usage.
[[nodiscard]] std::optional<Error> refuse_without_targets(const fleet::FleetFile& file,
                                                          const fleet::Targets& targets);

/// The notes on what of a file is not for the servos that it was matched with.
[[nodiscard]] std::vector<std::string> notes(const fleet::FleetFile& file,
                                             const fleet::FleetMatch& match);

} // namespace blactl::cli
