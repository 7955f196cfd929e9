// The servos and commands of the sweep.

#include "campaign.hpp"
#include "limits.hpp"
#include "sweep.hpp"

#include <fmt/format.h>

#include <utility>

namespace blactl::campaign {

using nlohmann::json;

namespace {

Command words(std::vector<std::string> all) {
  return {.words = std::move(all), .is_right = true};
}

Command apply(const json& first, const json& second, std::vector<std::string> more = {}) {
  json entries = json::array();
  entries.push_back({{"name", "a"}, {"match", {{"serial_number", 240900001}}}, {"set", first}});
  entries.push_back({{"name", "b"}, {"match", {{"serial_number", 240900002}}}, {"set", second}});
  Command command = words({"apply", "fleet.json", "-y"});
  command.words.insert(command.words.end(), more.begin(), more.end());
  command.fleet = {{"schema", "blactl-fleet/1"}, {"servos", entries}};
  return command;
}

/// In place of one that is not there.
Command replace(const json& settings) {
  Command command = words({"replace", "fleet.json", "b", "-y"});
  command.fleet = {
      {"schema", "blactl-fleet/1"},
      {"servos", {{{"name", "b"}, {"match", {{"serial_number", 240900001}}}, {"set", settings}}}}};
  command.broken = 240900099;
  return command;
}

/// Every value just outside of the limits of each register, and IDs that others have: 30 is another
/// node's.
std::vector<Command> harmful(const Episode& episode) {
  std::vector<Command> all{
      words({"set", "-n", "11", "servo_id=2", "-y"}),
      words({"set", "-n", "11", "static_node_id=12", "-y"}),
      words({"set", "-n", "11", "static_node_id=12", "--save", "-y"}),
      words({"set", "-n", "11", "servo_id=2", "--save", "-y"}),
      words({"set", "-n", "11", "0x3E=20", "0x3F=20", "-y"}),
      words({"alloc", "--static", "-n", "11", "--id", "12", "-y"}),
      words({"set", "-n", "11", "static_node_id=30", "-y"}),
      words({"set", "-n", "11", "static_node_id=30", "--save", "-y"}),
      words({"alloc", "--static", "-n", "11", "--id", "30", "-y"}),
      words({"apply", "fleet.json", "-y"}),
  };
  all.back().fleet = apply({{"servo_id", 2}}, {{"smoothing", "off"}}).fleet;
  for (const json& servo : episode.scenario["servos"]) {
    for (const auto& [address, limit] : limits().of(servo["model"])) {
      for (const std::int64_t value : {limit.min - 1, limit.max + 1}) {
        all.push_back(words({"set", "-n", std::to_string(servo["node_id"].get<int>()),
                             fmt::format("{:#04x}={}raw", address, value), "-y"}));
      }
    }
    all.push_back(words({"set", "-n", std::to_string(servo["node_id"].get<int>()), "0x34=1500raw",
                         "0x35=400raw", "-y"}));
  }
  return all;
}

} // namespace

/// Servos with these node IDs, and nothing that goes wrong.
Episode Sweep::episode_of(const std::vector<int>& node_ids) {
  json servos = json::array();
  const std::vector<std::string> models{"BLA21-12U-AB", "BLA15-06U-A0", "BLA34-28U-AB"};
  for (std::size_t i = 0; i < node_ids.size(); ++i) {
    servos.push_back({{"model", models[i]},
                      {"node_id", node_ids[i]},
                      {"serial_number", 240900001 + i},
                      {"servo_id", i + 1}});
  }
  return {.seed = 0,
          .scenario = {{"schema", "blactl-scenario/1"},
                       {"clock", "virtual"},
                       {"seed", 1},
                       {"servos", servos}},
          .steps = {},
          .faults = {}};
}

Episode Sweep::episode_of(const Case& one) {
  Episode episode = episode_of(one.node_ids);
  episode.scenario["servos"].front().update(one.first);
  if (!one.orders.empty()) {
    episode.scenario["foreign"] = {{{"kind", "node"}, {"node_id", 90}, {"orders", one.orders}}};
  }
  return episode;
}

std::vector<Sweep::Case> Sweep::cases() {
  const Command in_ram = words({"set", "-n", "all", "smoothing=off", "timeout_time=500ms", "-y"});
  const Command saved = words({"set", "-n", "11,12", "reverse=on", "--save", "-y"});
  // enough writes to each servo that something can happen between two of them
  const auto ten_to = [](const char* servos) {
    return words({"set", "-n", servos, "smoothing=off", "soft_start=off", "timeout_time=500ms",
                  "angle_p_gain=30", "angle_d_gain=20", "speed_p_gain=20", "speed_i_gain=2",
                  "speed_dead_band=100", "angle_limit_cw=90deg", "temperature_limit_high=70degC",
                  "-y"});
  };
  const Command many = ten_to("11,12");
  return {
      {.name = "set", .before = {}, .command = many, .is_undoable = true, .is_written_again = true},
      {.name = "set of a limit",
       .before = {},
       .command = words({"set", "-n", "11", "smoothing=off", "soft_start=off", "angle_p_gain=30",
                         "angle_d_gain=20", "speed_p_gain=20", "speed_i_gain=2",
                         "temperature_limit_high=20degC", "-y"}),
       .is_undoable = true,
       .ended_by = "other writes what it was judged by"},
      {.name = "set, one servo done before the other",
       .before = {words({"set", "-n", "11", "soft_start=off", "timeout_time=500ms",
                         "angle_p_gain=30", "angle_d_gain=20", "speed_p_gain=20", "speed_i_gain=2",
                         "speed_dead_band=100", "temperature_limit_high=70degC", "-y"})},
       .command = many},
      {.name = "set, one servo as wished in RAM", .before = {ten_to("11")}, .command = many},
      {.name = "apply --trust-ram, one servo as wished in RAM",
       .before = {words({"set", "-n", "11", "smoothing=off", "-y"})},
       .command = apply({{"smoothing", "off"}}, {{"angle_limit_cw", "90deg"}}, {"--trust-ram"}),
       .is_repeatable = false},
      {.name = "set --save, the first SAVE unheeded",
       .before = {},
       .command = saved,
       .is_undoable = true,
       .first = {{"faults", {{"ignore_opcodes", 1}}}}},
      {.name = "set --save, answers late",
       .before = {},
       .command = saved,
       .is_undoable = true,
       .first = {{"sending", {{"late_answers", 0.3}, {"late_by", "300ms"}}}}},
      {.name = "set --save", .before = {}, .command = saved, .is_undoable = true},
      {.name = "set --save of a trial",
       .before = {words({"set", "-n", "11", "reverse=on", "-y"})},
       .command = saved,
       .is_undoable = true},
      {.name = "set --save of the second trial",
       .before = {words({"set", "-n", "11", "timeout_time=1500ms", "-y"}),
                  words({"set", "-n", "11", "timeout_time=2s", "-y"})},
       .command = words({"set", "-n", "11,12", "timeout_time=500ms", "--save", "-y"}),
       .is_undoable = true},
      {.name = "set servo_id",
       .before = {},
       .command = words({"set", "-n", "12", "servo_id=7", "-y"}),
       .is_undoable = true,
       .ended_by = "other gives servo ID 7"},
      {.name = "set static_node_id --save",
       .before = {},
       .command = words({"set", "-n", "serial:240900001", "static_node_id=30", "--save", "-y"}),
       .is_undoable = true,
       .ended_by = "node comes to 30"},
      {.name = "set --save of the factory's value, a servo without IDs",
       .before = {words({"alloc", "--once"}),
                  words({"set", "-n", "serial:240900001", "reverse=on", "--save", "-y"})},
       .command = words({"set", "-n", "serial:240900001", "reverse=off", "--save", "-y"}),
       .is_repeatable = false, // it may wait for a node ID then
       .node_ids = {0, 12, 13},
       .first = {{"servo_id", 0}}},
      {.name = "set beside a trial",
       .before = {words({"set", "-n", "11", "smoothing=off", "-y"})},
       .command = in_ram},
      {.name = "set --save, just restarted",
       .before = {words({"restart", "-n", "all", "-y"})},
       .command = saved,
       .is_undoable = true},
      {.name = "set --save, just restarted, the first SAVE unheeded",
       .before = {words({"restart", "-n", "12", "-y"})},
       .command = saved,
       .is_undoable = true,
       .first = {{"faults", {{"ignore_opcodes", 1}}}}},
      {.name = "save", .before = {in_ram}, .command = words({"save", "-n", "all", "-y"})},
      {.name = "erase --save",
       .before = {saved},
       .command = words({"erase", "-n", "11,12", "--save", "--keep-ids", "-y"}),
       .is_undoable = true},
      {.name = "erase --keep-ids",
       .before = {saved},
       .command = words({"erase", "-n", "11,12", "--keep-ids", "-y"}),
       .is_undoable = true},
      {.name = "erase, the first ERASE unheeded",
       .before = {in_ram},
       .command = words({"erase", "-n", "11,12", "-y"}),
       .is_repeatable = false,
       .first = {{"faults", {{"ignore_opcodes", 1}}}}},
      {.name = "erase --keep-ids of a trial",
       .before = {in_ram},
       .command = words({"erase", "-n", "11,12", "--keep-ids", "-y"})},
      {.name = "erase --save, IDs too",
       .before = {saved},
       .command = words({"erase", "-n", "11,12", "--save", "-y"}),
       .is_repeatable = false,
       .is_undoable = true},
      {.name = "restart", .before = {}, .command = words({"restart", "-n", "all", "-y"})},
      {.name = "pwm-config --save",
       .before = {},
       .command = words({"pwm-config", "-n", "11", "--neutral", "1500us", "--save", "-y"}),
       .is_undoable = true},
      {.name = "apply",
       .before = {},
       .command = apply({{"smoothing", "off"}}, {{"angle_limit_cw", "90deg"}}),
       .is_undoable = true},
      {.name = "apply, IDs exchanged",
       .before = {},
       .command = apply({{"static_node_id", 12}, {"smoothing", "off"}},
                        {{"static_node_id", 11}, {"reverse", "on"}}),
       .is_undoable = true},
      {.name = "apply --no-save",
       .before = {},
       .command = apply({{"smoothing", "off"}}, {{"reverse", "on"}}, {"--no-save"}),
       .is_undoable = true},
      {.name = "alloc --static",
       .before = {},
       .command = words({"alloc", "--static", "-n", "serial:240900001", "--id", "30", "-y"}),
       .is_undoable = true,
       .ended_by = "node comes to 30"},
      {.name = "apply, saved otherwise since",
       .before = {apply({{"smoothing", "off"}}, {{"reverse", "on"}}),
                  words({"scan", "--listen", "30"})},
       .command = apply({{"smoothing", "off"}}, {{"reverse", "on"}}),
       .orders =
           {{{"at", "25s"}, {"to", 11}, {"order", "write"}, {"address", 0x22}, {"value", 1}},
            {{"at", "26s"}, {"to", 11}, {"order", "save"}},
            {{"at", "30s"}, {"to", 11}, {"order", "write"}, {"address", 0x22}, {"value", 0}}}},
      {.name = "replace",
       .before = {},
       .command = replace({{"smoothing", "off"}, {"0x46", "30raw"}, {"0x45", "7raw"}}),
       .is_undoable = true,
       .node_ids = {11}},
      {.name = "replace by one that waits for a node ID",
       .before = {},
       .command = replace({{"reverse", "on"}, {"0x46", "30raw"}}),
       .node_ids = {0},
       .first = {{"servo_id", 0}}},
      {.name = "apply --dry-run of a trial",
       .before = {words({"set", "-n", "11", "smoothing=off", "-y"})},
       .command = apply({{"smoothing", "off"}}, {{"servo_id", 2}}, {"--dry-run"}),
       .is_repeatable = false},
      {.name = "get",
       .before = {many},
       .command = words({"get", "-n", "all", "--all"}),
       .is_repeatable = false},
      {.name = "export",
       .before = {many},
       .command = words({"export", "all.json", "-n", "all", "-y"}),
       .is_repeatable = false},
      {.name = "undo",
       .before = {saved},
       .command = words({"undo", "-y"}),
       .is_repeatable = false,
       .takes_back = true},
      {.name = "undo of what another tool has saved since",
       .before = {in_ram, words({"trace", "--duration", "30"})},
       .command = words({"undo", "-y"}),
       .is_repeatable = false,
       .takes_back = true,
       .orders = {{{"at", "25s"}, {"to", 11}, {"order", "save"}}}},
      {.name = "alloc --once",
       .before = {},
       .command = words({"alloc", "--once"}),
       .is_repeatable = false,
       .node_ids = {0, 0, 13}},
      {.name = "monitor --identify",
       .before = {},
       .command = words({"monitor", "--identify", "-n", "11", "--duration", "2", "-y"}),
       .is_repeatable = false},
      {.name = "characterize",
       .before = {},
       .command = words({"characterize", "-n", "11", "-y"}),
       .is_repeatable = false},
      {.name = "command",
       .before = {},
       .command = words({"command", "angle=20deg", "-n", "11", "-y"}),
       .is_repeatable = false},
  };
}

/// Nothing goes wrong, but each command would do harm.
std::vector<Sweep::Refused> Sweep::refused() {
  Episode usual = episode_of({11, 12, 13});
  usual.scenario["foreign"] = {{{"kind", "node"}, {"node_id", 30}}};
  Episode one_number = episode_of({11, 12, 13});
  one_number.scenario["servos"][1]["serial_number"] = 240900001;
  one_number.scenario["servos"][1]["unique_id"] = "00112233445566778899aabbccddeeff";
  const auto runs = [](const char* command) {
    return words({"set", "-n", "11", "speed_torque_control=on", command, "-y"});
  };
  const Command hold = words({"set", "-n", "11", "timeout_action=hold", "-y"});
  Command apply_unasked = apply({{"reverse", "on"}}, json::object());
  std::erase(apply_unasked.words, "-y");
  Command of_another_model = replace({{"smoothing", "off"}});
  of_another_model.fleet["servos"][0]["about"] = {{"model", "BLA34-28U-AB"}};
  constexpr int usage = 2, not_confirmed = 7;
  return {{.episode = usual, .commands = harmful(usual)},
          {.episode = usual,
           .commands = {words({"set", "-n", "11", "torque_output=off"}),
                        words({"set", "-n", "11", "reverse=on"}),
                        words({"set", "-n", "11", "speed_torque_control=on"}),
                        words({"set", "-n", "11", "smoothing=off", "--save"}),
                        words({"set", "-n", "11", "static_node_id=40", "--save"}),
                        words({"save", "-n", "11"}), words({"restart", "-n", "11"}),
                        words({"erase", "-n", "11"}), words({"erase", "-n", "11", "--save"}),
                        words({"alloc", "--static", "-n", "11", "--id", "40"}),
                        words({"command", "angle=20deg", "-n", "11"}),
                        words({"monitor", "--identify", "-n", "11", "--duration", "1"}),
                        words({"characterize", "-n", "11"}), apply_unasked},
           .status = not_confirmed},
          {.episode = usual, // ignored while speed/torque control is off
           .commands = {words({"set", "-n", "11", "command_speed=10rpm", "-y"}),
                        words({"set", "-n", "11", "command_torque=10%", "-y"}),
                        words({"command", "speed=10rpm", "-n", "11", "-y"})}},
          {.episode = usual, .before = {runs("command_torque=10%")}, .commands = {hold}},
          {.episode = usual, .before = {runs("command_speed=10rpm")}, .commands = {hold}},
          {.episode = one_number,
           .commands = {words({"set", "-n", "serial:240900001", "smoothing=off", "-y"}),
                        words({"restart", "-n", "serial:240900001", "-y"}),
                        words({"alloc", "--static", "-n", "serial:240900001", "--id", "40", "-y"}),
                        apply({{"smoothing", "off"}}, json::object())},
           .are_told_apart = false,
           .status = usage},
          {.episode = episode_of({11}), .commands = {of_another_model}}};
}

/// Each way to say which servos are meant.
std::vector<Sweep::Meant> Sweep::selections() {
  constexpr std::int64_t first = 240900001, second = 240900002, third = 240900003;
  return {{"11", {first}},
          {"11,13", {first, third}},
          {"12-13", {second, third}},
          {"10-12,13", {}}, // nobody is at 10
          {"all", {first, second, third}},
          {"serial:240900002", {second}},
          {"serial_number:240900002,servo:3", {second, third}},
          {"servo_id:1", {first}},
          {"model:BLA15", {second}},
          {"model:bla21-12u-ab", {first}},
          {"MODEL:BLA", {first, second, third}},
          {"uid:88ac", {first}},
          {"unique_id:9edc8f5a340e14249f728768bb2a85fe,11", {first, second}},
          {"servo:9", {}},
          {"serial:2409", {}},
          {"model:BLA99", {}}};
}

} // namespace blactl::campaign
