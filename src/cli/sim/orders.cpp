#include "cli/sim/orders.hpp"

#include "blactl/base/text.hpp"

#include "cli/sim/texts.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <utility>

namespace blactl::cli {
namespace {

constexpr std::size_t most_clients = 64;

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view blanks = " \t\r";
  std::vector<std::string_view> words;
  for (;;) {
    const auto begin = line.find_first_not_of(blanks);
    if (begin == std::string_view::npos) {
      return words;
    }
    line.remove_prefix(begin);
    const auto end = std::min(line.find_first_of(blanks), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

template <class Number> std::optional<Number> number(std::string_view word) {
  Number value{};
  const char* end = std::to_address(word.end());
  const auto [stop, error] = std::from_chars(std::to_address(word.begin()), end, value);
  return error == std::errc{} && stop == end ? std::optional(value) : std::nullopt;
}

std::unexpected<Error> not_understood(std::string_view line) {
  return fail(Code::usage, say<texts::sim_order_unknown>(printable(line)),
              say<texts::sim_order_hint>());
}

Result<SimOrder> change_world(std::int64_t serial, std::span<const std::string_view> pairs) {
  ChangeWorld order{serial, {}};
  for (const std::string_view pair : pairs) {
    const auto equals = std::min(pair.find('='), pair.size());
    auto change = sim::parse_world_change(pair.substr(0, equals), equals < pair.size()
                                                                      ? pair.substr(equals + 1)
                                                                      : pair.substr(equals));
    if (!change) {
      return std::unexpected(change.error());
    }
    order.changes.push_back(*std::move(change));
  }
  return order;
}

} // namespace

Result<SimOrder> parse_sim_order(std::string_view line) {
  const auto words = words_of(line);
  if (words.size() == 1 && words[0] == "dump") {
    return DumpState{};
  }
  if (words.size() < 2) {
    return not_understood(line);
  }
  if (const auto serial = number<std::int64_t>(words[0])) {
    return change_world(*serial, std::span(words).subspan(1));
  }
  if (words.size() == 2 && words[0] == "hold") {
    if (const auto clients = number<std::size_t>(words[1]); clients && *clients <= most_clients) {
      return HoldClock{*clients};
    }
  }
  if (words.size() == 2 && words[0] == "clients") {
    if (const auto link = sim::parse_client_link(words[1])) {
      return LinkClients{*link};
    }
  }
  return not_understood(line);
}

} // namespace blactl::cli
