#pragma once
// A refusal as one of the errors of a file.

#include "blactl/base/error.hpp"

#include <string>

namespace blactl::fleet {

/// "angle_limit_cw=90: 90 or 9.0 degrees? (for example angle_limit_cw=90.0deg)"
[[nodiscard]] inline std::string fault_text(const Error& error) {
  return error.hint.empty() ? error.message : error.message + " (" + error.hint + ')';
}

} // namespace blactl::fleet
