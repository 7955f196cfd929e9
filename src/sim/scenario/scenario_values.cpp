#include "sim/scenario/scenario_values.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/sim/node/random.hpp"

#include "sim/scenario/texts.hpp"

#include <charconv>
#include <utility>

namespace blactl::sim {
namespace {

dronecan::UniqueId unique_id_from(std::uint64_t number) {
  Random random(number);
  dronecan::UniqueId id{};
  for (std::uint8_t& byte : id) {
    byte = static_cast<std::uint8_t>(random.next());
  }
  return id;
}

std::optional<dronecan::UniqueId> parse_unique_id(std::string_view text) {
  dronecan::UniqueId id{};
  if (text.size() != 2 * id.size()) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < id.size(); ++i) {
    const char* at = text.data() + 2 * i;
    const auto [end, error] = std::from_chars(at, at + 2, id[i], 16);
    if (error != std::errc{} || end != at + 2) {
      return std::nullopt;
    }
  }
  return id;
}

} // namespace

std::optional<std::string> typed_text(const json::Value& value, json::Faults& faults) {
  switch (value.kind) {
  case json::Kind::integer: return std::to_string(value.integer);
  case json::Kind::real:
  case json::Kind::string: return value.text;
  default: faults.add(value, say<texts::scenario_value_kind>()); return std::nullopt;
  }
}

std::optional<Duration> read_duration(json::Object& object, std::string_view key,
                                      std::chrono::seconds longest, json::Faults& faults) {
  const json::Value* value = object.optional_any(key);
  const auto text = value != nullptr ? typed_text(*value, faults) : std::nullopt;
  if (!text) {
    return std::nullopt;
  }
  bla::Parameter time;
  time.name = key;
  time.unit = bla::Unit::microsecond;
  const auto typed = bla::parse_value(time, bla::NamedBy::name, *text);
  if (!typed) {
    faults.add(*value, typed.error().message);
    return std::nullopt;
  }
  const Duration duration(typed->raw);
  if (duration < Duration::zero() || duration > longest) {
    faults.add(*value, say<texts::scenario_duration>(longest.count()));
  }
  return duration;
}

dronecan::UniqueId read_unique_id(json::Object& object, std::uint64_t fallback,
                                  json::Faults& faults) {
  const auto text = object.optional_string("unique_id");
  if (!text) {
    return unique_id_from(fallback);
  }
  const auto id = parse_unique_id(*text);
  if (!id) {
    faults.add(*object.optional_any("unique_id"), say<texts::scenario_unique_id>());
  }
  return id.value_or(dronecan::UniqueId{});
}

std::string read_node_name(json::Object& object, std::string fallback, json::Faults& faults) {
  constexpr std::size_t max_name = 80;
  auto name = object.optional_string("name");
  if (name && (name->empty() || name->size() > max_name)) {
    faults.add(*object.optional_any("name"), say<texts::scenario_node_name>());
  }
  return name ? *std::move(name) : std::move(fallback);
}

} // namespace blactl::sim
