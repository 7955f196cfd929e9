#pragma once
// Whether a servo on a production line is the one that its recipe and its label speak of, what it
// shall hold, and whether it may leave the line (contract, section 6, "provision").

#include "blactl/base/error.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"
#include "blactl/fleet/bus/servo.hpp"
#include "blactl/fleet/files/label.hpp"
#include "blactl/fleet/files/recipe.hpp"
#include "blactl/state/counter_store.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

/// Why this servo is not to be touched; empty: it is what is expected. `label`: null where none is
/// read. Errors: model_mismatch (also a model that is not known for sure), firmware_too_old,
/// label_mismatch; timeout: it did not tell its version or number.
[[nodiscard]] std::optional<Error> check_unit(const Servo& servo, const Recipe& recipe,
                                              const Label* label, const bla::Profiles& profiles);

/// The IDs that a unit is to be given: those of the label, else of the counters, by address.
[[nodiscard]] std::vector<state::IdWish> ids_wished(const Recipe& recipe, const Label* label);

/// What a unit shall hold that was given these IDs, one for each wish: by address. Errors:
/// out_of_range: an ID that no servo takes.
[[nodiscard]] Result<std::vector<bla::Assignment>>
settings_for(const Recipe& recipe, std::span<const state::IdWish> wishes,
             std::span<const std::int64_t> ids, const bla::Profiles& profiles);

/// The digest of a configuration: SHA-256 over a line "0x2A=120\n" for each register of it, by
/// address, numbers as the register has them.
[[nodiscard]] std::string config_sha256(const bla::Values& configuration);

/// "0x1A.4;0x19.8": all bits that are set, the worst level first; empty: none is.
[[nodiscard]] std::string fault_bits(const bla::Values& values, const bla::Profiles& profiles);

/// Why a servo must not leave the line with these faults; empty: none is worse than a notice.
/// Errors: faults.
[[nodiscard]] std::optional<Error> check_faults(const bla::Values& values,
                                                const bla::Profiles& profiles, dronecan::NodeId id);

} // namespace blactl::fleet
