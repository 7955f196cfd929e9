#pragma once
// Reads "behaviour" of a scenario's servo or a facts file.

#include "blactl/base/json_reader.hpp"
#include "blactl/sim/scenario/scenario.hpp"

namespace blactl::sim {

/// Sets the members named by the object; the others stay unchanged.
void read_behaviour(json::Object object, Behaviour& into, json::Faults& faults);

} // namespace blactl::sim
