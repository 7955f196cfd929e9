#pragma once
// The meaning of the system's error numbers, for people.

#include <string>

namespace blactl {

/// "No space left on device" for ENOSPC, in the language of the session. A rare error is given by
/// its number and the system's own text.
[[nodiscard]] std::string system_reason(int error);

} // namespace blactl
