#pragma once
// Changes a fleet file that people have written: all but what must change stays byte for byte.

#include "blactl/base/error.hpp"
#include "blactl/fleet/bus/snapshot.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <string>
#include <string_view>

namespace blactl::fleet {

/// The text of a fleet file in which the entry `name` is of another unit: its unique ID and serial
/// number in "match", and all of "about", each where it is there. `file`: its name, for messages.
/// `unit`: read as by registers_to_export(). Errors: bad_file (no fleet file, or no such entry);
/// timeout (the unit has not told something that the entry has).
[[nodiscard]] Result<std::string> with_unit(std::string_view text, const std::string& file,
                                            std::string_view name, const Snapshot& unit,
                                            const FleetFileStyle& style);

} // namespace blactl::fleet
