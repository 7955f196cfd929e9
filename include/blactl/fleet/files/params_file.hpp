#pragma once
// The parameter file of the common GUI tools: the settings of one unnamed servo, as raw values by
// address.
//
//   # saved by the DroneCAN GUI Tool        # saved by Mission Planner
//   0x38 900                                0x38,900
//   0x39 -900                               0x39,-900
//
// The DroneCAN GUI Tool separates name and value by white space, Mission Planner also by a comma;
// only Mission Planner supports comments ("#"), which the GUI Tool skips as unknown names. Both use
// the servo's own names of registers (table 2-14), and save all registers, including measured
// values and commands.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <string>
#include <string_view>

namespace blactl::fleet {

/// One entry without name and match, FleetFile::is_params; another one for several servos, if it
/// has IDs. Registers that are not settings are skipped, as a tool has saved them with the others.
/// Errors: bad_file with file, line and reason of each error: lines that are not a name and a
/// value, names that are not an address (also decimal ones, and blactl's own), values that are not
/// an integer or that no model accepts, a register named twice, a file without a setting.
[[nodiscard]] Result<FleetFile> parse_params_file(std::string_view text, std::string file,
                                                  const bla::Profiles& profiles);

/// A file that both tools load, and parse_params_file() reads as exactly these settings: every
/// setting of a servo that was read, IDs included, by address.
[[nodiscard]] std::string params_file(const Snapshot& servo, const FleetFileStyle& style);

} // namespace blactl::fleet
