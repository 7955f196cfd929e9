#pragma once
// The files with settings that a command is given.

#include "blactl/fleet/files/fleet_file.hpp"

#include "cli/context.hpp"
#include "cli/output/report.hpp"

#include <optional>
#include <string>

namespace blactl::cli {

/// Reads a fleet file or a parameter file, and says what of it is passed over; empty: the report
/// says why. The profiles have been read. Errors: bad_file.
[[nodiscard]] std::optional<fleet::FleetFile> read_settings(const std::string& file,
                                                            const Context& context, Report& report);

} // namespace blactl::cli
