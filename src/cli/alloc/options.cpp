#include "cli/alloc/options.hpp"

#include "cli/alloc/texts.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

namespace blactl::cli {

using dronecan::NodeId;

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

Result<fleet::WantedId> parse_wish(std::string_view text) {
  const auto equals = text.rfind('=');
  if (equals == std::string_view::npos) {
    return fail(Code::usage, say<texts::alloc_no_wish>(printable(text)),
                say<texts::alloc_wish_hint>());
  }
  auto whom = parse_unit(text.substr(0, equals));
  if (!whom) {
    return std::unexpected(std::move(whom.error()));
  }
  const auto node_id = parse_dynamic_id(text.substr(equals + 1));
  if (!node_id) {
    return fail(Code::out_of_range, say<texts::alloc_no_id>(printable(text.substr(equals + 1))),
                say<texts::alloc_no_id_hint>());
  }
  return fleet::WantedId{std::move(*whom), *node_id, std::string(text.substr(0, equals))};
}

/// Whether it is hexadecimal, and not a node ID, which has three digits at most.
bool begins_unique_id(std::string_view text) {
  constexpr std::size_t longest_node_id = 3;
  const bool is_number = text.find_first_not_of("0123456789") == std::string_view::npos;
  return (!is_number || text.size() > longest_node_id) &&
         text.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos;
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

std::expected<std::vector<fleet::WantedId>, std::vector<Error>>
parse_wishes(const std::vector<std::string>& texts) {
  using fleet::WantedId;
  std::vector<WantedId> wishes;
  std::vector<Error> faults;
  for (const std::string& text : texts) {
    auto wish = parse_wish(text);
    if (!wish) {
      faults.push_back(wish.error());
    } else if (std::ranges::find(wishes, wish->text, &WantedId::text) != wishes.end() ||
               std::ranges::find(wishes, wish->node_id, &WantedId::node_id) != wishes.end()) {
      faults.push_back({Code::usage, say<texts::alloc_wish_twice>(printable(text)),
                        say<texts::alloc_wish_hint>(), std::nullopt});
    } else {
      wishes.push_back(std::move(*wish));
    }
  }
  return faults.empty()
             ? std::expected<std::vector<WantedId>, std::vector<Error>>(std::move(wishes))
             : std::unexpected(std::move(faults));
}

Result<fleet::Targets> parse_unit(std::string_view text) {
  auto whom =
      fleet::parse_targets(begins_unique_id(text) ? "uid:" + std::string(text) : std::string(text));
  const bool is_one = whom && !whom->all && whom->ids.size() + whom->selectors.size() == 1;
  return is_one ? std::move(whom)
                : fail(Code::usage, say<texts::alloc_no_unit>(printable(text)),
                       say<texts::alloc_no_unit_hint>());
}

} // namespace blactl::cli
