#include "claims.hpp"

#include "settings.hpp"
#include "told.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

/// The nodes of the document by serial number.
using Servos = std::map<std::int64_t, const json*>;

std::int64_t value_in(const Registers& registers, std::uint8_t address) {
  const auto found = registers.find(address);
  return found != registers.end() ? found->second : 0;
}

bool is_calm(const Step& step) {
  return step.episode.faults.empty();
}

/// Register numbers that the command names for this servo.
Registers wishes(const Command& command, std::int64_t serial) {
  Registers wished;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (const auto known = settings().find(name); known != settings().end()) {
      wished[known->second.address] = known->second.values.at(value);
    } else if (name.starts_with("0x")) {
      wished[address_in(name)] = std::stoll(value);
    }
  };
  if (command.verb() == "set") {
    for (const std::string& word : command.words) {
      if (const auto equals = word.find('='); equals != std::string::npos) {
        add(word.substr(0, equals), word.substr(equals + 1));
      }
    }
  } else if (!command.fleet.is_null()) {
    for (const json& entry : command.fleet["servos"]) {
      if (entry["match"]["serial_number"].get<std::int64_t>() == serial) {
        for (const auto& [name, value] : entry["set"].items()) {
          add(name, value.is_string() ? value.get<std::string>() : value.dump());
        }
      }
    }
  }
  return wished;
}

/// What is asked for is what was typed, all of it.
void check_wishes(const Step& step, std::int64_t serial, const json& node) {
  if (!node.contains("changes")) {
    return;
  }
  Registers wished = wishes(step.command, serial);
  for (const json& change : node["changes"]) {
    const std::uint8_t address = address_in(change["address"]);
    if (const auto wish = wished.find(address); wish != wished.end()) {
      const auto requested = change["requested"].get<std::int64_t>();
      require(requested == wish->second,
              fmt::format("{:#04x} is to be {}, {} was typed", address, requested, wish->second));
      wished.erase(wish);
    }
  }
  require(wished.empty() || !is_reached(node), fmt::format("{}: a wish is left out", serial));
}

/// Nobody who is meant is left out without a word.
void check_all_told(const Step& step, const Servos& nodes) {
  const std::string& verb = step.command.verb();
  if (step.outcome.status != 0) {
    return;
  }
  if (!step.command.fleet.is_null()) {
    for (const json& entry : step.command.fleet["servos"]) {
      const auto serial = entry["match"]["serial_number"].get<std::int64_t>();
      require(nodes.contains(serial), fmt::format("0, but {} is left out", serial));
    }
    return;
  }
  static const std::set<std::string> verbs{"set", "save", "erase", "restart", "get"};
  if (!verbs.contains(verb) || !is_calm(step) || !step.command.has("all")) {
    return;
  }
  for (const auto& [serial, before] : step.before) {
    require(before.node_id == 0 || nodes.contains(serial),
            fmt::format("0, but {} is left out", serial));
  }
}

/// Whether nothing became of a servo that the client could not hear.
bool is_undisturbed(const Step& step, std::int64_t serial) {
  return is_harmless(step.episode) ||
         (step.hears_all() && step.accidents(serial).empty() && !step.is_doubled(serial) &&
          !step.is_written_unheard(serial));
}

/// An ID that is given is nobody else's.
void check_given_ids(const Step& step, std::int64_t serial, const json& node) {
  if (!node.contains("changes") || !is_reached(node) || step.outcome.status != 0 ||
      !is_undisturbed(step, serial) || step.command.has("--dry-run")) {
    return;
  }
  for (const json& change : node["changes"]) {
    const std::uint8_t address = address_in(change["address"]);
    const auto value = change["requested"].get<std::int64_t>();
    if (value == 0 || change["status"] != "written") {
      continue;
    }
    for (const auto& [other, after] : step.after) {
      const bool is_there =
          after.node_id != 0 && step.before.at(other).node_id != 0 && is_undisturbed(step, other);
      const std::int64_t held = address == servo_id         ? value_in(after.ram, servo_id)
                                : address == static_node_id ? after.node_id
                                                            : 0;
      require(other == serial || !is_there || held != value,
              fmt::format("{} gets the ID {}, which {} has", serial, value, other));
    }
    for (const json& foreign : step.episode.scenario.value("foreign", json::array())) {
      require(address != static_node_id || foreign["node_id"].get<std::int64_t>() != value,
              fmt::format("{} gets the node ID {} of another node", serial, value));
    }
  }
}

/// IDs that differ in ROM differ afterwards, and where little goes wrong those on the bus as well.
void check_distinct(const Step& step) {
  const auto shared = [](const States& states, auto id_of) -> std::int64_t {
    std::set<std::int64_t> seen;
    for (const auto& [serial, state] : states) {
      const std::int64_t id = id_of(serial, state);
      if (id != 0 && !seen.insert(id).second) {
        return id;
      }
    }
    return 0;
  };
  const auto on_bus = [](std::int64_t, const ServoState& servo) {
    return std::int64_t{servo.node_id};
  };
  const auto in_rom = [&step](std::int64_t serial, const ServoState& servo) {
    const bool can_be_asked =
        step.before.at(serial).node_id != 0 || step.after.at(serial).node_id != 0;
    return can_be_asked ? value_in(servo.rom, static_node_id) : 0;
  };
  if (shared(step.before, in_rom) == 0) {
    const std::int64_t id = shared(step.after, in_rom);
    require(id == 0, fmt::format("two servos have {} in ROM now", id));
  }
  const auto ever_in_rom = [](std::int64_t, const ServoState& servo) {
    return value_in(servo.rom, static_node_id); // one that was away comes back with it
  };
  if (shared(step.before, on_bus) == 0 && shared(step.before, ever_in_rom) == 0 &&
      is_harmless(step.episode)) {
    const std::int64_t id = shared(step.after, on_bus);
    require(id == 0, fmt::format("two servos are at {} now", id));
  }
}

/// SAVE or RestartNode.
bool is_restart(const OnWire& frame) {
  constexpr std::uint16_t execute_opcode = 10;
  return frame.is_order() && (frame.type() != execute_opcode || frame.frame.data[0] == 0);
}

/// --stagger: so long from one servo to the next.
void check_stagger(const Step& step) {
  if (!step.command.has("--stagger")) {
    return;
  }
  constexpr Duration distance = 500ms - tolerance;
  std::set<std::uint8_t> ordered;
  std::optional<Time> last;
  for (const OnWire& frame : step.outcome.record.changes()) {
    if (is_restart(frame) && ordered.insert(frame.destination()).second) {
      require(!last || frame.at - *last >= distance, "the next servo is ordered too soon");
      last = frame.at;
    }
  }
}

/// SAVE replaces a ROM that was not read only if it is asked to.
void check_unread_rom(const Step& step, std::int64_t serial) {
  const ServoState& before = step.before.at(serial);
  if (!before.has_lost_rom() || step.rom_writes(serial) == 0 || step.has_other_writer(serial) ||
      step.command.has("--overwrite-rom") || step.command.verb() == "erase") {
    return;
  }
  const auto ids = step.node_ids(serial);
  constexpr std::uint16_t execute_opcode = 10;
  Time saved = never;
  for (const OnWire& frame : step.outcome.record.changes()) {
    if (is_restart(frame) && frame.type() == execute_opcode && ids.contains(frame.destination())) {
      saved = std::min(saved, frame.at);
    }
  }
  const auto restarts = step.restarts(serial);
  require(std::ranges::any_of(restarts, [&](Time at) { return at < saved; }),
          fmt::format("{}: saved over a ROM that was not read", serial));
}

/// --trust-ram: nobody restarts who is as wished.
void check_trust(const Step& step, std::int64_t serial, const json& node) {
  if (!step.command.has("--trust-ram") || node.value("status", "") != "unchanged") {
    return;
  }
  const auto ids = step.node_ids(serial);
  const auto orders = step.outcome.record.changes();
  require(std::ranges::none_of(orders,
                               [&](const OnWire& frame) {
                                 return is_restart(frame) && ids.contains(frame.destination());
                               }),
          fmt::format("{} is unchanged, and was restarted in spite of --trust-ram", serial));
}

/// A plan without anything to do: all is as wished.
void check_plan(const Step& step) {
  if (!step.command.has("--dry-run") || step.outcome.status != 0 || step.command.fleet.is_null()) {
    return;
  }
  const bool is_of_ram = step.command.has("--no-save") || step.command.has("--trust-ram");
  for (const auto& [serial, before] : step.before) {
    if (step.changed_unheard(serial) || step.has_other_writer(serial)) {
      continue;
    }
    for (const auto& [address, value] : wishes(step.command, serial)) {
      require(value_in(step.after.at(serial).ram, address) == value &&
                  (is_of_ram || value_in(step.after.at(serial).rom, address) == value),
              fmt::format("nothing to do, but {:#04x} of {} differs", address, serial));
    }
  }
}

/// The numbers that a script reads first.
void check_counts(const Step& step, const Servos& nodes) {
  const json counts = step.outcome.document.value("counts", json::object());
  std::int64_t written = 0;
  std::map<std::string, std::int64_t> statuses;
  for (const auto& [serial, node] : nodes) {
    statuses[node->value("status", "")] += 1;
    if (node->contains("changes")) {
      written += std::ranges::count_if(
          (*node)["changes"], [](const json& change) { return change["status"] == "written"; });
    }
  }
  for (const auto& [name, count] : counts.items()) {
    const bool is_status = name == "changed" || name == "unchanged" || name == "done";
    const std::int64_t due = name == "written" ? written : is_status ? statuses[name] : -1;
    const bool is_whole =
        nodes.size() == step.outcome.document.value("nodes", json::array()).size();
    require(due < 0 || !is_whole || count.get<std::int64_t>() == due,
            fmt::format("{} are told as {}, it counts {}", due, name, count.dump()));
  }
}

/// An upper limit is above the lower one.
void check_limits(const Step& step, std::int64_t serial, const json& node) {
  constexpr std::pair<std::uint8_t, std::uint8_t> pairs[]{{0x3E, 0x3F}, {0x40, 0x41}};
  if (!node.contains("changes") || step.outcome.status != 0 || step.changed_unheard(serial)) {
    return;
  }
  const Registers& ram = step.after.at(serial).ram;
  for (const json& change : node["changes"]) {
    const std::uint8_t address = address_in(change["address"]);
    for (const auto& [high, low] : pairs) {
      require((address != high && address != low) || value_in(ram, high) > value_in(ram, low),
              fmt::format("{}: {:#04x} is not above {:#04x}", serial, high, low));
    }
  }
}

/// Whether nobody but this program has ever written to RAM.
bool knows_ram(const Episode& episode) {
  return !episode.has("ram_unlike_rom") &&
         std::ranges::none_of(episode.faults,
                              [](const auto& kind) { return kind.starts_with("other"); });
}

/// What nobody named, and is permanent now, is told.
void check_unnamed(const Step& step, std::int64_t serial, const json& node) {
  const std::string& verb = step.command.verb();
  const bool saves = verb == "save" || (verb == "set" && step.command.has("--save")) ||
                     (verb == "apply" && !step.command.has("--no-save")) || verb == "replace";
  if (!saves || step.outcome.status != 0 || step.command.has("--dry-run") ||
      step.rom_writes(serial) == 0 || !knows_ram(step.episode) || !step.accidents(serial).empty()) {
    return;
  }
  const Registers wished = wishes(step.command, serial);
  const ServoState& before = step.before.at(serial);
  for (const auto& [address, rom] : before.rom) {
    const std::int64_t ram = before.ram.at(address);
    if (ram == rom || wished.contains(address) || step.after.at(serial).rom.at(address) != ram ||
        address == servo_id || address == static_node_id) {
      continue;
    }
    const json warnings = node.value("warnings", json::array());
    require(
        std::ranges::any_of(warnings,
                            [](const json& warning) { return warning["code"] == "unnamed_saved"; }),
        fmt::format("{}: {:#04x} was saved, which nobody named, without a word", serial, address));
  }
}

/// What another node wrote to RAM does not become permanent by a command that ends well.
void check_not_by_others(const Step& step, std::int64_t serial, const json& node) {
  static const std::set<std::string> verbs{"set", "save", "apply", "alloc"};
  if (!verbs.contains(step.command.verb()) || step.outcome.status != 0 || !is_reached(node) ||
      step.rom_writes(serial) == 0 || step.is_saved_by_other(serial)) {
    return;
  }
  const Registers wished = wishes(step.command, serial);
  const ServoState& before = step.before.at(serial);
  const json warnings = node.value("warnings", json::array());
  const bool is_told = std::ranges::any_of(
      warnings, [](const json& warning) { return warning["code"] == "unnamed_saved"; });
  for (const auto& [address, rom] : step.after.at(serial).rom) {
    const bool is_as_before = rom == before.rom.at(address) || rom == before.ram.at(address);
    require(is_as_before || wished.contains(address) || address == servo_id ||
                address == static_node_id || is_told,
            fmt::format("{}: another node's {} of {:#04x} was saved without a word", serial, rom,
                        address));
  }
}

/// Whose unique ID is blank is not told from others.
void check_blank(const Step& step, std::int64_t serial, const json& node) {
  const std::string& unique_id = step.after.at(serial).unique_id;
  static const std::set<std::string> looks{"get", "doctor", "faults", "export"};
  const bool is_blank = unique_id.find_first_not_of('0') == std::string::npos ||
                        unique_id.find_first_not_of('f') == std::string::npos;
  require(!is_blank || looks.contains(step.command.verb()) || step.command.has("--dry-run") ||
              step.outcome.status != 0 || !is_reached(node),
          fmt::format("0, but the unique ID of {} is blank", serial));
}

/// characterize puts everything back.
void check_put_back(const Step& step) {
  if (step.command.verb() != "characterize" || step.outcome.status != 0) {
    return;
  }
  for (const auto& [serial, after] : step.after) {
    if (step.changed_unheard(serial) || step.has_other_writer(serial) ||
        !step.accidents(serial).empty()) {
      continue;
    }
    for (const auto& [address, rom] : after.rom) {
      require(after.ram.at(address) == step.before.at(serial).ram.at(address),
              fmt::format("{:#04x} of {} is not as before", address, serial));
    }
  }
}

} // namespace

void check_claims(const Step& step) {
  const auto listed = told_servos(step);
  const Servos nodes(listed.begin(), listed.end());
  check_all_told(step, nodes);
  check_distinct(step);
  check_stagger(step);
  check_plan(step);
  check_counts(step, nodes);
  check_put_back(step);
  for (const auto& [serial, state] : step.after) {
    check_unread_rom(step, serial);
  }
  for (const auto& [serial, node] : nodes) {
    check_wishes(step, serial, *node);
    check_given_ids(step, serial, *node);
    check_trust(step, serial, *node);
    check_limits(step, serial, *node);
    check_unnamed(step, serial, *node);
    check_not_by_others(step, serial, *node);
    check_blank(step, serial, *node);
  }
}

void check_table(const Step& list) {
  std::map<std::string, std::int64_t> entries;
  for (const json& entry : list.outcome.document["entries"]) {
    entries[entry["unique_id"].get<std::string>()] = entry["node_id"].get<std::int64_t>();
  }
  for (const auto& [serial, servo] : list.after) {
    const auto entry = entries.find(servo.unique_id);
    if (servo.node_id == 0) {
      continue;
    }
    require(entry == entries.end() || entry->second == servo.node_id,
            fmt::format("{} is at {}, another ID stands in the table", serial, servo.node_id));
    const json& servos = list.episode.scenario["servos"];
    const auto drawn = std::ranges::find_if(servos, [&](const json& one) {
      return one["serial_number"].get<std::int64_t>() == serial;
    });
    require((*drawn)["node_id"] == servo.node_id || entry != entries.end(),
            fmt::format("{} has moved to {}, which is not in the table", serial, servo.node_id));
    const bool is_dynamic =
        value_in(servo.rom, static_node_id) == 0 && value_in(servo.ram, static_node_id) == 0;
    require(!is_dynamic || entry != entries.end(),
            fmt::format("{} was given {}, which is not in the table", serial, servo.node_id));
  }
}

void check_file(const Step& step) {
  const Command& command = step.command;
  if (command.broken == 0) {
    return;
  }
  const std::string& file = step.outcome.file;
  const bool names_new = file == command.file(/*has_ended=*/true);
  require(names_new || file == command.file(/*has_ended=*/false), "the file is damaged: " + file);
  require(names_new || step.outcome.status != 0, "0, but the file names the broken servo");
  const auto serial = command.fleet["servos"][0]["match"]["serial_number"].get<std::int64_t>();
  if (!names_new || step.has_other_writer(serial)) {
    return;
  }
  for (const auto& [address, value] : wishes(command, serial)) {
    require(step.after.at(serial).rom.at(address) == value,
            fmt::format("the file names {}, whose ROM does not hold {:#04x}", serial, address));
  }
}

void check_undo(const Step& change, const Step& undo) {
  static const std::set<std::string> verbs{"set", "apply", "erase"};
  if (!verbs.contains(change.command.verb()) || undo.command.verb() != "undo" ||
      change.outcome.status != 0 || undo.outcome.status != 0 || !is_calm(undo)) {
    return;
  }
  for (const auto& [serial, before] : change.before) {
    const ServoState& changed = change.after.at(serial);
    const ServoState& undone = undo.after.at(serial);
    const bool was_saved = change.rom_writes(serial) > 0;
    if (!change.restarts(serial).empty() && !was_saved) {
      continue; // what RAM held alone is lost
    }
    for (const auto& [address, rom] : before.rom) {
      // what was saved goes back to what ROM held, if the record knows of a trial in RAM
      const bool is_back_to_rom = was_saved && undone.ram.at(address) == rom;
      const std::int64_t due = is_back_to_rom ? rom : before.ram.at(address);
      if (before.ram.at(address) == changed.ram.at(address)) {
        continue;
      }
      require(undone.ram.at(address) == due,
              fmt::format("undo leaves {:#04x} of {} at {}, it was {}", address, serial,
                          undone.ram.at(address), due));
      require(!was_saved || undo.command.has("--no-save") || undone.rom.at(address) == due,
              fmt::format("undo leaves {:#04x} of {} in ROM at {}, it was {}", address, serial,
                          undone.rom.at(address), due));
    }
  }
}

} // namespace blactl::campaign
