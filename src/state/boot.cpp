#include "state/boot.hpp"

#include "blactl/base/read_file.hpp"

#include <cstddef>
#include <string>

namespace blactl::state {

std::string_view boot_id() {
  constexpr std::size_t most = 64;
  static const std::string id = read_file("/proc/sys/kernel/random/boot_id", most).value_or("");
  return id;
}

} // namespace blactl::state
