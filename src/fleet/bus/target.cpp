#include "blactl/fleet/bus/target.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/letter_case.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/target_texts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <map>
#include <optional>
#include <ranges>
#include <utility>

namespace blactl::fleet {
namespace {

template <class Number> std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool digits = !text.empty() && text.front() >= '0' && text.front() <= '9';
  return digits && error == std::errc() && end == text.data() + text.size() ? std::optional(value)
                                                                            : std::nullopt;
}

std::optional<dronecan::NodeId> node_id(std::string_view text) {
  const auto value = number<unsigned>(text);
  return value && *value >= 1 && *value <= dronecan::NodeId::max
             ? std::optional(dronecan::NodeId(static_cast<std::uint8_t>(*value)))
             : std::nullopt;
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// One ID or a range of them, by its ends.
struct IdRange {
  std::string_view first, last;
};

/// Empty: the item is not a number or a range of numbers.
std::optional<IdRange> id_range(std::string_view item) {
  const auto dash = item.find('-');
  const auto first = item.substr(0, dash);
  const IdRange range{first, dash == std::string_view::npos ? first : item.substr(dash + 1)};
  return is_number(range.first) && is_number(range.last) ? std::optional(range) : std::nullopt;
}

Error bad_target(std::string_view list) {
  return {Code::usage, say<texts::bad_target>(printable(list)), say<texts::bad_target_hint>(),
          std::nullopt};
}

Result<void> add_ids(const IdRange& range, std::string_view item, Targets& targets) {
  const auto first = node_id(range.first);
  const auto last = node_id(range.last);
  if (!first || !last) {
    return fail(Code::usage, say<texts::bad_target_id>(item), say<texts::bad_target_id_hint>());
  }
  if (*first > *last) {
    return fail(Code::usage, say<texts::bad_target_range>(item),
                say<texts::bad_target_range_hint>(last->value(), first->value()));
  }
  for (unsigned id = first->value(); id <= last->value(); ++id) {
    targets.ids.emplace_back(static_cast<std::uint8_t>(id));
  }
  return {};
}

/// Whether it is a unique ID in digits, or the beginning of one.
bool begins_unique_id(std::string_view text) {
  return !text.empty() && text.size() <= 2 * sizeof(dronecan::UniqueId) &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool add_selector(std::string_view item, Targets& targets) {
  using Key = Selector::Key;
  constexpr std::array<std::pair<std::string_view, Key>, 7> keys{{
      {"unique_id", Key::unique_id},
      {"uid", Key::unique_id},
      {"serial_number", Key::serial_number},
      {"serial", Key::serial_number},
      {"servo_id", Key::servo_id},
      {"servo", Key::servo_id},
      {"model", Key::model},
  }};
  const auto colon = item.find(':');
  const std::string word = lower(item.substr(0, colon));
  const auto key = std::ranges::find(keys, word, &std::pair<std::string_view, Key>::first);
  if (colon == std::string_view::npos || key == keys.end()) {
    return false;
  }
  Selector selector{key->second, std::string(item), lower(item.substr(colon + 1))};
  const auto value = number<std::int64_t>(selector.value);
  selector.number = value.value_or(0);
  targets.selectors.push_back(selector);
  switch (selector.key) {
  case Key::unique_id: return begins_unique_id(selector.value);
  case Key::model: return !selector.value.empty();
  default: return value.has_value();
  }
}

/// The units that a selector matches, each with its node ID.
std::map<dronecan::UniqueId, dronecan::NodeId>
units_meant(const Selector& selector, const Roster& roster, const bla::Profiles& profiles) {
  std::map<dronecan::UniqueId, dronecan::NodeId> meant;
  for (const auto& [id, member] : roster.members()) {
    if (const auto unique_id = member.unique_id();
        unique_id && selector.matches(member, profiles)) {
      meant.try_emplace(*unique_id, id);
    }
  }
  return meant;
}

} // namespace

std::vector<UniqueIdPrefix> waiting_like(const Selector& selector, const Roster& roster) {
  std::vector<UniqueIdPrefix> waiting;
  constexpr std::size_t whole = 2 * std::tuple_size_v<dronecan::UniqueId>;
  if (selector.key != Selector::Key::unique_id || selector.value.size() == whole) {
    return waiting;
  }
  for (const UniqueIdPrefix& heard : roster.pending()) {
    const std::string digits = hex(heard);
    if (digits.starts_with(selector.value) || selector.value.starts_with(digits)) {
      waiting.push_back(heard);
    }
  }
  return waiting;
}

bool Selector::matches(const Member& member, const bla::Profiles& profiles) const {
  return member.is_known() && matches(member.servo(), profiles);
}

/// Of what it told before, or in part, only a servo ID may be another after a start: that in its
/// messages counts as long as it sends them.
bool Selector::may_match(const Member& member, const bla::Profiles& profiles, Time now) const {
  constexpr Duration longest_pause = std::chrono::milliseconds(300);
  if (key == Key::servo_id) {
    return member.actuator_id == number || now - member.actuator_at > longest_pause;
  }
  if (member.identified) {
    return matches(member.servo(), profiles);
  }
  const auto unique_id = key == Key::unique_id ? member.unique_id() : std::nullopt;
  return !unique_id || hex(*unique_id).starts_with(value);
}

bool Selector::is_unique() const {
  return key == Key::serial_number ||
         (key == Key::unique_id && value.size() == 2 * sizeof(dronecan::UniqueId));
}

bool Selector::matches(const Servo& servo, const bla::Profiles& profiles) const {
  if (!servo.is_servo) {
    return false;
  }
  switch (key) {
  case Key::unique_id: return servo.unique_id && hex(*servo.unique_id).starts_with(value);
  case Key::serial_number: return servo.identity.readings().serial_number == number;
  case Key::servo_id: return servo.servo_id == number;
  case Key::model: {
    // only a certain model matches: a selector never picks by a guess
    const auto matching = profiles.matching(value);
    return std::ranges::find(matching, servo.identity.profile()) != matching.end();
  }
  }
  return false;
}

bool Targets::mean(const Member& member, const bla::Profiles& profiles) const {
  if (mean_all()) {
    return member.is_known() && member.is_servo;
  }
  const bool is_named = std::ranges::find(ids, member.id) != ids.end();
  return (is_named && member.id_is_known) ||
         std::ranges::any_of(selectors, [&](const Selector& selector) {
           return selector.matches(member, profiles);
         });
}

std::optional<Error> Targets::ambiguity(const Roster& roster, const bla::Profiles& profiles) const {
  for (const Selector& selector : selectors) {
    const bool is_serial = selector.key == Selector::Key::serial_number;
    if (!is_serial && selector.key != Selector::Key::unique_id) {
      continue;
    }
    const auto meant = units_meant(selector, roster, profiles);
    const auto waiting = waiting_like(selector, roster);
    if (meant.empty() || meant.size() + waiting.size() < 2) {
      continue;
    }
    std::string listed;
    for (const auto& [unique_id, id] : meant) {
      listed += fmt::format("{}{} ({})", listed.empty() ? "" : ", ", hex(unique_id), id.value());
    }
    for (const UniqueIdPrefix& heard : waiting) {
      listed += ", " + say<texts::waiting_unit>(hex(heard));
    }
    return is_serial
               ? Error{Code::usage, say<texts::doubled_serial_target>(selector.text, listed),
                       say<texts::several_servos_hint>(meant.begin()->second.value()), std::nullopt}
               : Error{Code::usage, say<texts::ambiguous_target>(selector.text, listed),
                       say<texts::ambiguous_target_hint>(), std::nullopt};
  }
  return std::nullopt;
}

Result<Targets> parse_targets(std::string_view list) {
  Targets targets;
  targets.given = true;
  for (const auto part : std::views::split(list, ',')) {
    const std::string_view item(part.begin(), part.end());
    if (lower(item) == "all") {
      targets.all = true;
    } else if (const auto range = id_range(item)) {
      if (auto added = add_ids(*range, item, targets); !added) {
        return std::unexpected(std::move(added.error()));
      }
    } else if (!add_selector(item, targets)) {
      return std::unexpected(bad_target(list));
    }
  }
  if (list.empty()) { // it has no parts at all
    return std::unexpected(bad_target(list));
  }
  std::ranges::sort(targets.ids);
  const auto repeated = std::ranges::unique(targets.ids);
  targets.ids.erase(repeated.begin(), repeated.end());
  return targets;
}

} // namespace blactl::fleet
