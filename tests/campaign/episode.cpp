#include "episode.hpp"

#include "limits.hpp"
#include "settings.hpp"
#include "step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <map>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;

constexpr std::int64_t first_serial = 240900001;

const std::vector<std::string> models{
    "BLA15-06U-A0", "BLA15-12U-A0", "BLA21-06U-A0", "BLA21-06U-AB", "BLA21-12U-A0",
    "BLA21-12U-AB", "BLA21-28U-A0", "BLA21-28U-AB", "BLA34-12U-AB", "BLA34-28U-AB"};

struct Draft {
  Episode& episode;
  Chance& chance;

  [[nodiscard]] json& some_servo() const {
    json& servos = episode.scenario["servos"];
    return servos[static_cast<std::size_t>(
        chance.whole(0, static_cast<std::int64_t>(servos.size()) - 1))];
  }

  void fault(const char* name, json value) const {
    some_servo()["faults"][name] = std::move(value);
  }

  void event(json what, std::int64_t at_ms) const {
    what["at"] = fmt::format("{}ms", at_ms);
    episode.scenario["events"].push_back(std::move(what));
  }

  /// Something befalls a servo, and is over after a while.
  void passing(const char* key, const json& begin, const json& end) const {
    const std::int64_t serial = some_servo()["serial_number"];
    const std::int64_t at = chance.whole(100, 6000);
    event({{"servo", serial}, {key, begin}}, at);
    event({{"servo", serial}, {key, end}}, at + chance.whole(1, 900));
  }

  void foreign(json node) const { episode.scenario["foreign"].push_back(std::move(node)); }

  [[nodiscard]] std::int64_t some_node() const {
    return std::max<std::int64_t>(1, some_servo()["node_id"]);
  }
};

/// Every servo, alone or as the first of as many as one ArrayCommand takes.
json commanded(Chance& chance) {
  json ids = json::array({255});
  constexpr std::size_t most = 15;
  const std::size_t count = chance.comes(0.5) ? most : 1;
  for (int id = 200; ids.size() < count; ++id) {
    ids.push_back(id);
  }
  return ids;
}

std::string ms(std::int64_t count) {
  return fmt::format("{}ms", count);
}

using Plant = std::function<void(const Draft&)>;

json restarts(Chance& chance) {
  json all = json::array();
  for (std::int64_t i = chance.whole(1, 2); i > 0; --i) {
    all.push_back({{"to", chance.one_of<std::string>(
                              {"any", "node_info", "read", "write", "write", "opcode"})},
                   {"number", chance.one_of<std::int64_t>({1, 1, 2, 3, chance.whole(4, 80)})}});
  }
  return all;
}

/// One order of another tool, somewhere in the time of the commands.
void order(const Draft& draft, const char* what) {
  const auto others = draft.episode.scenario.value("foreign", json::array()).size();
  draft.foreign({{"kind", "node"},
                 {"node_id", 80 + others},
                 {"orders", json::array({{{"at", ms(draft.chance.whole(500, 12000))},
                                          {"to", draft.some_node()},
                                          {"order", what}}})}});
}

/// The same value of one register, again and again, or once.
void writes(const Draft& draft, bool repeated) {
  json orders = json::array();
  const std::int64_t node = draft.some_node();
  const std::int64_t address = draft.chance.one_of<std::int64_t>({0x20, 0x22, 0x38});
  const std::int64_t value = address == 0x38 ? 450 : 0;
  std::int64_t at = repeated ? 0 : draft.chance.whole(500, 12000);
  do {
    orders.push_back(
        {{"at", ms(at)}, {"to", node}, {"order", "write"}, {"address", address}, {"value", value}});
    at += 100;
  } while (repeated && at < 15000);
  draft.foreign({{"kind", "node"}, {"node_id", 91}, {"orders", orders}});
}

/// The kinds of faults, by name.
const std::map<std::string, Plant>& plants() {
  static const std::map<std::string, Plant> all{
      {"lose_responses", [](const Draft& d) { d.fault("lose_responses", d.chance.whole(1, 3)); }},
      {"lose_opcode_answers",
       [](const Draft& d) { d.fault("lose_opcode_answers", d.chance.whole(1, 3)); }},
      {"ignore_opcodes", [](const Draft& d) { d.fault("ignore_opcodes", d.chance.whole(1, 3)); }},
      {"refuse_opcodes", [](const Draft& d) { d.fault("refuse_opcodes", true); }},
      {"deny_opcodes", [](const Draft& d) { d.fault("deny_opcodes", true); }},
      {"rom_write_fails", [](const Draft& d) { d.fault("rom_write_fails", true); }},
      {"stays", [](const Draft& d) { d.fault("stays", true); }},
      {"never_returns", [](const Draft& d) { d.fault("never_returns", true); }},
      {"mute", [](const Draft& d) { d.fault("mute", true); }},
      {"no_node_status", [](const Draft& d) { d.fault("no_node_status", true); }},
      {"no_actuator_status", [](const Draft& d) { d.fault("no_actuator_status", true); }},
      {"restart_instead_of_answer",
       [](const Draft& d) { d.fault("restart_instead_of_answer", d.chance.whole(1, 60)); }},
      {"restart_after_answer",
       [](const Draft& d) { d.fault("restart_after_answer", restarts(d.chance)); }},
      {"power_loss_in_save",
       [](const Draft& d) { d.fault("power_loss_in_save", ms(d.chance.whole(0, 49))); }},
      {"return_delay",
       [](const Draft& d) {
         d.fault("return_delay", ms(d.chance.one_of<std::int64_t>({1000, 3000, 8000})));
       }},
      {"rom_unread",
       [](const Draft& d) {
         json& servo = d.some_servo();
         servo["rom"]["angle_limit_cw"] = "77deg";
         servo["faults"]["rom_unread_starts"] = d.chance.whole(1, 4);
       }},
      {"strange_answers",
       [](const Draft& d) {
         d.some_servo()["behaviour"].update(
             {{"out_of_range", d.chance.one_of<std::string>({"refuse", "clamp", "fail"})},
              {"answers_save_first", d.chance.comes(0.5)},
              {"failure_with_name", d.chance.comes(0.5)}});
       }},
      {"slow_rom",
       [](const Draft& d) {
         d.some_servo()["behaviour"]["rom_write_time"] =
             d.chance.one_of<std::string>({"50ms", "400ms"});
       }},
      {"late_answers",
       [](const Draft& d) {
         d.some_servo()["sending"].update(
             {{"late_answers", d.chance.one_of<double>({0.05, 0.2})},
              {"late_by", ms(d.chance.one_of<std::int64_t>({60, 250, 1500}))}});
       }},
      {"double_answers", [](const Draft& d) { d.some_servo()["sending"]["double_answers"] = 0.1; }},
      {"jitter", [](const Draft& d) { d.some_servo()["sending"]["jitter"] = "10ms"; }},
      {"loss",
       [](const Draft& d) {
         d.episode.scenario["wire"]["loss"] = d.chance.one_of<double>({0.001, 0.01, 0.05, 0.1});
       }},
      {"duplication", [](const Draft& d) { d.episode.scenario["wire"]["duplication"] = 0.01; }},
      {"errors", [](const Draft& d) { d.episode.scenario["wire"]["errors"] = 0.01; }},
      {"bit_flips", [](const Draft& d) { d.episode.scenario["wire"]["bit_flips"] = 0.01; }},
      {"bursts",
       [](const Draft& d) {
         d.episode.scenario["wire"].update(
             {{"burst_interval", "500ms"},
              {"burst_length", ms(d.chance.one_of<std::int64_t>({1, 20, 100}))}});
       }},
      {"dip",
       [](const Draft& d) { d.passing("world", {{"voltage", "2V"}}, {{"voltage", "12V"}}); }},
      {"plug",
       [](const Draft& d) { d.passing("world", {{"plugged", "off"}}, {{"plugged", "on"}}); }},
      {"power", [](const Draft& d) { d.passing("happens", "power_off", "power_on"); }},
      {"unplug",
       [](const Draft& d) {
         d.event({{"servo", d.some_servo()["serial_number"]}, {"world", {{"plugged", "off"}}}},
                 d.chance.whole(100, 6000));
       }},
      {"upset",
       [](const Draft& d) {
         d.event({{"servo", d.some_servo()["serial_number"]},
                  {"happens", d.chance.one_of<std::string>(
                                  {"clock_error", "watchdog_error", "ram_error", "rom_error"})}},
                 d.chance.whole(100, 6000));
       }},
      {"cut",
       [](const Draft& d) {
         const std::int64_t at = d.chance.whole(100, 6000);
         d.event({{"clients", "cut"}}, at);
         d.event({{"clients", "joined"}}, at + d.chance.whole(10, 900));
       }},
      {"bus_off",
       [](const Draft& d) { d.event({{"clients", "bus_off"}}, d.chance.whole(100, 6000)); }},
      {"armed",
       [](const Draft& d) {
         d.foreign({{"kind", "node"},
                    {"node_id", 104},
                    {"armed", true},
                    {"begins", ms(d.chance.whole(0, 15000))}});
         if (d.chance.comes(0.5)) { // one word of a node says nothing of another
           d.foreign({{"kind", "node"}, {"node_id", 106}, {"armed", false}});
         }
       }},
      {"driven",
       [](const Draft& d) {
         d.foreign({{"kind", "node"},
                    {"node_id", 105},
                    {"commands", {{"servo_ids", commanded(d.chance)}, {"rate", 50}}},
                    {"begins", ms(d.chance.whole(0, 15000))}});
       }},
      {"allocator",
       [](const Draft& d) {
         d.foreign({{"kind", "autopilot"}, {"node_id", 100}, {"allocates", true}});
       }},
      {"other_nodes",
       [](const Draft& d) {
         d.foreign({{"kind", "gnss"}, {"node_id", 61}});
         d.foreign({{"kind", "esc"}, {"node_id", 102}});
       }},
      {"babbler",
       [](const Draft& d) {
         d.foreign({{"kind", "babbler"}, {"node_id", 103}, {"priority", 0}, {"load", 0.5}});
       }},
      {"own_id_taken", [](const Draft& d) { d.foreign({{"kind", "node"}, {"node_id", 127}}); }},
      {"other_erases", [](const Draft& d) { order(d, "erase"); }},
      {"other_saves", [](const Draft& d) { order(d, "save"); }},
      {"other_restarts", [](const Draft& d) { order(d, "restart"); }},
      {"other_initializes", [](const Draft& d) { order(d, "initialize"); }},
      {"other_writes", [](const Draft& d) { writes(d, false); }},
      {"other_repeats", [](const Draft& d) { writes(d, true); }},
      {"one_unique_id",
       [](const Draft& d) {
         const auto id = d.chance.one_of<std::string>(
             {std::string(32, 'a'), std::string(32, '0'), std::string(32, 'f')});
         json& servos = d.episode.scenario["servos"];
         for (std::size_t i = 0; i < std::min<std::size_t>(2, servos.size()); ++i) {
           servos[i]["unique_id"] = id;
         }
       }},
      {"one_node_id",
       [](const Draft& d) {
         json& servos = d.episode.scenario["servos"];
         servos.back()["node_id"] = servos.front()["node_id"];
       }},
      {"node_on_id",
       [](const Draft& d) { d.foreign({{"kind", "node"}, {"node_id", d.some_node()}}); }},
      {"ram_unlike_rom",
       [](const Draft& d) {
         json& servo = d.some_servo();
         servo["rom"].update({{"speed_torque_control", "on"}, {"angle_limit_cw", "30deg"}});
         servo["ram"].update({{"speed_torque_control", "off"}, {"angle_limit_cw", "100deg"}});
         servo["faults"]["restart_after_answer"] = restarts(d.chance);
       }},
  };
  return all;
}

/// How many kinds of faults: none, one alone, a few, or many.
std::size_t density(Chance& chance, std::size_t kinds) {
  const auto draw = chance.whole(0, 99);
  if (draw < 15) {
    return 0;
  }
  if (draw < 50) {
    return 1;
  }
  return static_cast<std::size_t>(
      draw < 85 ? chance.whole(2, 3) : chance.whole(4, static_cast<std::int64_t>(kinds) / 3));
}

json make_servos(Chance& chance) {
  json servos = json::array();
  const auto count = static_cast<std::size_t>(chance.one_of<std::int64_t>({1, 1, 2, 3, 4}));
  std::vector<std::int64_t> ids;
  for (std::int64_t id = 10; id < 60; ++id) {
    ids.push_back(id);
  }
  for (std::int64_t id = 120; id <= 125; ++id) { // where dynamic IDs and temporary ones begin
    ids.push_back(id);
  }
  ids = chance.some_of(ids, count);
  for (std::size_t i = 0; i < count; ++i) {
    json servo{{"model", chance.one_of(models)},
               {"node_id", ids[i]},
               {"serial_number", first_serial + static_cast<std::int64_t>(i)},
               {"servo_id", i + 1}};
    if (chance.comes(0.5)) {
      servo["behaviour"]["first_node_status"] =
          chance.one_of<std::string>({"50ms", "300ms", "700ms", "1s"});
    }
    servos.push_back(std::move(servo));
  }
  return servos;
}

// Commands.

class Commands {
 public:
  Commands(const json& scenario, Chance& chance) : servos_(scenario["servos"]), chance_(chance) {}

  [[nodiscard]] std::vector<Command> draw() {
    std::vector<Command> steps;
    for (std::int64_t i = chance_.whole(1, 4); i > 0; --i) {
      steps.push_back(one());
      if (chance_.comes(0.25)) {
        steps.push_back(once_more(steps.back()));
      }
    }
    return steps;
  }

 private:
  [[nodiscard]] const json& some_servo() {
    return servos_[static_cast<std::size_t>(
        chance_.whole(0, static_cast<std::int64_t>(servos_.size()) - 1))];
  }

  [[nodiscard]] std::string serial() {
    return std::to_string(some_servo()["serial_number"].get<std::int64_t>());
  }

  [[nodiscard]] std::string target() {
    const auto draw = chance_.whole(0, 2);
    return draw == 0   ? "all"
           : draw == 1 ? "serial:" + serial()
                       : std::to_string(some_servo()["node_id"].get<std::int64_t>());
  }

  [[nodiscard]] std::string setting() {
    auto it = settings().begin();
    std::advance(it, chance_.whole(0, static_cast<std::int64_t>(settings().size()) - 1));
    auto value = it->second.values.begin();
    std::advance(value, chance_.whole(0, static_cast<std::int64_t>(it->second.values.size()) - 1));
    return it->first + "=" + value->first;
  }

  /// A value at a limit of the tables, or the first beyond it.
  [[nodiscard]] std::string at_limit(const std::string& model) {
    const auto& known = limits().of(model);
    auto it = known.begin();
    std::advance(it, chance_.whole(0, static_cast<std::int64_t>(known.size()) - 1));
    const std::int64_t min = it->second.min, max = it->second.max;
    return fmt::format("{:#04x}={}", it->first,
                       chance_.one_of<std::int64_t>({min, max, min - 1, max + 1}));
  }

  [[nodiscard]] Command one() {
    const auto draw = chance_.whole(0, 99);
    if (draw < 28) {
      return set();
    }
    if (draw < 37) {
      return plain("save");
    }
    if (draw < 45) {
      return erase();
    }
    if (draw < 53) {
      return plain("restart");
    }
    if (draw < 58) {
      return {.words = {"get", "-n", target(), "--all"}, .is_right = true};
    }
    if (draw < 77) {
      return apply();
    }
    if (draw < 85) {
      return undo();
    }
    if (draw < 93) {
      return alloc();
    }
    return {.words =
                chance_.one_of<std::vector<std::string>>({{"doctor"},
                                                          {"faults", "-n", "all"},
                                                          {"export", "all.json", "-y"},
                                                          {"characterize", "-n", target(), "-y"}})};
  }

  /// As it was, or what was in RAM alone is to be saved, or only looked at.
  [[nodiscard]] Command once_more(Command command) {
    if (command.verb() == "set" && !command.has("--save") && chance_.comes(0.5)) {
      command.words.emplace_back("--save");
    }
    if (command.verb() == "apply" && chance_.comes(0.5)) {
      std::erase(command.words, "--no-save");
      if (chance_.comes(0.3) && !command.has("--dry-run")) {
        command.words.emplace_back("--dry-run");
        command.is_right = false; // 8
      }
    }
    return command;
  }

  [[nodiscard]] Command set() {
    const json& servo = some_servo();
    Command command{.words = {"set", "-n", target(), "-y"}, .is_right = true};
    std::set<std::string> named;
    for (std::int64_t i = chance_.whole(1, 4); i > 0; --i) {
      const std::string assignment = setting();
      if (named.insert(assignment.substr(0, assignment.find('='))).second) {
        command.words.push_back(assignment);
      }
    }
    if (chance_.comes(0.15)) { // of one model: others may not have it, or it does not fit the rest
      command = {.words = {"set", "-n",
                           fmt::format("serial:{}", servo["serial_number"].get<std::int64_t>()),
                           "-y", at_limit(servo["model"])}};
      if (chance_.comes(0.1)) { // both at the value that both may have
        command.words.back() = "0x3E=20";
        command.words.emplace_back("0x3F=20");
      }
    }
    if (chance_.comes(0.1)) {
      command.words.push_back("servo_id=" +
                              std::to_string(chance_.one_of<std::int64_t>({1, 2, 101, 102})));
      command.is_right = false;
    }
    if (chance_.comes(0.1)) {
      const std::int64_t held = some_servo()["node_id"];
      command.words.push_back("static_node_id=" + std::to_string(chance_.comes(0.3) && held != 0
                                                                     ? held
                                                                     : chance_.whole(61, 64)));
      command.is_right = false;
    }
    add(command, "--save", 0.5);
    add(command, "--stagger", 0.1, "0.5");
    add(command, "--overwrite-rom", 0.05);
    return command;
  }

  [[nodiscard]] Command plain(const char* verb) {
    Command command{.words = {verb, "-n", target(), "-y"}, .is_right = true};
    add(command, "--stagger", 0.2, "0.5");
    if (command.verb() == "save") {
      add(command, "--overwrite-rom", 0.05);
    }
    return command;
  }

  [[nodiscard]] Command erase() {
    Command command{.words = {"erase", "-n", target(), "-y"}};
    add(command, "--save", 0.6);
    add(command, "--keep-ids", 0.5);
    command.is_right = command.has("--keep-ids");
    return command;
  }

  [[nodiscard]] Command undo() {
    Command command{.words = {"undo", "-y"}};
    add(command, "-n", 0.3, "all");
    add(command, "--no-save", 0.2);
    return command;
  }

  [[nodiscard]] Command alloc() {
    if (chance_.comes(0.4)) {
      return {.words = {"alloc", "--once"}};
    }
    if (chance_.comes(0.3)) {
      return {.words = {"alloc", "--list"}};
    }
    return {.words = {"alloc", "--static", "-n", "serial:" + serial(), "--id",
                      std::to_string(chance_.whole(61, 64)), "-y"}};
  }

  /// Their IDs as they are, exchanged in a circle, or new.
  [[nodiscard]] Command apply() {
    const auto all = static_cast<std::int64_t>(servos_.size());
    std::vector<std::size_t> chosen;
    for (std::int64_t i = 0; i < all; ++i) {
      chosen.push_back(static_cast<std::size_t>(i));
    }
    chosen = chance_.some_of(chosen, static_cast<std::size_t>(chance_.whole(1, all)));
    const auto ids = chance_.whole(0, 3);
    json entries = json::array();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      entries.push_back({{"name", fmt::format("servo {}", i)},
                         {"match", {{"serial_number", servos_[chosen[i]]["serial_number"]}}},
                         {"set", wished()}});
      if (ids == 1) {
        entries.back()["set"]["static_node_id"] =
            servos_[chosen[(i + 1) % chosen.size()]]["node_id"];
      } else if (ids == 2) {
        entries.back()["set"]["static_node_id"] = 64 + i;
      }
    }
    Command command{.words = {"apply", "fleet.json", "-y"},
                    .fleet = {{"schema", "blactl-fleet/1"}, {"servos", entries}},
                    .is_right = ids == 0 || ids == 3};
    add(command, "--no-save", 0.25);
    add(command, "--trust-ram", 0.15);
    add(command, "--stagger", 0.1, "0.5");
    if (chance_.comes(0.1)) {
      command.words.emplace_back("--dry-run");
      command.is_right = false; // 8
    }
    return command;
  }

  [[nodiscard]] json wished() {
    json wished = json::object();
    for (std::int64_t count = chance_.whole(1, 4); count > 0; --count) {
      const std::string assignment = setting();
      const auto equals = assignment.find('=');
      wished[assignment.substr(0, equals)] = assignment.substr(equals + 1);
    }
    return wished;
  }

  void add(Command& command, const char* option, double probability, const char* value = nullptr) {
    if (chance_.comes(probability)) {
      command.words.emplace_back(option);
      if (value != nullptr) {
        command.words.emplace_back(value);
      }
    }
  }

  const json& servos_;
  Chance& chance_;
};

/// Beside servos that ask, another may be where the first of them would go.
void take_first_dynamic_id(json& servos, Chance& chance) {
  const auto has_id = [](const json& servo) { return servo["node_id"] != 0; };
  const auto found = std::ranges::find_if(servos, has_id);
  if (found != servos.end() && !std::ranges::all_of(servos, has_id) && chance.comes(0.3) &&
      std::ranges::none_of(servos, [](const json& servo) { return servo["node_id"] == 125; })) {
    (*found)["node_id"] = 125;
  }
}

/// Now and then the allocator has fewer node IDs to give than there are units that ask.
void narrow(Episode& episode) {
  Chance chance(episode.seed, "range");
  if (!chance.comes(0.3)) {
    return;
  }
  const auto first = chance.whole(60, 63);
  const std::string range = fmt::format("{}-{}", first, first + chance.whole(0, 1));
  for (Command& command : episode.steps) {
    if (command.verb() == "alloc" && command.has("--once")) {
      command.words.insert(command.words.end(), {"--range", range});
    }
  }
}

/// What no client can tell apart, whatever it asks, is left out.
void spare_the_undecidable(Episode& episode) {
  const auto has_any_of = [&](std::initializer_list<const char*> kinds) {
    return std::ranges::any_of(kinds, [&](const char* kind) { return episode.has(kind); });
  };
  const bool loses_frames = has_any_of({"loss", "bursts", "errors", "bit_flips", "cut", "bus_off",
                                        "late_answers", "jitter", "duplication"});
  // One that writes ROM and does not restart, and whose answer is lost, and one that heard nothing.
  if (loses_frames || has_any_of({"lose_opcode_answers", "lose_responses", "double_answers",
                                  "strange_answers", "slow_rom"})) {
    episode.faults.erase("stays");
  }
  // One of two under a node ID whose answers are lost, and one that is alone.
  if (has_any_of({"one_node_id", "node_on_id"})) {
    for (const auto* silence : {"mute", "lose_responses", "never_returns", "no_node_status"}) {
      episode.faults.erase(silence);
    }
  }
}

} // namespace

std::vector<std::string> fault_kinds() {
  std::vector<std::string> kinds;
  for (const auto& [kind, plant] : plants()) {
    kinds.push_back(kind);
  }
  return kinds;
}

void plant(Episode& episode, const std::string& kind, Chance& chance) {
  episode.faults.insert(kind);
  plants().at(kind)({episode, chance});
}

bool has_liar(const Episode& episode) {
  return episode.seed % 100 == 0;
}

Episode make_episode(std::uint64_t seed) {
  Episode episode{.seed = seed, .scenario = {}, .steps = {}, .faults = {}};
  Chance servos(seed, "servos");
  episode.scenario = {{"schema", "blactl-scenario/1"},
                      {"clock", "virtual"},
                      {"seed", seed},
                      {"servos", make_servos(servos)}};
  Chance commands(seed, "commands");
  episode.steps = Commands(episode.scenario, commands).draw();
  Chance asking(seed, "asking");
  if (asking.comes(0.15)) {
    for (json& servo : episode.scenario["servos"]) {
      if (asking.comes(0.6)) {
        servo["node_id"] = 0;
      }
    }
    take_first_dynamic_id(episode.scenario["servos"], asking);
    episode.steps.insert(episode.steps.begin(), {.words = {"alloc", "--once"}});
    narrow(episode);
  }
  if (has_liar(episode)) {
    episode.steps.push_back(
        {.words = {"set", "-n", "all", "timeout_time=500ms", "-y"}, .is_right = true});
    return episode;
  }
  Chance faults(seed, "faults");
  const auto kinds = fault_kinds();
  for (const std::string& kind : faults.some_of(kinds, density(faults, kinds.size()))) {
    episode.faults.insert(kind);
  }
  spare_the_undecidable(episode);
  for (const std::string& kind : std::set(episode.faults)) {
    Chance own(seed, kind);
    plant(episode, kind, own);
  }
  return episode;
}

bool is_harmless(const Episode& episode) {
  static const std::set<std::string> harmless{
      "babbler",        "double_answers", "duplication",         "errors",
      "ignore_opcodes", "jitter",         "lose_opcode_answers", "no_node_status",
      "other_nodes",    "slow_rom",       "strange_answers"};
  const bool are_few = std::ranges::none_of(episode.scenario["servos"], [](const json& servo) {
    return servo.contains("faults") && servo["faults"].value("ignore_opcodes", 0) > 1;
  });
  return are_few && std::ranges::includes(harmless, episode.faults);
}

bool is_aimed(const Episode& episode) {
  const json& scenario = episode.scenario;
  return Chance(episode.seed, "is aimed").comes(0.4) &&
         (scenario.contains("events") || scenario.contains("foreign"));
}

Episode calmed(Episode episode) {
  episode.faults.clear();
  for (const char* key : {"events", "wire", "foreign"}) {
    episode.scenario.erase(key);
  }
  for (json& servo : episode.scenario["servos"]) {
    servo.erase("faults");
    servo.erase("sending");
  }
  return episode;
}

void aim(Episode& episode, const std::vector<Time>& moments) {
  if (moments.empty()) {
    return;
  }
  Chance chance(episode.seed, "aim");
  const auto in_ms = [](Duration time) {
    return std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
  };
  const auto moment = [&] { return in_ms(chance.one_of(moments) - Time{}) + chance.whole(-5, 20); };
  if (episode.scenario.contains("events")) { // what belongs together stays so far apart
    json& events = episode.scenario["events"];
    const auto one =
        static_cast<std::size_t>(chance.whole(0, static_cast<std::int64_t>(events.size()) - 1));
    const std::int64_t shift = moment() - in_ms(time_in(events[one]["at"]));
    for (json& event : events) {
      event["at"] = ms(std::max<std::int64_t>(0, in_ms(time_in(event["at"])) + shift));
    }
  }
  if (episode.scenario.contains("foreign")) {
    for (json& node : episode.scenario["foreign"]) {
      if (node.contains("begins")) {
        node["begins"] = ms(std::max<std::int64_t>(0, moment()));
      } else if (node.contains("orders") && node["orders"].size() == 1) {
        node["orders"][0]["at"] = ms(std::max<std::int64_t>(0, moment()));
      }
    }
  }
}

json frozen(const Episode& episode) {
  json steps = json::array();
  for (const Command& command : episode.steps) {
    json one{{"words", command.words}};
    if (!command.fleet.is_null()) {
      one["fleet"] = command.fleet;
    }
    steps.push_back(json::array({one}));
  }
  return {{"scenario", episode.scenario}, {"steps", steps}};
}

} // namespace blactl::campaign
