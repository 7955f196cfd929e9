#pragma once
// The profiles of the binary, and its models by name.

#include "blactl/bla/profile.hpp"

#include "catch.hpp"

#include <string_view>

namespace blactl::test {

inline const bla::Profiles& built_in() {
  static const bla::Profiles profiles = [] {
    auto loaded = bla::Profiles::load(std::nullopt);
    if (!loaded) {
      FAIL(loaded.error().message);
    }
    return *loaded;
  }();
  return profiles;
}

inline const bla::Profile& model(std::string_view name) {
  const auto models = built_in().matching(name);
  REQUIRE(models.size() == 1);
  return *models.front();
}

/// The register of some model, by its name.
inline const bla::Parameter& parameter(std::string_view name) {
  const auto found = built_in().find(name);
  REQUIRE(found);
  return **found;
}

} // namespace blactl::test
