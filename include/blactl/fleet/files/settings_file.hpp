#pragma once
// A file with settings, in any of its forms: a fleet file, a recipe, or a parameter file.

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/files/fleet_file.hpp"

#include <filesystem>

namespace blactl::fleet {

/// JSON begins with a brace, or has the extension .json: with the schema of a recipe, of whichever
/// version, it is a recipe, else a fleet file. Anything else is a parameter file. "-" reads stdin.
/// Errors: as parse_fleet_file(), parse_recipe(), parse_params_file().
[[nodiscard]] Result<FleetFile> read_settings_file(const std::filesystem::path& file,
                                                   const bla::Profiles& profiles);

} // namespace blactl::fleet
