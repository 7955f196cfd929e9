#pragma once
// Known defects of firmware releases (chapter 5).

#include "blactl/bla/identity.hpp"

namespace blactl::bla {

/// BLA15 and BLA21 before firmware 1.400 may stall at low speed. False if the model or firmware is
/// unknown.
[[nodiscard]] bool may_stall(const Identity& servo);

} // namespace blactl::bla
