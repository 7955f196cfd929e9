#pragma once
// The parameter file of the common GUI tools: the settings of one servo, whichever that is, as
// register numbers by address.
//
//   # what the DroneCAN GUI Tool saves      # what Mission Planner saves
//   0x38 900                                0x38,900
//   0x39 -900                               0x39,-900
//
// The DroneCAN GUI Tool parts name and value by white space, Mission Planner also by a comma; only
// Mission Planner knows comments ("#"), and the GUI Tool passes them over as a name that no servo
// has. Both name a register of a BLA servo as the servo does (table 2-14), and save all of them,
// with what it measures and what is commanded.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace blactl::fleet {

/// One entry without name and match, FleetFile::is_params. Registers of a servo that are no
/// settings are passed over: a tool has saved them with the others.
/// Errors: bad_file with file, line and reason of every fault: lines that are no name and value,
/// names that are no address (also decimal ones, and blactl's own), values that are no whole number
/// or that no model takes, a register named twice, a file without a setting.
[[nodiscard]] Result<FleetFile> parse_params_file(std::string_view text, std::string file,
                                                  const bla::Profiles& profiles);

/// A fleet file, or a parameter file: a fleet file begins with a brace, or is called so (.json).
/// "-" reads stdin. Errors: as parse_fleet_file(), parse_params_file().
[[nodiscard]] Result<FleetFile> read_settings_file(const std::filesystem::path& file,
                                                   const bla::Profiles& profiles);

/// What both tools load, and parse_params_file() reads as just these settings: every setting of a
/// servo that was read, IDs included, by address.
[[nodiscard]] std::string params_file(const Snapshot& servo, const FleetFileStyle& style);

} // namespace blactl::fleet
