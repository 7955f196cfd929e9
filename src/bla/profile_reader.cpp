// The parts common to family and series files.

#include "bla/profile_reader.hpp"

#include "bla/texts.hpp"

#include <algorithm>

namespace blactl::bla {

bool has_key(const json::Value& object, std::string_view key) {
  return std::ranges::any_of(object.items,
                             [=](const json::Value* item) { return item->key == key; });
}

bool describes_series(const json::Document& document) {
  return has_key(document.root(), "series");
}

void read_head(json::Object& root) {
  // For editors, which check the file as it is written.
  static_cast<void>(root.optional_string("$schema"));
  static_cast<void>(root.word("schema", {profile_schema}));
  static_cast<void>(root.word("family", {profile_family}));
}

std::string read_text(json::Object& object, std::string_view key, json::Faults& faults) {
  const json::Value* value = object.any(key);
  if (value == nullptr) {
    return {};
  }
  std::string text = json::as_string(*value, faults).value_or("");
  if (text.empty() && value->kind == json::Kind::string) {
    faults.add(*value, say<texts::profile_empty_text>());
  }
  return text;
}

void read_range(json::Object& object, Parameter& parameter, json::Faults& faults) {
  const std::int64_t lowest = parameter.width.lowest();
  const std::int64_t highest = parameter.width.highest();
  parameter.default_raw = object.optional_integer("default", lowest, highest);
  parameter.min = object.optional_integer("min", lowest, highest);
  parameter.max = object.optional_integer("max", lowest, highest);
  if (!object.exists()) {
    return;
  }
  if (object.has("min") != object.has("max")) {
    faults.add(object.value(), say<texts::profile_range_incomplete>());
  }
  if (!parameter.min || !parameter.max) {
    return;
  }
  const std::int64_t min = *parameter.min;
  const std::int64_t max = *parameter.max;
  const std::int64_t value = parameter.default_raw.value_or(min);
  if (min > max) {
    faults.add(object.value(), say<texts::profile_range_reversed>(min, max));
  } else if (value < min || value > max) {
    faults.add(object.value(), say<texts::profile_default_outside>(value, min, max));
  }
}

} // namespace blactl::bla
