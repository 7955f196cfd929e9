#pragma once
// Checks on a production line: whether a servo matches its recipe and label, its target settings,
// and whether it may leave the line (contract, section 6, "provision").

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

/// The reason why this servo must not be touched; empty: it matches. `label`: null if none is read.
/// Errors: model_mismatch (also if the model is uncertain), firmware_too_old, label_mismatch;
/// timeout: its version or number could not be read.
[[nodiscard]] std::optional<Error> check_unit(const Servo& servo, const Recipe& recipe,
                                              const Label* label, const bla::Profiles& profiles);

/// The IDs to assign to a unit: from the label, else from the counters, by address.
[[nodiscard]] std::vector<state::IdWish> ids_wished(const Recipe& recipe, const Label* label);

/// The target settings of a unit with these IDs, one for each wish: by address. Errors:
/// out_of_range: an ID that no servo accepts.
[[nodiscard]] Result<std::vector<bla::Assignment>>
settings_for(const Recipe& recipe, std::span<const state::IdWish> wishes,
             std::span<const std::int64_t> ids, const bla::Profiles& profiles);

/// "0x1A.4;0x19.8": all bits set, the worst level first; empty: none.
[[nodiscard]] std::string fault_bits(const bla::Values& values, const bla::Profiles& profiles);

/// The reason why a servo must not leave the line with these faults; empty: none is worse than a
/// notice. Errors: faults.
[[nodiscard]] std::optional<Error> check_faults(const bla::Values& values,
                                                const bla::Profiles& profiles, dronecan::NodeId id);

} // namespace blactl::fleet
