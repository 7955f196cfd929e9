#pragma once
// What the system means by an error number, for people.

#include <string>

namespace blactl {

/// "No space left on device" of ENOSPC, in the language of the session. A number that is rarely met
/// is told itself, with what the system calls it.
[[nodiscard]] std::string system_reason(int error);

} // namespace blactl
