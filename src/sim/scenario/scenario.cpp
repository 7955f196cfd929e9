#include "blactl/sim/scenario/scenario.hpp"

#include "blactl/base/json_reader.hpp"

#include "sim/scenario/foreign_reader.hpp"
#include "sim/scenario/member.hpp"
#include "sim/scenario/member_tables.hpp"
#include "sim/scenario/scenario_values.hpp"
#include "sim/scenario/servo_reader.hpp"
#include "sim/scenario/texts.hpp"

#include <algorithm>

namespace blactl::sim {
namespace {

constexpr Member<Scenario> of_all[]{
    {"clock", word<&Scenario::clock, "real", "virtual">},
    {"seed", integer<&Scenario::seed, 0, json::highest>},
};

constexpr std::string_view schema = "blactl-scenario/1";

constexpr std::string_view default_text = R"({
  "schema": "blactl-scenario/1",
  "servos": [
    {"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1},
    {"model": "BLA15-06U-A0", "node_id": 12, "servo_id": 2},
    {"model": "BLA34-28U-AB", "node_id": 13, "servo_id": 3}
  ]
})";

/// Reads one scenario; errors go to the list of the document.
class ScenarioReader {
 public:
  ScenarioReader(const bla::Profiles& profiles, const Behaviour& usual, json::Faults& faults)
      : profiles_(profiles), usual_(usual), faults_(faults) {}

  Scenario scenario(json::Object root);

 private:
  TimedEvent event(const json::Value& value, const std::vector<ServoSetup>& servos);
  std::optional<Mishap> mishap(json::Object& object);
  std::vector<WorldChange> world(json::Object object);

  const bla::Profiles& profiles_;
  const Behaviour& usual_;
  json::Faults& faults_;
};

Scenario ScenarioReader::scenario(json::Object root) {
  Scenario scenario;
  (void)root.optional_string("$schema"); // for editors
  (void)root.word("schema", {schema});
  read_members(root, of_all, scenario, faults_);
  ServoReader servos(profiles_, usual_, faults_);
  for (const json::Value* item : root.optional_array("servos")) {
    scenario.servos.push_back(servos.read(*item, scenario.servos.size()));
  }
  scenario.warnings = servos.warnings();
  for (const json::Value* item : root.optional_array("foreign")) {
    scenario.foreign.push_back(read_foreign(*item, faults_));
  }
  read_whole(root.optional_object("wire"), wire_members, scenario.wire, faults_);
  for (const json::Value* item : root.optional_array("events")) {
    scenario.events.push_back(event(*item, scenario.servos));
  }
  root.finish();
  return scenario;
}

TimedEvent ScenarioReader::event(const json::Value& value, const std::vector<ServoSetup>& servos) {
  TimedEvent event;
  json::Object object(value, faults_);
  up_to_seconds<&TimedEvent::at, 1'000'000>(object, "at", event, faults_);
  if (const auto serial = object.optional_integer("servo", 1)) {
    event.serial_number = *serial;
    if (std::ranges::find(servos, *serial, &ServoSetup::serial_number) == servos.end()) {
      faults_.add(*object.optional_any("servo"), say<texts::scenario_no_such_serial>(*serial));
    }
    event.changes = world(object.optional_object("world"));
    event.mishap = mishap(object);
    if (!object.has("world") && !object.has("happens")) {
      faults_.add(value, say<texts::scenario_event_servo>());
    }
  } else if (const auto link = object.optional_word("clients", {"joined", "cut", "bus_off"})) {
    event.clients = parse_client_link(*link).value_or(ClientLink::joined);
  } else if (object.exists() && !object.has("servo") && !object.has("clients")) {
    faults_.add(value, say<texts::scenario_event_object>());
  }
  object.finish();
  return event;
}

std::optional<Mishap> ScenarioReader::mishap(json::Object& object) {
  const auto word = object.optional_word("happens", {"power_off", "power_on", "clock_error",
                                                     "watchdog_error", "ram_error", "rom_error"});
  const auto found = std::ranges::find(mishaps, word.value_or(""),
                                       [](const auto& mishap) { return mishap.first; });
  return found != mishaps.end() ? std::optional(found->second) : std::nullopt;
}

std::vector<WorldChange> ScenarioReader::world(json::Object object) {
  std::vector<WorldChange> changes;
  for (const json::Value* member : object.members()) {
    const auto text = typed_text(*member, faults_);
    if (!text) {
      continue;
    }
    if (auto change = parse_world_change(member->key, *text)) {
      changes.push_back(*std::move(change));
    } else {
      const std::string& hint = change.error().hint;
      faults_.add(*member, change.error().message + (hint.empty() ? "" : ": " + hint));
    }
  }
  return changes;
}

Result<Scenario> from_document(Result<json::Document> document, const bla::Profiles& profiles,
                               const Behaviour& usual) {
  if (!document) {
    return std::unexpected(document.error());
  }
  json::Faults& faults = document->faults();
  Scenario scenario =
      ScenarioReader(profiles, usual, faults).scenario(json::Object(document->root(), faults));
  if (const auto fine = faults.result(); !fine) {
    return std::unexpected(fine.error());
  }
  return scenario;
}

} // namespace

Result<Scenario> read_scenario(const std::filesystem::path& file, const bla::Profiles& profiles,
                               const Behaviour& usual) {
  return from_document(json::parse_file(file), profiles, usual);
}

Result<Scenario> parse_scenario(std::string_view text, std::string file,
                                const bla::Profiles& profiles, const Behaviour& usual) {
  return from_document(json::parse(text, std::move(file)), profiles, usual);
}

Result<Scenario> default_scenario(const bla::Profiles& profiles, const Behaviour& usual) {
  return parse_scenario(default_text, "sim:", profiles, usual);
}

} // namespace blactl::sim
