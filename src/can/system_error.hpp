#pragma once
// What the kernel means by an error number.

#include <string>
#include <system_error>

namespace blactl::can {

inline std::string reason(int error) {
  return std::generic_category().message(error);
}

} // namespace blactl::can
