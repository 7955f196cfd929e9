#pragma once
// "behaviour" of a scenario's servo and of a facts file.

#include "blactl/base/json_reader.hpp"
#include "blactl/sim/scenario/scenario.hpp"

namespace blactl::sim {

/// Changes what the object says; what it leaves out stays as it is.
void read_behaviour(json::Object object, Behaviour& into, json::Faults& faults);

} // namespace blactl::sim
