#pragma once
// Defects of firmware releases that a technician should know of (chapter 5).

#include "blactl/bla/identity.hpp"

namespace blactl::bla {

/// BLA15 and BLA21 before firmware 1.400 may stall at low speed. False where model or firmware are
/// not known.
[[nodiscard]] bool may_stall(const Identity& servo);

} // namespace blactl::bla
