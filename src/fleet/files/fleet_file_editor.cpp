#include "blactl/fleet/files/fleet_file_editor.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/json_reader.hpp"
#include "blactl/base/json_writer.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/bla/explain.hpp"

#include "fleet/files/texts.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {
namespace {

const json::Value* member(const json::Value* object, std::string_view key) {
  if (object == nullptr) {
    return nullptr;
  }
  const auto found = std::ranges::find(object->items, key, &json::Value::key);
  return found != object->items.end() ? *found : nullptr;
}

const json::Value* entry_named(const json::Value& root, std::string_view name) {
  const json::Value* servos = member(&root, "servos");
  if (servos == nullptr) {
    return nullptr;
  }
  const auto found = std::ranges::find_if(servos->items, [&](const json::Value* entry) {
    const json::Value* called = member(entry, "name");
    return called != nullptr && called->text == name;
  });
  return found != servos->items.end() ? *found : nullptr;
}

/// A key of the entry, and the value of the unit for it; empty: unknown.
struct UnitFact {
  std::string_view object, key;
  std::optional<std::string> json;
};

std::vector<UnitFact> unit_facts(const Snapshot& unit, const FleetFileStyle& style) {
  const auto json_of = [](const auto& value) {
    std::string text;
    JsonWriter(text).value(value);
    return text;
  };
  const bla::Readings& readings = unit.servo.identity.readings();
  const auto date = bla::production_time(unit.values());
  const std::string production = date ? *date : "unknown";
  return {
      {"match", "unique_id",
       unit.servo.unique_id.transform([&](const auto& id) { return json_of(hex(id)); })},
      {"match", "serial_number", readings.serial_number.transform(json_of)},
      {"about", "model", json_of(unit.servo.identity.model())},
      {"about", "firmware_version", readings.firmware_version.transform(json_of)},
      {"about", "hardware_version", readings.hardware_version.transform(json_of)},
      {"about", "production_date", json_of(production)},
      {"about", "time", style.time.transform([&](WallTime at) { return json_of(rfc3339(at)); })},
      {"about", "tool_version", json_of(style.tool_version)}};
}

struct Edit {
  std::size_t begin, end;
  std::string text;
};

/// From the end to the begin: what is left to do keeps its place.
std::string edited(std::string_view text, std::vector<Edit> edits) {
  std::ranges::sort(edits, std::greater(), &Edit::begin);
  std::string out(text);
  for (const Edit& edit : edits) {
    out.replace(edit.begin, edit.end - edit.begin, edit.text);
  }
  return out;
}

} // namespace

Result<std::string> with_unit(std::string_view text, const std::string& file, std::string_view name,
                              const Snapshot& unit, const FleetFileStyle& style) {
  const auto document = json::parse(text, file);
  if (!document) {
    return std::unexpected(document.error());
  }
  const json::Value* entry = entry_named(document->root(), name);
  if (entry == nullptr) {
    return fail(Code::bad_file, say<texts::fleet_no_entry>(printable(file), printable(name)));
  }
  std::vector<Edit> edits;
  for (const UnitFact& fact : unit_facts(unit, style)) {
    const json::Value* there = member(member(entry, fact.object), fact.key);
    if (there == nullptr) {
      continue;
    }
    if (!fact.json) {
      const std::uint8_t id = unit.servo.id.value();
      return std::unexpected(Error{Code::timeout, say<texts::fleet_fact_untold>(id, fact.key),
                                   say<texts::fleet_fact_untold_hint>(), id});
    }
    edits.push_back({there->begin, there->end, *fact.json});
  }
  return edited(text, std::move(edits));
}

} // namespace blactl::fleet
