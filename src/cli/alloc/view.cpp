#include "cli/alloc/view.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/json_writer.hpp"

#include "cli/alloc/texts.hpp"
#include "cli/output/table.hpp"

#include <algorithm>
#include <iterator>
#include <ranges>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::cli {

using fleet::AllocatedUnit;
using fleet::AllocationService;
using Event = AllocationService::Event;

namespace {

/// The name in the contract; empty: none.
std::string_view name(Event event) {
  switch (event) {
  case Event::request: return "request";
  case Event::assigned: return "assigned";
  case Event::kept: return "kept";
  case Event::conflict: return "conflict";
  case Event::full: return "full";
  case Event::deaf: break;
  }
  return {};
}

std::string words(Event event, const AllocatedUnit& unit) {
  switch (event) {
  case Event::request: return say<texts::alloc_event_request>();
  case Event::assigned: return say<texts::alloc_event_assigned>(unit.node_id.value());
  case Event::kept: return say<texts::alloc_event_kept>(unit.node_id.value());
  case Event::deaf: return say<texts::alloc_event_deaf>(unit.node_id.value());
  case Event::conflict:
  case Event::full: break;
  }
  return unit.refused ? unit.refused->message : std::string();
}

std::string json_line(UnixTime time, std::string_view event, const dronecan::UniqueId& unique_id,
                      dronecan::NodeId node_id) {
  std::string line;
  JsonWriter json(line);
  json.begin_object();
  json.key("time");
  json.number(time.text());
  json.member("event", event);
  json.member("unique_id", hex(unique_id));
  json.key("node_id");
  node_id.is_unicast() ? json.value(node_id.value()) : json.value(nullptr);
  json.end_object();
  return line + '\n';
}

/// `named`: as it can be selected.
std::string text_line(WallTime time, std::string_view named, std::string_view what) {
  return fmt::format("{}  {}  {}\n", clock_text(time), named, what);
}

/// By the number on its label, if that is known.
std::string name_of(const dronecan::UniqueId& unique_id,
                    const std::optional<std::int64_t>& serial_number) {
  return serial_number ? say<texts::alloc_serial>(*serial_number) : "uid:" + hex(unique_id);
}

std::string state(const AllocationService& service, const AllocatedUnit& unit, const Page& page) {
  if (unit.is_shared) {
    return page.paint(Tone::bad, say<texts::alloc_state_shared>());
  }
  if (unit.refused) {
    return page.paint(Tone::bad, say<texts::alloc_state_refused>());
  }
  if (!unit.node_id.is_unicast()) {
    return say<texts::alloc_event_request>();
  }
  return service.is_there(unit) ? page.paint(Tone::good, say<texts::alloc_state_there>())
                                : say<texts::alloc_state_given>();
}

} // namespace

std::string json_line(UnixTime time, Event event, const AllocatedUnit& unit) {
  const std::string_view known = name(event);
  return known.empty() ? std::string() : json_line(time, known, unit.unique_id, unit.node_id);
}

std::string json_line(UnixTime time, const fleet::IdMove& move) {
  return move.is_temporary ? std::string()
                           : json_line(time, "made_static", move.unique_id, move.to);
}

std::string text_line(WallTime time, Event event, const AllocatedUnit& unit) {
  return text_line(time, name_of(unit.unique_id, {}), words(event, unit));
}

std::string text_line(WallTime time, const fleet::IdMove& move,
                      std::optional<std::int64_t> serial_number) {
  return text_line(time, name_of(move.unique_id, serial_number),
                   move.is_temporary ? say<texts::alloc_event_makes_way>(move.to.value())
                                     : say<texts::alloc_event_made_static>(move.to.value()));
}

std::string json_line(UnixTime time, const StaticUnit& unit) {
  return json_line(time, "kept", unit.unique_id, unit.node_id);
}

std::string text_line(WallTime time, const StaticUnit& unit,
                      std::optional<std::int64_t> serial_number) {
  return text_line(time, name_of(unit.unique_id, serial_number),
                   say<texts::alloc_event_static>(unit.node_id.value()));
}

std::string text(const AllocationService& service, const fleet::Roster& roster, const Page& page) {
  Table table({say<texts::alloc_column_node>(), say<texts::alloc_column_unit>(),
               say<texts::alloc_column_state>(), say<texts::alloc_column_servo>()});
  std::vector<AllocatedUnit> units;
  std::ranges::copy(service.units() | std::views::values, std::back_inserter(units));
  std::ranges::sort(
      units, {}, [](const AllocatedUnit& unit) { return std::pair(unit.node_id, unit.unique_id); });
  for (const AllocatedUnit& unit : units) {
    const fleet::Servo servo = roster.member(unit.node_id).servo();
    const bool is_known = service.is_there(unit) && servo.is_servo;
    const auto serial = servo.identity.readings().serial_number;
    table.add({unit.node_id.is_unicast() ? std::to_string(unit.node_id.value()) : "-",
               hex(unit.unique_id), state(service, unit, page),
               is_known ? fmt::format("{} {}", servo.identity.model(),
                                      serial ? std::to_string(*serial) : std::string())
                        : std::string()});
  }
  std::string out = service.units().empty() ? std::string() : table.text("", page);
  if (const std::size_t asking = service.asking(); asking > 0) {
    out += say<texts::alloc_asking>(asking);
  }
  return out;
}

} // namespace blactl::cli
