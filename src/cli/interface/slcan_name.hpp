#pragma once
// The name after `-i slcan:` (contract, section 2): DEV[?baud=…&open=…&ack=…&gap=…].

#include "blactl/base/error.hpp"
#include "blactl/can/slcan.hpp"

#include <filesystem>
#include <string_view>

namespace blactl::cli {

struct SlcanName {
  std::filesystem::path device;
  can::SlcanOptions options;
};

/// A device without a folder is one of /dev. Errors: usage.
[[nodiscard]] Result<SlcanName> parse_slcan(std::string_view text);

} // namespace blactl::cli
