#pragma once
// Whether what a command has told agrees with what happened in the servos. Nothing is exempt that a
// client can know.

#include "step.hpp"
#include "told.hpp"

namespace blactl::campaign {

/// Throws Lie.
void judge(const Step& step);

} // namespace blactl::campaign
