#include "blactl/bla/config_sha256.hpp"

#include "blactl/base/sha256.hpp"

#include <fmt/format.h>

namespace blactl::bla {

std::string config_sha256(const Values& configuration) {
  std::string lines;
  for (const auto& [address, raw] : configuration) {
    lines += fmt::format("{}={}\n", address.name(), raw);
  }
  return sha256(lines);
}

} // namespace blactl::bla
