#include "sim/scenario/foreign_reader.hpp"

#include "sim/scenario/scenario_values.hpp"
#include "sim/scenario/texts.hpp"

#include <cstdint>
#include <limits>
#include <string_view>

namespace blactl::sim {
namespace {

constexpr std::int64_t max_esc_index = 31;
constexpr std::int64_t max_priority = 31;
constexpr double max_gnss_rate_hz = 50;
constexpr double max_rate_hz = 1000;

/// "rate" in Hz.
Duration read_period(json::Object& object, Duration usual, double max_hz) {
  const auto hz = object.optional_number("rate", 1, max_hz);
  return hz ? Duration(static_cast<Duration::rep>(Duration::period::den / *hz)) : usual;
}

CommanderSetup read_commander(json::Object object, json::Faults& faults) {
  constexpr std::size_t max_commands = 15;
  constexpr std::int64_t every_servo = 255;
  constexpr double max_float16 = 65504;
  CommanderSetup commander;
  const auto ids = object.array("servo_ids");
  for (const json::Value* item : ids) {
    const auto id = json::as_integer(*item, faults, 0, every_servo);
    commander.servo_ids.push_back(static_cast<std::uint8_t>(id.value_or(0)));
  }
  if (object.exists() && (ids.empty() || ids.size() > max_commands)) {
    faults.add(object.value(), say<texts::scenario_servo_ids>());
  }
  commander.type = static_cast<std::uint8_t>(
      object.optional_integer("type", 0, std::numeric_limits<std::uint8_t>::max()).value_or(1));
  commander.value =
      static_cast<float>(object.optional_number("value", -max_float16, max_float16).value_or(0));
  commander.period = read_period(object, commander.period, max_rate_hz);
  object.finish();
  return commander;
}

/// The keys specific to its kind, with their defaults.
void read_kind(json::Object& object, std::string_view kind, ForeignSetup& node) {
  if (kind == "gnss") {
    GnssSetup gnss;
    gnss.period = read_period(object, gnss.period, max_gnss_rate_hz);
    node.kind = gnss;
  } else if (kind == "esc") {
    EscSetup esc;
    esc.index =
        static_cast<std::uint8_t>(object.optional_integer("index", 0, max_esc_index).value_or(0));
    esc.period = read_period(object, esc.period, max_rate_hz);
    node.kind = esc;
    node.serves_get_set = true;
  } else if (kind == "autopilot") {
    node.kind = AutopilotSetup{object.optional_boolean("allocates").value_or(false)};
    node.armed = false;
  } else if (kind == "babbler") {
    BabblerSetup babbler;
    babbler.priority = static_cast<dronecan::Priority>(
        object.optional_integer("priority", 0, max_priority).value_or(babbler.priority));
    babbler.load = object.optional_number("load", 0, 1).value_or(babbler.load);
    node.kind = babbler;
  }
}

} // namespace

ForeignSetup read_foreign(const json::Value& value, json::Faults& faults) {
  ForeignSetup node;
  json::Object object(value, faults);
  const std::string kind = object.word("kind", {"node", "gnss", "esc", "autopilot", "babbler"});
  read_kind(object, kind, node);
  node.node_id = static_cast<std::uint8_t>(object.integer("node_id", 1, dronecan::NodeId::max));
  node.name = read_node_name(object, "org.example." + kind, faults);
  // above every serial number, so that no servo has the same
  node.unique_id = read_unique_id(object, (std::uint64_t{1} << 32U) + node.node_id, faults);
  node.serves_get_set = object.optional_boolean("serves_get_set").value_or(node.serves_get_set);
  if (json::Object commands = object.optional_object("commands"); commands.exists()) {
    node.commands = read_commander(commands, faults);
  }
  if (const auto armed = object.optional_boolean("armed")) {
    node.armed = armed;
  }
  object.finish();
  return node;
}

} // namespace blactl::sim
