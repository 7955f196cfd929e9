#pragma once
// What the fuzz targets share: the entry that libFuzzer calls, and the end of a run that found a
// fault.

#include "blactl/bla/profile.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

// NOLINTNEXTLINE(readability-identifier-naming): the name is libFuzzer's.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace blactl::fuzz {

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// libFuzzer takes an abort for a crash, and keeps the input.
inline void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

inline const bla::Profiles& built_in() {
  static const auto profiles = bla::Profiles::load(std::nullopt);
  return profiles.value();
}

} // namespace blactl::fuzz
