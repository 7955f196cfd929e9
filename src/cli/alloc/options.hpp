#pragma once
// The options of `blactl alloc`.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/fleet/change/wanted_ids.hpp"

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

struct AllocOptions {
  bool once = false;
  std::optional<std::uint64_t> count{};
  Duration wait = std::chrono::seconds(10);
  std::string range{};
  std::vector<std::string> assign{};
  bool makes_static = false;
  std::optional<std::uint64_t> id{}; ///< with makes_static, for the one servo selected
  bool list = false;
  std::vector<std::string> forget{};
  std::string export_to{};
  std::string import_from{};
};

/// Parses "10-99". Errors: usage.
[[nodiscard]] Result<fleet::AllocationService::Range> parse_range(const std::string& text);

/// Parses "SELECTOR=ID" items. Errors: usage, out_of_range; all errors of the list.
[[nodiscard]] std::expected<std::vector<fleet::WantedId>, std::vector<Error>>
parse_wishes(const std::vector<std::string>& texts);

/// Parses what means one unit: a node ID, a selector, or a unique ID, or the beginning of one,
/// without its "uid:". Errors: usage.
[[nodiscard]] Result<fleet::Targets> parse_unit(std::string_view text);

} // namespace blactl::cli
