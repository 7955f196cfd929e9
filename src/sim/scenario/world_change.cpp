#include "blactl/sim/scenario/world_change.hpp"

#include "blactl/bla/parameter.hpp"
#include "blactl/bla/value.hpp"

#include "sim/scenario/texts.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace blactl::sim {
namespace {

using Number = std::int64_t;

/// A numeric member of World, with the unit and range of its input.
struct Quantity {
  std::string_view key;
  bla::Unit unit;
  Number steps_per_unit, min, max;
  std::string_view none; ///< the word for "none"; empty: there always is a value
  void (*set)(World&, std::optional<Number>);
};

constexpr std::array quantities{
    Quantity{"voltage", bla::Unit::volt, 10, 0, 600, "",
             [](World& world, std::optional<Number> raw) { world.supply_decivolt = *raw; }},
    Quantity{"temperature", bla::Unit::deg_celsius, 1, -100, 200, "",
             [](World& world, std::optional<Number> raw) { world.board_celsius = *raw; }},
    Quantity{"load", bla::Unit::percent, 1, -1000, 1000, "",
             [](World& world, std::optional<Number> raw) { world.load_percent = *raw; }},
    Quantity{"hand", bla::Unit::deg, 10, -36'000'000, 36'000'000, "free",
             [](World& world, std::optional<Number> raw) { world.hand_decideg = raw; }},
    Quantity{"pulse", bla::Unit::microsecond, 1, 1, 100'000, "none",
             [](World& world, std::optional<Number> raw) { world.pulse_us = raw; }},
};

/// A yes-or-no member of World.
struct Switch {
  std::string_view key;
  bool World::* member;
};

constexpr std::array switches{
    Switch{"stuck", &World::stuck},
    Switch{"driver_stopped", &World::driver_stopped},
    Switch{"rotation_abnormal", &World::rotation_abnormal},
    Switch{"plugged", &World::plugged},
};

constexpr std::array magnets{
    std::pair{std::string_view("fine"), Magnet::fine},
    std::pair{std::string_view("weak"), Magnet::weak},
    std::pair{std::string_view("strong"), Magnet::strong},
    std::pair{std::string_view("unreadable"), Magnet::unreadable},
};

template <class Entries, class Text> std::string list(const Entries& entries, Text text) {
  std::string out;
  for (const auto& entry : entries) {
    out += (out.empty() ? "" : ", ") + std::string(text(entry));
  }
  return out;
}

std::unexpected<Error> wrong_word(std::string_view key, std::string_view value,
                                  const std::string& words) {
  return fail(Code::usage, say<texts::world_word>(key, printable(value)),
              say<texts::world_words>(words));
}

Result<WorldChange> change(const Quantity& quantity, std::string_view value) {
  if (!quantity.none.empty() && value == quantity.none) {
    return [set = quantity.set](World& world) { set(world, std::nullopt); };
  }
  bla::Parameter parameter;
  parameter.name = quantity.key;
  parameter.unit = quantity.unit;
  parameter.steps_per_unit = quantity.steps_per_unit;
  parameter.min = quantity.min;
  parameter.max = quantity.max;
  const auto typed = bla::parse_value(parameter, bla::NamedBy::name, value);
  if (!typed) {
    return std::unexpected(typed.error());
  }
  if (const auto fits = bla::check_range(parameter, typed->raw); !fits) {
    return std::unexpected(fits.error());
  }
  return [set = quantity.set, raw = typed->raw](World& world) { set(world, raw); };
}

Result<WorldChange> change(const Switch& what, std::string_view value) {
  if (value != "on" && value != "off") {
    return wrong_word(what.key, value, "on, off");
  }
  return [member = what.member, on = value == "on"](World& world) { world.*member = on; };
}

Result<WorldChange> change_magnet(std::string_view value) {
  for (const auto& [word, magnet] : magnets) {
    if (word == value) {
      return [magnet](World& world) { world.magnet = magnet; };
    }
  }
  return wrong_word("magnet", value, list(magnets, [](const auto& entry) { return entry.first; }));
}

} // namespace

Result<WorldChange> parse_world_change(std::string_view key, std::string_view value) {
  for (const Quantity& quantity : quantities) {
    if (quantity.key == key) {
      return change(quantity, value);
    }
  }
  for (const Switch& what : switches) {
    if (what.key == key) {
      return change(what, value);
    }
  }
  if (key == "magnet") {
    return change_magnet(value);
  }
  const auto name = [](const auto& entry) { return entry.key; };
  return fail(
      Code::usage, say<texts::world_key>(printable(key)),
      say<texts::world_words>(list(quantities, name) + ", " + list(switches, name) + ", magnet"));
}

} // namespace blactl::sim
