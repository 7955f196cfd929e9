#include "blactl/bla/parameter.hpp"

#include "blactl/base/letter_case.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace blactl::bla {
namespace {

constexpr std::uint8_t last_address = 0x5F;

// In the order of the enumerations.
constexpr std::array<std::string_view, 11> group_names{"command", "status",  "operation", "fault",
                                                       "config",  "control", "pwm",       "limit",
                                                       "option",  "product", "production"};
constexpr std::array<std::string_view, 3> access_names{"R", "W", "RW"};
constexpr std::array<std::string_view, 15> unit_names{"",     "deg",   "rpm", "%",    "A",
                                                      "V",    "us",    "ms",  "degC", "deg/rpm",
                                                      "year", "month", "day", "hour", "minute"};

static_assert(group_names.size() == std::to_underlying(Group::production) + 1U);
static_assert(access_names.size() == std::to_underlying(Access::read_write) + 1U);
static_assert(unit_names.size() == std::to_underlying(Unit::minute) + 1U);

} // namespace

std::string Address::name() const {
  return fmt::format("0x{:02X}", value_);
}

std::optional<Address> find_address(std::string_view text) {
  const bool prefixed = text.size() == 4 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
  if (!prefixed) {
    return std::nullopt;
  }
  std::uint8_t value = 0;
  const auto [end, error] = std::from_chars(text.data() + 2, text.data() + 4, value, 16);
  if (error != std::errc{} || end != text.data() + 4 || value > last_address) {
    return std::nullopt;
  }
  return Address(value);
}

std::string_view name(Group group) {
  return group_names[std::to_underlying(group)];
}

std::optional<Group> find_group(std::string_view word) {
  const auto found = std::ranges::find(group_names, word);
  if (found == group_names.end()) {
    return std::nullopt;
  }
  return static_cast<Group>(found - group_names.begin());
}

std::span<const Group> all_groups() {
  using enum Group;
  static constexpr std::array<Group, 11> all{
      command, status, operation, fault, config, control, pwm, limit, option, product, production};
  return all;
}

std::string_view name(Access access) {
  return access_names[std::to_underlying(access)];
}

std::string_view name(Unit unit) {
  return unit_names[std::to_underlying(unit)];
}

std::int64_t Width::narrow(std::int64_t wire) const {
  const unsigned unused = 64U - bits;
  const auto shifted = static_cast<std::uint64_t>(wire) << unused;
  return is_signed ? static_cast<std::int64_t>(shifted) >> unused
                   : static_cast<std::int64_t>(shifted >> unused);
}

bool Width::holds(std::int64_t wire) const {
  return wire == Width{bits, true}.narrow(wire) || wire == Width{bits, false}.narrow(wire);
}

std::int64_t Width::lowest() const {
  return is_signed ? -(std::int64_t{1} << (bits - 1U)) : 0;
}

std::int64_t Width::highest() const {
  return (std::int64_t{1} << (is_signed ? bits - 1U : bits)) - 1;
}

const Choice* Parameter::choice(std::int64_t raw) const {
  const auto found = std::ranges::find(choices, raw, &Choice::raw);
  return found == choices.end() ? nullptr : &*found;
}

bool mentions(const Parameter& parameter, std::string_view text) {
  const std::string sought = lower(text);
  const auto has_it = [&](std::string_view one) {
    return lower(one).find(sought) != std::string::npos;
  };
  return has_it(parameter.name) || has_it(parameter.name_en) || has_it(parameter.name_ja) ||
         has_it(parameter.vendor_label) || has_it(parameter.meaning_en) ||
         has_it(parameter.meaning_ja) ||
         std::ranges::any_of(parameter.choices, [&](const Choice& choice) {
           return has_it(choice.word) || has_it(choice.text_en) || has_it(choice.text_ja);
         });
}

} // namespace blactl::bla
