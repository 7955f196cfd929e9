#include "campaign.hpp"

#include "judge.hpp"

#include <fmt/format.h>

#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

/// What a command may take of simulated time where nothing goes wrong.
constexpr Duration longest = 60s;

/// A folder that ends with this.
class Folder {
 public:
  explicit Folder(std::filesystem::path path) : path_(std::move(path)) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
    for (const char* variable : {"XDG_STATE_HOME", "XDG_RUNTIME_DIR", "HOME"}) {
      setenv(variable, path_.c_str(), 1);
    }
  }

  ~Folder() {
    std::filesystem::current_path("/");
    std::filesystem::remove_all(path_);
  }

  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

 private:
  std::filesystem::path path_;
};

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
  return !episode.has("one_node_id") && !episode.has("one_unique_id");
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

Counts& Counts::operator+=(const Counts& other) {
  episodes += other.episodes;
  runs += other.runs;
  repeated += other.repeated;
  servo_seconds += other.servo_seconds;
  lies += other.lies;
  stuck += other.stuck;
  for (const auto& [end, count] : other.ends) {
    ends[end] += count;
  }
  for (const auto& [fault, count] : other.faults) {
    faults[fault] += count;
  }
  for (const auto& [fault, one] : other.alone) {
    alone[fault].good += one.good;
    alone[fault].needless += one.needless;
  }
  return *this;
}

Step Campaign::run(World& world, const Episode& episode, const Command& command,
                   std::vector<sim::ServoEvent>& earlier) {
  Step step{.episode = episode,
            .command = command,
            .outcome = {},
            .before = world.states(),
            .after = {},
            .begin = world.now(),
            .end = {},
            .events = {},
            .earlier = earlier};
  step.outcome = world.run(command);
  step.after = world.states();
  step.end = world.now();
  step.events = world.take_events();
  earlier.insert(earlier.end(), step.events.begin(), step.events.end());
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
  (step.outcome.status == 0 ? ends.good : ends.needless) += 1;
}

void Campaign::play(const Episode& episode) {
  const Folder folder(folder_);
  World world(episode.scenario, folder_);
  std::vector<sim::ServoEvent> earlier;
  counts_.episodes += 1;
  for (const std::string& fault : episode.faults) {
    counts_.faults[fault] += 1;
  }
  bool ids_are_known = std::ranges::none_of(
      episode.scenario["servos"], [](const json& servo) { return servo["node_id"] == 0; });
  for (const Command& command : episode.steps) {
    const Step step = run(world, episode, command, earlier);
    const bool must_succeed = command.is_right && ids_are_known && is_sound(episode);
    count(step, must_succeed);
    try {
      judge(step);
      if (must_succeed && episode.faults.empty() && step.outcome.status != 0) {
        throw Lie("nothing was in its way");
      }
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
  }
  repeat(world, episode);
}

/// Everything that went wrong has ended: the last command converges.
void Campaign::repeat(World& world, const Episode& episode) {
  const Command& last = episode.steps.back();
  if (!last.is_right || !is_sound(episode)) {
    return;
  }
  world.repair();
  Episode calm = episode;
  calm.faults.clear();
  calm.scenario.erase("events");
  calm.scenario.erase("wire");
  calm.scenario.erase("foreign");
  for (json& servo : calm.scenario["servos"]) {
    servo.erase("faults");
    servo.erase("sending");
  }
  std::vector<sim::ServoEvent> earlier;
  const auto states = world.states();
  const bool has_dynamic =
      std::ranges::any_of(states, [](const auto& servo) { return servo.second.rom.at(0x46) == 0; });
  if (has_dynamic) {
    [[maybe_unused]] const Step given = run(world, calm, {.words = {"alloc", "--once"}}, earlier);
  }
  Command command = last;
  const auto target = std::ranges::find(command.words, "-n");
  if (target != command.words.end() && *(target + 1) != "all" &&
      !(target + 1)->starts_with("serial:")) {
    *(target + 1) = "all"; // its ID may be another one now
  }
  for (int time = 0; time < 2; ++time) {
    const Step step = run(world, calm, command, earlier);
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
