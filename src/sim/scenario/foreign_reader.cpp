#include "sim/scenario/foreign_reader.hpp"

#include "sim/scenario/member.hpp"
#include "sim/scenario/scenario_values.hpp"
#include "sim/scenario/texts.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>

namespace blactl::sim {
namespace {

constexpr std::int64_t max_rate_hz = 1000;
constexpr std::int64_t max_float16 = 65504;
constexpr std::int64_t min_register = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t max_register = std::numeric_limits<std::uint32_t>::max();

void read_servo_ids(json::Object& object, std::string_view key, CommanderSetup& into,
                    json::Faults& faults) {
  constexpr std::size_t max_commands = 15;
  constexpr std::int64_t every_servo = 255;
  const auto ids = object.array(key);
  for (const json::Value* item : ids) {
    const auto id = json::as_integer(*item, faults, 0, every_servo);
    into.servo_ids.push_back(static_cast<std::uint8_t>(id.value_or(0)));
  }
  if (ids.empty() || ids.size() > max_commands) {
    faults.add(object.value(), say<texts::scenario_servo_ids>());
  }
}

constexpr Member<CommanderSetup> commander[]{
    {"servo_ids", read_servo_ids},
    {"type", to<&CommanderSetup::type>},
    {"value", number<&CommanderSetup::value, -max_float16, max_float16>},
    {"rate", rate<&CommanderSetup::period, max_rate_hz>},
};

void read_commander(json::Object& object, std::string_view key, ForeignSetup& into,
                    json::Faults& faults) {
  if (json::Object commands = object.optional_object(key); commands.exists()) {
    read_whole(commands, commander, into.commands.emplace(), faults);
  }
}

constexpr Member<OrderSetup> order[]{
    {"at", up_to_seconds<&OrderSetup::at, 3600>},
    {"to", integer<&OrderSetup::to, 1, 127>},
    {"order", word<&OrderSetup::order, "erase", "save", "restart", "initialize", "write">},
    {"address", to<&OrderSetup::address>},
    {"value", integer<&OrderSetup::value, min_register, max_register>},
};

void read_orders(json::Object& object, std::string_view key, ForeignSetup& into,
                 json::Faults& faults) {
  for (const json::Value* item : object.optional_array(key)) {
    read_whole(json::Object(*item, faults), order, into.orders.emplace_back(), faults);
  }
  std::ranges::stable_sort(into.orders, {}, &OrderSetup::at);
}

constexpr Member<ForeignSetup> every_kind[]{
    {"serves_get_set", to<&ForeignSetup::serves_get_set>},
    {"commands", read_commander},
    {"orders", read_orders},
    {"armed", to<&ForeignSetup::armed>},
    {"joins", up_to_seconds<&ForeignSetup::joins, 3600>},
    {"begins", up_to_seconds<&ForeignSetup::begins, 3600>},
    {"actuator_id", integer<&ForeignSetup::actuator_id, 0, 255>},
    {"status_period", up_to_seconds<&ForeignSetup::status_period, 3600>},
};

constexpr Member<GnssSetup> gnss[]{{"rate", rate<&GnssSetup::period, 50>}};
constexpr Member<EscSetup> esc[]{
    {"index", integer<&EscSetup::index, 0, 31>},
    {"rate", rate<&EscSetup::period, max_rate_hz>},
};
constexpr Member<AutopilotSetup> autopilot[]{{"allocates", to<&AutopilotSetup::allocates>}};
constexpr Member<BabblerSetup> babbler[]{
    {"priority", integer<&BabblerSetup::priority, 0, 31>},
    {"load", number<&BabblerSetup::load, 0, 1>},
};

/// These keys, and what is usual for the kind.
void read_kind(json::Object& object, std::string_view kind, ForeignSetup& node,
               json::Faults& faults) {
  if (kind == "gnss") {
    read_members(object, gnss, node.kind.emplace<GnssSetup>(), faults);
  } else if (kind == "esc") {
    read_members(object, esc, node.kind.emplace<EscSetup>(), faults);
    node.serves_get_set = true;
  } else if (kind == "autopilot") {
    read_members(object, autopilot, node.kind.emplace<AutopilotSetup>(), faults);
    node.armed = false;
  } else if (kind == "babbler") {
    read_members(object, babbler, node.kind.emplace<BabblerSetup>(), faults);
  }
}

} // namespace

ForeignSetup read_foreign(const json::Value& value, json::Faults& faults) {
  ForeignSetup node;
  json::Object object(value, faults);
  const std::string kind = object.word("kind", {"node", "gnss", "esc", "autopilot", "babbler"});
  read_kind(object, kind, node, faults);
  node.node_id = static_cast<std::uint8_t>(object.integer("node_id", 1, dronecan::NodeId::max));
  node.name = read_node_name(object, "org.example." + kind, faults);
  // above every serial number, so that no servo has the same
  node.unique_id = read_unique_id(object, (std::uint64_t{1} << 32U) + node.node_id, faults);
  read_members(object, every_kind, node, faults);
  object.finish();
  return node;
}

} // namespace blactl::sim
