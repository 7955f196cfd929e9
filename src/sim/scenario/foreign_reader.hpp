#pragma once
// One foreign node of a scenario file.

#include "blactl/base/json_reader.hpp"
#include "blactl/sim/scenario/foreign_setup.hpp"

namespace blactl::sim {

/// Adds errors to the faults of the document.
[[nodiscard]] ForeignSetup read_foreign(const json::Value& value, json::Faults& faults);

} // namespace blactl::sim
