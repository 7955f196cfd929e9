#pragma once
// The configuration of a servo: the registers that SAVE keeps (0x20-0x46, section 4.11).

#include "blactl/bla/parameter.hpp"
#include "blactl/fleet/read_job.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// Register numbers by address.
using Values = std::map<bla::Address, std::int64_t>;

/// The registers of its configuration that this servo has, by address.
[[nodiscard]] std::vector<const bla::Parameter*> configuration(const bla::Profiles& profiles,
                                                               const Member& servo);

/// What they hold after ERASE. Errors: no_profile, where the model is not known well enough.
[[nodiscard]] Result<Values> factory_defaults(const bla::Profiles& profiles, const Member& servo);

/// The register that tells after a restart whether ROM could be read (4.12); null: there is none.
[[nodiscard]] const bla::Parameter* rom_state(const Member& servo);

/// Errors: mismatch, if that register was read and tells that the servo has found its ROM
/// unreadable and holds initial values.
[[nodiscard]] std::optional<Error> check_rom(const ReadJob& job);

/// What was read.
[[nodiscard]] Values values(const ReadJob& job);

/// Compares what was read with what must be there. Errors: mismatch with the registers that
/// differ; the error of the first register that could not be read.
[[nodiscard]] std::optional<Error> compare(const ReadJob& job, const Values& expected);

} // namespace blactl::fleet
