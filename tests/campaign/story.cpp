#include "story.hpp"

#include <fmt/format.h>

#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <span>

namespace blactl::campaign {

using nlohmann::json;
using namespace std::chrono_literals;

using By = Act::By;

namespace {

/// Longer than a killed command may be thought to have written on.
constexpr Duration pause = 15s;

/// The first orders of some servos are neither carried out nor answered: the command fails there.
json scenario(Chance& chance) {
  json servos = json::array();
  for (std::size_t i = 0; i < story_servos.size(); ++i) {
    json servo{{"model", "BLA21-12U-AB"},
               {"node_id", 11 + i},
               {"serial_number", story_servos[i]},
               {"servo_id", i + 1}};
    if (chance.comes(0.3)) {
      servo["faults"] = {{"ignore_opcodes", chance.whole(1, 6)}};
    }
    servos.push_back(servo);
  }
  return {{"schema", "blactl-scenario/1"}, {"clock", "virtual"}, {"seed", 1}, {"servos", servos}};
}

std::string target(std::size_t servo) {
  return fmt::format("serial:{}", story_servos[servo]);
}

bool names(const Command& command, std::int64_t serial) {
  return command.fleet.is_null() ||
         std::ranges::any_of(command.fleet["servos"], [&](const json& entry) {
           return entry["match"]["serial_number"] == serial;
         });
}

bool names(const Command& command, std::int64_t serial, const std::string& setting) {
  return !command.fleet.is_null() &&
         std::ranges::any_of(command.fleet["servos"], [&](const json& entry) {
           return entry["match"]["serial_number"] == serial && entry["set"].contains(setting);
         });
}

std::string word_of(std::uint8_t address) {
  return fmt::format("{:#04x}", address);
}

} // namespace

bool Act::touches(std::int64_t serial) const {
  const ServoState &was = before.at(serial), &is = after.at(serial);
  return std::ranges::any_of(story_settings, [&](std::uint8_t address) {
    return was.ram.at(address) != is.ram.at(address) || was.rom.at(address) != is.rom.at(address);
  });
}

Story::Story(std::uint64_t seed, const std::filesystem::path& folder)
    : chance_(seed, "story"), world_(scenario(chance_), folder) {}

void Story::play() {
  is_erase_ = chance_.comes(0.1);
  if (chance_.comes(0.8)) {
    prove_rom();
  } else {
    unknown_.insert(story_servos.begin(), story_servos.end());
  }
  const auto tries = chance_.whole(1, 4);
  for (std::int64_t i = 0; i < tries; ++i) {
    happen_between();
    if (chance_.comes(0.15)) {
      happen_between();
    }
    try_once();
  }
  if (chance_.comes(0.1)) {
    cut_supply();
  }
  Command undo{.words = {"undo", "-y"}};
  names_first_ = chance_.comes(0.3);
  if (names_first_) {
    undo.words.insert(undo.words.end(), {"-n", target(0)});
  }
  act(By::other_command, undo);
  undo_ = acts_.back();
  acts_.pop_back();
}

/// Nothing is changed, and a restart shows what ROM holds.
void Story::prove_rom() {
  json entries = json::array();
  for (const std::int64_t serial : story_servos) {
    entries.push_back({{"name", std::to_string(serial)},
                       {"match", {{"serial_number", serial}}},
                       {"set", {{"smoothing", "on"}}}});
  }
  act(By::other_command, {.words = {"apply", "fleet.json", "-y"},
                          .fleet = {{"schema", "blactl-fleet/1"}, {"servos", entries}}});
}

void Story::try_once() {
  Command command = some_apply();
  if (is_erase_) {
    command = {.words = {"erase", "--keep-ids", "-n", "all", "-y"}};
    if (chance_.comes(0.5)) {
      command.words.emplace_back("--save");
    }
  } else if (command.fleet["servos"].empty()) {
    return;
  } else if (chance_.comes(0.2)) {
    command.words.emplace_back("--no-save");
  }
  named_last_.clear();
  for (const std::int64_t serial : story_servos) {
    if (names(command, serial)) {
      named_last_.insert(serial);
    }
  }
  act(By::tries, command, chance_.comes(0.5));
}

/// Of some settings of some servos. Their node IDs may be exchanged.
Command Story::some_apply() {
  json entries = json::array();
  const bool exchanges = chance_.comes(0.1);
  for (std::size_t i = 0; i < story_servos.size(); ++i) {
    json set = json::object();
    for (const std::uint8_t address : story_settings) {
      if (address != static_node_id && chance_.comes(0.5)) {
        set[word_of(address)] = some_value(By::tries, address, i);
      }
    }
    if (exchanges) {
      set["static_node_id"] = std::size_t{12} - i;
    } else if (chance_.comes(0.1)) {
      set["static_node_id"] = 21 + i;
    }
    if (!set.empty()) {
      entries.push_back({{"name", std::to_string(story_servos[i])},
                         {"match", {{"serial_number", story_servos[i]}}},
                         {"set", set}});
    }
  }
  return {.words = {"apply", "fleet.json", "-y"},
          .fleet = {{"schema", "blactl-fleet/1"}, {"servos", entries}}};
}

std::string Story::some_value(By by, std::uint8_t address, std::size_t servo) {
  const std::int64_t some = chance_.whole(1, 3) + (by == By::tries ? 0 : 3);
  return address == 0x38 ? fmt::format("{}raw", 300 + 100 * some)
         : address == static_node_id
             ? fmt::format("{}raw", 20 + 10 * some + static_cast<std::int64_t>(servo))
             : fmt::format("{}raw", 70 + some);
}

void Story::happen_between() {
  switch (chance_.whole(0, 7)) {
  case 0: cut_supply(); break;
  case 1:
  case 2: write_as_other(false); break;
  case 3: write_as_other(true); break;
  case 4:
    if (chance_.comes(0.3)) {
      act(By::other_command,
          {.words = {"set", "-n", target(0),
                     word_of(0x38) + "=" + some_value(By::other_command, 0x38, 0), "-y"}});
    }
    break;
  default: break;
  }
}

/// One setting of one servo.
void Story::write_as_other(bool saves) {
  const auto servo = static_cast<std::size_t>(chance_.comes(0.7) ? 0 : 1);
  const std::uint8_t address = story_settings[static_cast<std::size_t>(
      chance_.whole(0, saves ? 3 : 2))]; // an ID in RAM only is undone by no restart of ours
  Command command{.words = {"set", "-n", target(servo),
                            word_of(address) + "=" + some_value(By::other_user, address, servo),
                            "-y"}};
  if (saves) {
    command.words.emplace_back("--save");
  }
  act(By::other_user, command);
}

void Story::cut_supply() {
  Act cut{.by = By::supply, .text = "supply off and on", .before = world_.states()};
  world_.repair();
  world_.pass(pause);
  cut.after = world_.states();
  acts_.push_back(std::move(cut));
  unknown_.insert(story_servos.begin(), story_servos.end());
}

void Story::act(By by, const Command& command, bool may_be_killed) {
  constexpr std::int64_t first = 20, last = 260; // frames
  Disturbance kill{.kind = Disturbance::Kind::killed, .number = Disturbance::no_number};
  if (may_be_killed) {
    kill.number = static_cast<std::size_t>(chance_.whole(first, last));
  }
  Act one{.by = by,
          .text = command.text(),
          .saves = command.verb() == "erase" ? command.has("--save") : !command.has("--no-save"),
          .before = world_.states()};
  const Outcome outcome = run(by, command, kill);
  const bool was_killed = may_be_killed && kill.has_struck();
  one.status = was_killed ? -1 : outcome.status;
  world_.pass(pause);
  one.after = world_.states();
  const json entries = command.fleet.is_null() ? json::array() : command.fleet["servos"];
  for (const json& entry : entries) {
    one.text += fmt::format(" {} {}", entry["name"].get<std::string>(), entry["set"].dump());
  }
  one.text += was_killed ? fmt::format(", killed at frame {}", kill.number)
                         : fmt::format(": {}", outcome.status);
  note_what_is_known(one, command);
  acts_.push_back(std::move(one));
}

/// Each user has a record of their own.
Outcome Story::run(By by, const Command& command, Disturbance& kill) {
  constexpr const char* variable = "XDG_STATE_HOME";
  const std::string own = getenv(variable);
  if (by == By::other_user) {
    setenv(variable, (own + "/other").c_str(), 1);
    std::filesystem::create_directories(own + "/other");
  }
  Outcome outcome = world_.run(command, std::span(&kill, 1));
  setenv(variable, own.c_str(), 1);
  return outcome;
}

void Story::note_what_is_known(const Act& act, const Command& command) {
  for (const std::int64_t serial : story_servos) {
    const ServoState &before = act.before.at(serial), &after = act.after.at(serial);
    const bool is_own = act.by != By::other_user;
    if (is_own && command.verb() != "set") {
      if (act.status == 0 && act.saves && names(command, serial)) {
        unknown_.erase(serial);
      } else if (act.saves) {
        unknown_.insert(serial);
      }
    } else if (!is_own && before.rom_writes != after.rom_writes) {
      unknown_.insert(serial);
    }
    for (const std::uint8_t address : story_settings) {
      const std::int64_t ram = after.ram.at(address), rom = after.rom.at(address);
      // ERASE may change ROM, and ends what is known of it
      const bool is_trial = !is_own && ram != rom && (unknown_.contains(serial) || is_erase_);
      const bool was_held = before.ram.at(address) == ram && before.rom.at(address) != rom;
      const bool is_unnamed = is_own && !names(command, serial, word_of(address));
      const bool is_kept = is_unnamed && was_held;
      // the proof of ROM ends with a try to save, and nobody has recorded this one
      const bool is_forgotten = is_unnamed && act.saves && act.status != 0 && ram != rom;
      if (is_trial || is_kept || is_forgotten) {
        unknown_values_.emplace(serial, address);
      }
    }
  }
}

bool Story::is_meant(std::int64_t serial) const {
  return names_first_ ? serial == story_servos[0] : named_last_.contains(serial);
}

std::string Story::text() const {
  std::string all;
  const auto tell = [&](const Act& act) {
    all += fmt::format("  {}{}\n", act.by == By::other_user ? "other user: " : "", act.text);
    for (const std::int64_t serial : story_servos) {
      const ServoState &was = act.before.at(serial), &is = act.after.at(serial);
      for (const std::uint8_t address : story_settings) {
        const std::int64_t ram = is.ram.at(address), rom = is.rom.at(address);
        if (was.ram.at(address) != ram || was.rom.at(address) != rom) {
          all += fmt::format("      {} {:#04x}: RAM {} -> {}, ROM {} -> {}\n", serial, address,
                             was.ram.at(address), ram, was.rom.at(address), rom);
        }
      }
    }
  };
  std::ranges::for_each(acts_, tell);
  tell(undo_);
  return all;
}

} // namespace blactl::campaign
