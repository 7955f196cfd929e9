#include "campaign.hpp"

#include "claims.hpp"
#include "judge.hpp"

#include <fmt/format.h>

#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

/// What a command may take of simulated time where nothing goes wrong.
constexpr Duration longest = 60s;

std::string end_of(const Outcome& outcome) {
  std::set<std::string> codes;
  if (outcome.document.contains("errors")) {
    for (const json& error : outcome.document["errors"]) {
      codes.insert(error["code"].get<std::string>());
    }
  }
  std::string end = std::to_string(outcome.status);
  for (const std::string& code : codes) {
    end += " " + code;
  }
  return end;
}

/// Whether an episode's servos are told from each other at all.
bool is_sound(const Episode& episode) {
  return !episode.has("one_node_id") && !episode.has("node_on_id") && !episode.has("one_unique_id");
}

/// It changes IDs, but in a way that nothing forbids.
bool is_feasible(const Command& command) {
  const std::string& verb = command.verb();
  return (verb == "apply" && !command.has("--dry-run") && !command.has("--no-save")) ||
         verb == "erase";
}

/// Whether two have the same servo ID, or static node ID.
bool share_id(const States& states, std::uint8_t address) {
  std::set<std::int64_t> seen;
  return std::ranges::any_of(states, [&](const auto& servo) {
    const std::int64_t id = servo.second.rom.at(address);
    return id != 0 && !seen.insert(id).second;
  });
}

/// Whether IDs that an ERASE took are wished again only a person knows: who wishes it types this.
std::optional<Command> answer_to(const Step& step) {
  static const std::string before = "to have it back: blactl ";
  for (const nlohmann::json& error : step.outcome.document.value("errors", nlohmann::json())) {
    const std::string hint = error.value("hint", "");
    if (hint.starts_with(before)) {
      std::istringstream typed(hint.substr(before.size(), hint.find(';') - before.size()));
      Command answer{.words = {std::istream_iterator<std::string>(typed), {}}};
      answer.words.emplace_back("-y");
      return answer;
    }
  }
  return std::nullopt;
}

/// It ends soon, and what is there already is not saved again.
void check_effort(const Step& step, bool is_there_already) {
  if (step.end - step.begin > longest) {
    throw Lie("it takes too long");
  }
  const std::string& verb = step.command.verb();
  for (const auto& [serial, state] : step.after) {
    if (is_there_already && (verb == "apply" || verb == "set") && step.rom_writes(serial) > 0) {
      throw Lie(fmt::format("ROM of {} is written again", serial));
    }
  }
}

} // namespace

Folder::Folder(std::filesystem::path path) : path_(std::move(path)) {
  std::filesystem::remove_all(path_);
  std::filesystem::create_directories(path_);
  for (const char* variable : {"XDG_STATE_HOME", "XDG_RUNTIME_DIR", "HOME"}) {
    setenv(variable, path_.c_str(), 1);
  }
}

Folder::~Folder() {
  std::filesystem::current_path("/");
  std::filesystem::remove_all(path_);
}

Step take_step(World& world, const Episode& episode, const Command& command,
               std::span<Disturbance> disturbances) {
  Step step{.episode = episode,
            .command = command,
            .outcome = {},
            .before = world.states(),
            .after = {},
            .begin = world.now(),
            .end = {},
            .events = {},
            .tried = {}};
  step.outcome = world.run(command, disturbances);
  step.after = world.states();
  step.end = world.now();
  step.events = world.take_events();
  return step;
}

Counts& Counts::operator+=(const Counts& other) {
  episodes += other.episodes;
  runs += other.runs;
  repeated += other.repeated;
  servo_seconds += other.servo_seconds;
  lies += other.lies;
  stuck += other.stuck;
  alarms += other.alarms;
  deaf += other.deaf;
  crashes += other.crashes;
  for (const auto& [end, count] : other.ends) {
    ends[end] += count;
  }
  for (const auto& [fault, count] : other.faults) {
    faults[fault] += count;
  }
  for (const auto& [fault, one] : other.alone) {
    alone[fault].good += one.good;
    for (const auto& [end, count] : one.needless) {
      alone[fault].needless[end] += count;
    }
  }
  return *this;
}

Step Campaign::run(World& world, const Episode& episode, const Command& command) {
  Step step = take_step(world, episode, command);
  counts_.runs += 1;
  counts_.ends[end_of(step.outcome)] += 1;
  counts_.servo_seconds +=
      static_cast<std::uint64_t>((step.end - step.begin) / 1s) * episode.scenario["servos"].size();
  if (is_verbose_) {
    tell_(fmt::format("{}\n  {} {}", command.text(), step.outcome.status, step.outcome.err));
  }
  return step;
}

void Campaign::differ(const Episode& episode, const Step& step, const std::string& what) {
  tell_(fmt::format("episode {}: {}\n  {}\n  exit status {}\n  {}\n{}", episode.seed, what,
                    step.command.text(), step.outcome.status, step.outcome.document.dump(),
                    step.outcome.err));
}

/// Needless: a good command on servos that a patient person would have got right.
void Campaign::count(const Step& step, bool must_succeed) {
  if (!must_succeed) {
    return;
  }
  const auto& faults = step.episode.faults;
  if (faults.size() > 1) {
    return;
  }
  Ends& ends = counts_.alone[faults.empty() ? "" : *faults.begin()];
  (step.outcome.status == 0 ? ends.good : ends.needless[end_of(step.outcome)]) += 1;
  if (is_verbose_ && step.outcome.status != 0) {
    tell_(fmt::format("needless: {}", faults.empty() ? "(none)" : *faults.begin()));
  }
}

/// When the program changes something where nothing goes wrong, and some moments before.
std::vector<Time> Campaign::rehearse(const Episode& episode) {
  const Folder folder(folder_);
  const Episode calm = calmed(episode);
  World world(calm.scenario, folder_);
  std::vector<Time> moments;
  for (const Command& command : calm.steps) {
    const Outcome outcome = world.run(command);
    for (const OnWire& frame : outcome.record.changes()) {
      moments.push_back(frame.at);
    }
    const auto& frames = outcome.record.frames();
    for (std::size_t quarter = 1; quarter < 4 && !frames.empty();
         ++quarter) { // as it listens, reads
      moments.push_back(frames[frames.size() * quarter / 4].at);
    }
  }
  return moments;
}

void Campaign::play(const Episode& drawn) {
  Episode episode = drawn;
  if (is_aimed(episode)) {
    aim(episode, rehearse(episode));
  }
  const Folder folder(folder_);
  World world(episode.scenario, folder_);
  counts_.episodes += 1;
  for (const std::string& fault : episode.faults) {
    counts_.faults[fault] += 1;
  }
  bool ids_are_known = std::ranges::none_of(
      episode.scenario["servos"], [](const json& servo) { return servo["node_id"] == 0; });
  std::optional<Step> last;
  for (const Command& command : episode.steps) {
    Step step = run(world, episode, command);
    if (last && last->outcome.status != 0 && last->command.words == command.words) {
      step.tried = last->tried ? last->tried : last->before;
    }
    const bool must_succeed = command.is_right && ids_are_known && is_sound(episode);
    count(step, must_succeed);
    try {
      judge(step);
      if (last) {
        check_undo(*last, step);
      }
      const bool is_calm = episode.faults.empty();
      const bool must = (must_succeed && is_harmless(episode)) ||
                        (is_calm && is_feasible(command) && ids_are_known);
      if (must && step.outcome.status != 0) {
        throw Lie("nothing was in its way");
      }
      test_alarm(step);
    } catch (const std::exception& fault) {
      counts_.lies += 1;
      differ(episode, step, fault.what());
    }
    ids_are_known = ids_are_known &&
                    (command.is_right || command.verb() == "alloc" || command.verb() == "doctor" ||
                     command.verb() == "faults" || command.verb() == "export");
    ids_are_known = ids_are_known && !command.has("--static");
    if (step.outcome.status != 0) {
      world.pass(2s); // what was sent before it broke off happens all the same
      [[maybe_unused]] const auto late = world.take_events();
    }
    last.emplace(step);
  }
  list(world, episode);
  repeat(world, episode, *last);
}

/// The servo confirmed a value, and is made to hold another one.
void Campaign::test_alarm(const Step& step) {
  const bool is_plain = step.outcome.status == 0 && step.command.verb() == "set" &&
                        step.outcome.document["nodes"].size() > 0;
  if (!has_liar(step.episode) || !is_plain) {
    return;
  }
  const json& node = step.outcome.document["nodes"][0];
  const auto address = static_cast<std::uint8_t>(
      std::stoul(node["changes"][0]["address"].get<std::string>(), nullptr, 16));
  Step lie = step;
  ServoState& state = lie.after.at(node["serial_number"].get<std::int64_t>());
  state.ram[address] += 1;
  state.rom[address] += 1;
  counts_.alarms += 1;
  try {
    judge(lie);
    counts_.deaf += 1;
    differ(step.episode, step, "a servo that lied was not noticed");
  } catch (const Lie&) { // as it should be
  }
}

/// Where nothing went wrong, the allocation table is as the servos are.
void Campaign::list(World& world, const Episode& episode) {
  if (!episode.faults.empty()) {
    return;
  }
  const Command command{.words = {"alloc", "--list"}};
  const Step step = run(world, episode, command);
  try {
    judge(step);
    check_table(step);
  } catch (const std::exception& fault) {
    counts_.lies += 1;
    differ(episode, step, fault.what());
  }
}

Step Campaign::run_and_answer(World& world, const Episode& calm, const Command& command) {
  Step step = run(world, calm, command);
  const auto answer = answer_to(step);
  if (!answer) {
    return step;
  }
  [[maybe_unused]] const Step answered = run(world, calm, *answer);
  return run(world, calm, command);
}

/// Everything that went wrong has ended: the last command converges.
void Campaign::repeat(World& world, const Episode& episode, const Step& former) {
  const Command& last = former.command;
  if (!last.is_right || !is_sound(episode)) {
    return;
  }
  world.repair();
  const Episode calm = calmed(episode);
  const auto states = world.states();
  const bool has_dynamic = std::ranges::any_of(
      states, [](const auto& servo) { return servo.second.rom.at(static_node_id) == 0; });
  if (has_dynamic) {
    [[maybe_unused]] const Step given = run(world, calm, {.words = {"alloc", "--once"}});
  }
  // one was away when its ID was given to another, with a warning
  if (share_id(states, servo_id) || share_id(states, static_node_id)) {
    return;
  }
  Command command = last;
  const auto target = std::ranges::find(command.words, "-n");
  if (target != command.words.end() && *(target + 1) != "all" &&
      !(target + 1)->starts_with("serial:")) {
    *(target + 1) = "all"; // its ID may be another one now
  }
  for (int time = 0; time < 2; ++time) {
    Step step = run_and_answer(world, calm, command);
    if (time == 0 && former.outcome.status != 0) {
      step.tried = former.tried ? former.tried : former.before;
    }
    counts_.repeated += 1;
    try {
      judge(step);
      if (step.outcome.status != 0) {
        counts_.stuck += 1;
        throw Lie("does not converge");
      }
      check_effort(step, time > 0);
    } catch (const std::exception& fault) {
      counts_.lies += 1;
      differ(calm, step, fault.what());
    }
  }
}

} // namespace blactl::campaign
