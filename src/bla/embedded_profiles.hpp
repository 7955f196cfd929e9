#pragma once
// The files of profiles/ at build time (generated source).

#include <span>
#include <string_view>

namespace blactl::bla {

struct EmbeddedProfile {
  std::string_view file; ///< "BLA21.json"
  std::string_view text;
};

[[nodiscard]] std::span<const EmbeddedProfile> embedded_profiles();

} // namespace blactl::bla
