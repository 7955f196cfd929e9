#include "cli/alloc/options.hpp"

#include "blactl/base/hex.hpp"

#include "cli/alloc/texts.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace blactl::cli {

using dronecan::NodeId;
using dronecan::UniqueId;

namespace {

/// Digits only, 1 to 125.
std::optional<NodeId> parse_dynamic_id(std::string_view text) {
  std::uint8_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_whole = error == std::errc() && end == text.data() + text.size() && !text.empty();
  const bool fits =
      value >= state::first_dynamic_id.value() && value <= state::last_dynamic_id.value();
  return is_whole && fits ? std::optional(NodeId(value)) : std::nullopt;
}

Result<state::AllocationStore::Wish> parse_wish(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) {
    return fail(Code::usage, say<texts::alloc_no_wish>(printable(text)),
                say<texts::alloc_wish_hint>());
  }
  const auto unique_id = parse_unique_id(text.substr(0, equals));
  if (!unique_id) {
    return std::unexpected(unique_id.error());
  }
  const auto node_id = parse_dynamic_id(text.substr(equals + 1));
  if (!node_id) {
    return fail(Code::out_of_range, say<texts::alloc_no_id>(printable(text.substr(equals + 1))),
                say<texts::alloc_no_id_hint>());
  }
  return state::AllocationStore::Wish{*unique_id, *node_id};
}

} // namespace

Result<fleet::AllocationService::Range> parse_range(const std::string& text) {
  if (text.empty()) {
    return fleet::AllocationService::Range{};
  }
  const auto dash = text.find('-');
  if (dash != std::string::npos) {
    const auto first = parse_dynamic_id(std::string_view(text).substr(0, dash));
    const auto last = parse_dynamic_id(std::string_view(text).substr(dash + 1));
    if (first && last && *first <= *last) {
      return fleet::AllocationService::Range{*first, *last};
    }
  }
  return fail(Code::usage, say<texts::alloc_no_range>(printable(text)),
              say<texts::alloc_range_hint>());
}

std::expected<std::vector<state::AllocationStore::Wish>, std::vector<Error>>
parse_wishes(const std::vector<std::string>& texts) {
  using Wish = state::AllocationStore::Wish;
  std::vector<Wish> wishes;
  std::vector<Error> faults;
  for (const std::string& text : texts) {
    const auto wish = parse_wish(text);
    if (!wish) {
      faults.push_back(wish.error());
    } else if (std::ranges::find(wishes, wish->unique_id, &Wish::unique_id) != wishes.end() ||
               std::ranges::find(wishes, wish->node_id, &Wish::node_id) != wishes.end()) {
      faults.push_back({Code::usage, say<texts::alloc_wish_twice>(printable(text)),
                        say<texts::alloc_wish_hint>(), std::nullopt});
    } else {
      wishes.push_back(*wish);
    }
  }
  return faults.empty() ? std::expected<std::vector<Wish>, std::vector<Error>>(std::move(wishes))
                        : std::unexpected(std::move(faults));
}

Result<UniqueId> parse_unique_id(std::string_view text) {
  std::string_view digits = text;
  for (const std::string_view prefix : {"unique_id:", "uid:"}) {
    if (digits.starts_with(prefix)) {
      digits.remove_prefix(prefix.size());
    }
  }
  if (const auto unique_id = from_hex<std::tuple_size_v<UniqueId>>(digits)) {
    return *unique_id;
  }
  return fail(Code::usage, say<texts::alloc_no_unique_id>(printable(text)),
              say<texts::alloc_no_unique_id_hint>());
}

} // namespace blactl::cli
