#include "sweep.hpp"

#include "campaign.hpp"
#include "judge.hpp"

#include <fmt/format.h>

#include <chrono>
#include <exception>

namespace blactl::campaign {

using nlohmann::json;
using namespace std::chrono_literals;
using Kind = Disturbance::Kind;

/// A command, what was done before it, and whether the same memories follow from it whenever it
/// is repeated.
struct Sweep::Case {
  std::string name;
  std::vector<Command> before;
  Command command;
  bool is_repeatable = true;
  std::vector<int> node_ids{11, 12, 13};
};

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

Episode episode_of(const std::vector<int>& node_ids) {
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

/// What stays: settings, and who has which node ID.
bool are_same(const States& one, const States& other) {
  for (const auto& [serial, state] : one) {
    const ServoState& second = other.at(serial);
    if (state.rom != second.rom || state.node_id != second.node_id) {
      return false;
    }
    for (const auto& [address, value] : state.rom) {
      if (state.ram.at(address) != second.ram.at(address)) {
        return false;
      }
    }
  }
  return true;
}

constexpr Kind kinds[]{Kind::request_lost,   Kind::killed,          Kind::frame_lost,
                       Kind::frame_doubled,  Kind::frame_corrupted, Kind::frame_late,
                       Kind::frame_of_other, Kind::call_failed};

} // namespace

std::vector<Sweep::Case> Sweep::cases() {
  const Command in_ram = words({"set", "-n", "all", "smoothing=off", "timeout_time=500ms", "-y"});
  const Command saved = words({"set", "-n", "11,12", "reverse=on", "--save", "-y"});
  return {
      {.name = "set", .before = {}, .command = in_ram},
      {.name = "set --save", .before = {}, .command = saved},
      {.name = "set static_node_id --save",
       .before = {},
       .command = words({"set", "-n", "serial:240900001", "static_node_id=30", "--save", "-y"})},
      {.name = "save", .before = {in_ram}, .command = words({"save", "-n", "all", "-y"})},
      {.name = "erase --save",
       .before = {saved},
       .command = words({"erase", "-n", "11,12", "--save", "--keep-ids", "-y"})},
      {.name = "restart", .before = {}, .command = words({"restart", "-n", "all", "-y"})},
      {.name = "pwm-config --save",
       .before = {},
       .command = words({"pwm-config", "-n", "11", "--neutral", "1500us", "--save", "-y"})},
      {.name = "apply",
       .before = {},
       .command = apply({{"smoothing", "off"}}, {{"angle_limit_cw", "90deg"}})},
      {.name = "apply, IDs exchanged",
       .before = {},
       .command = apply({{"static_node_id", 12}, {"smoothing", "off"}},
                        {{"static_node_id", 11}, {"reverse", "on"}})},
      {.name = "apply --no-save",
       .before = {},
       .command = apply({{"smoothing", "off"}}, {{"reverse", "on"}}, {"--no-save"})},
      {.name = "alloc --static",
       .before = {},
       .command = words({"alloc", "--static", "-n", "serial:240900001", "--id", "30", "-y"})},
      {.name = "undo", .before = {saved}, .command = words({"undo", "-y"}), .is_repeatable = false},
      {.name = "alloc --once",
       .before = {},
       .command = words({"alloc", "--once"}),
       .is_repeatable = false,
       .node_ids = {0, 0, 13}},
      {.name = "monitor --identify",
       .before = {},
       .command = words({"monitor", "--identify", "-n", "11", "--duration", "2", "-y"}),
       .is_repeatable = false},
      {.name = "command",
       .before = {},
       .command = words({"command", "angle=20deg", "-n", "11", "-y"}),
       .is_repeatable = false},
  };
}

void Sweep::play(unsigned job, unsigned jobs) {
  unsigned turn = 0;
  for (const Case& one : cases()) {
    if (turn++ % jobs == job) {
      play(one);
    }
  }
}

void Sweep::play(const Case& one) {
  for (const Kind kind : kinds) {
    Disturbance counting{.kind = kind, .number = static_cast<std::size_t>(-1)};
    States goal;
    {
      const Folder folder(folder_);
      const Episode episode = episode_of(one.node_ids);
      World world(episode.scenario, folder_);
      for (const Command& command : one.before) {
        [[maybe_unused]] const Outcome done = world.run(command);
      }
      const Step step = take_step(world, episode, one.command, &counting);
      goal = step.after;
    }
    for (const bool lasts : {false, true}) {
      if (lasts && kind == Kind::killed) {
        continue;
      }
      Swept& swept =
          swept_[{one.name, fmt::format("{}{}", name(kind), lasts ? ", from then on" : "")}];
      swept.places = counting.seen;
      for (std::size_t number = 1; number <= counting.seen; number += step_) {
        disturb(one, {.kind = kind, .number = number, .lasts = lasts}, goal, swept);
      }
    }
  }
}

void Sweep::disturb(const Case& one, Disturbance disturbance, const States& goal, Swept& swept) {
  const Folder folder(folder_);
  const Episode episode = episode_of(one.node_ids);
  World world(episode.scenario, folder_);
  for (const Command& command : one.before) {
    [[maybe_unused]] const Outcome done = world.run(command);
  }
  [[maybe_unused]] const auto earlier = world.take_events();
  const std::string what = fmt::format("{} number {}{}", name(disturbance.kind), disturbance.number,
                                       disturbance.lasts ? " and all from then on" : "");
  const Step step = take_step(world, episode, one.command, &disturbance);
  swept.runs += 1;
  swept.good += step.outcome.status == 0 ? 1 : 0;
  const auto differ = [&](const Step& told, const std::string& why) {
    swept.lies += 1;
    tell_(fmt::format("{}: {}: {}\n  {}\n  exit status {}\n  {}\n{}", one.name, what, why,
                      told.command.text(), told.outcome.status, told.outcome.document.dump(),
                      told.outcome.err));
  };
  try {
    if (disturbance.kind != Kind::killed) {
      judge(step);
    }
    world.pass(4s);
    [[maybe_unused]] const auto late = world.take_events();
    if (!one.is_repeatable) {
      return;
    }
    const Step again = take_step(world, episode, one.command);
    judge(again);
    if (again.outcome.status != 0) {
      differ(again, "does not converge");
    } else if (!are_same(goal, again.after)) {
      differ(again, "the same command has another result");
    }
  } catch (const std::exception& lie) {
    differ(step, lie.what());
  }
}

} // namespace blactl::campaign
