#pragma once
// A digest of settings, by which two readings are compared.

#include "blactl/bla/values.hpp"

#include <string>

namespace blactl::bla {

/// The digest of a configuration: SHA-256 over a line "0x2A=120\n" for each of its registers, by
/// address, with raw numbers.
[[nodiscard]] std::string config_sha256(const Values& configuration);

} // namespace blactl::bla
