#include "sweep.hpp"

#include "campaign.hpp"
#include "chance.hpp"
#include "claims.hpp"
#include "judge.hpp"
#include "told.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <iterator>
#include <set>
#include <string_view>

namespace blactl::campaign {

using nlohmann::json;
using namespace std::chrono_literals;
using Kind = Disturbance::Kind;

namespace {

/// Settings, and who has which node ID.
void require_same(const States& due, const States& states, std::string_view what) {
  for (const auto& [serial, state] : due) {
    const ServoState& found = states.at(serial);
    require(state.node_id == 0 || state.node_id == found.node_id, // 0: it has just started
            fmt::format("{}: {} is at {}, not {}", what, serial, found.node_id, state.node_id));
    for (const auto& [address, rom] : state.rom) {
      const std::int64_t ram = state.ram.at(address);
      require(ram == found.ram.at(address) && rom == found.rom.at(address),
              fmt::format("{}: {:#04x} of {} is {} in RAM and {} in ROM, not {} and {}", what,
                          address, serial, found.ram.at(address), found.rom.at(address), ram, rom));
    }
  }
}

constexpr Kind kinds[]{Kind::request_lost,   Kind::killed,          Kind::frame_lost,
                       Kind::frame_doubled,  Kind::frame_corrupted, Kind::frame_late,
                       Kind::frame_of_other, Kind::call_failed,     Kind::computer_off};

/// Of each kind, however far apart the places are.
constexpr std::size_t least_runs = 5;

/// In the table beside the kinds.
constexpr std::string_view pairs = "two of these";

bool ends_command(Kind kind) {
  return kind == Kind::killed || kind == Kind::computer_off;
}

/// A patient client gets everything right in spite of it.
bool is_small(const Disturbance& disturbance) {
  return !disturbance.lasts &&
         (disturbance.kind == Kind::request_lost || disturbance.kind == Kind::frame_lost ||
          disturbance.kind == Kind::frame_doubled || disturbance.kind == Kind::frame_corrupted);
}

std::size_t requests_in(const Record& record) {
  return static_cast<std::size_t>(std::ranges::count_if(
      record.frames(), [](const OnWire& frame) { return frame.is_request() && frame.starts(); }));
}

/// With its repetition after one that was killed.
bool is_one_change(const Command& command) {
  return command.verb() == "apply" || command.verb() == "replace" || command.has("--static") ||
         (command.verb() == "erase" && command.has("--keep-ids"));
}

/// Whether each servo has its IDs once it is over.
bool leaves_servos_apart(const std::string& kind) {
  static const std::set<std::string> others{"node_on_id", "one_node_id", "one_unique_id"};
  return !kind.starts_with("other_") && !others.contains(kind);
}

} // namespace

void add(SweptByKind& all, const SweptByKind& more) {
  for (const auto& [key, one] : more) {
    Swept& sum = all[key];
    sum.places = one.places;
    sum.runs += one.runs;
    sum.good += one.good;
    sum.lies += one.lies;
  }
}

/// On fresh servos, after what is done before it.
Step Sweep::begin(World& world, const Episode& episode, const Case& one,
                  std::span<Disturbance> disturbances) {
  for (const Command& command : one.before) {
    [[maybe_unused]] const Outcome done = world.run(command);
  }
  [[maybe_unused]] const auto earlier = world.take_events();
  return take_step(world, episode, one.command, disturbances);
}

void Sweep::play_refused(const Refused& refused, const Command& command, Swept& swept) {
  options_.begins();
  const Folder folder(folder_);
  World world(refused.episode.scenario, folder_);
  const Case one{.name = "what does harm", .before = refused.before, .command = command};
  const Step step = begin(world, refused.episode, one, {});
  judged(one, "nothing", step, swept, [&] {
    if (refused.are_told_apart) {
      judge(step);
    }
    const bool takes = step.outcome.status == 0; // some models have a PWM input
    require(takes == !step.outcome.record.changes().empty(), "it sent something");
    require(!takes || command.has("0x34=1500raw"), "0 for what does harm");
    require(refused.status == 0 || refused.status == step.outcome.status,
            fmt::format("{} instead of {}", step.outcome.status, refused.status));
  });
}

/// Just those that are meant are changed.
void Sweep::play_selection(const Meant& meant, Swept& swept) {
  options_.begins();
  const Folder folder(folder_);
  const Episode episode = episode_of({11, 12, 13});
  World world(episode.scenario, folder_);
  const Command command{.words = {"set", "-n", meant.target, "smoothing=off", "-y"}};
  const Step step = take_step(world, episode, command);
  const Case one{.name = "who is meant", .before = {}, .command = command};
  judged(one, meant.target, step, swept, [&] {
    constexpr std::uint8_t smoothing = 0x22;
    require((step.outcome.status == 0) == !meant.serials.empty(),
            fmt::format("{} for {}", step.outcome.status, meant.target));
    for (const auto& [serial, servo] : step.after) {
      require((servo.ram.at(smoothing) == 0) == meant.serials.contains(serial),
              fmt::format("{} is changed, or is not", serial));
    }
  });
}

void Sweep::play_quiet() {
  Swept& harmful = swept_[{"what does harm", "nothing"}];
  for (const Refused& all : refused()) {
    for (const Command& command : all.commands) {
      harmful.places += 1;
      if (is_own_turn() && !is_over()) {
        play_refused(all, command, harmful);
      }
    }
  }
  Swept& selected = swept_[{"who is meant", "nothing"}];
  for (const Meant& meant : selections()) {
    selected.places += 1;
    if (is_own_turn() && !is_over()) {
      play_selection(meant, selected);
    }
  }
}

void Sweep::play() {
  if (options_.only.empty() || options_.only == "nothing") {
    play_quiet();
  }
  for (const Case& one : cases()) {
    play_faults(one);
    for (const Kind kind : kinds) {
      if (options_.only.empty() || options_.only == name(kind)) {
        play_each(one, kind);
      }
    }
    if (options_.only.empty() || options_.only == pairs) {
      play_pairs(one);
    }
    play_moments(one);
  }
}

/// What follows where nothing goes wrong.
Sweep::Calm Sweep::play_calm(const Case& one, Kind kind) const {
  Disturbance counting{.kind = kind, .number = Disturbance::no_number};
  const Folder folder(folder_);
  const Episode episode = episode_of(one);
  World world(episode.scenario, folder_);
  const States first = world.states();
  const Step step = begin(world, episode, one, std::span(&counting, 1));
  return {.first = first,
          .goal = step.after,
          .places = counting.seen,
          .requests = requests_in(step.outcome.record),
          .status = step.outcome.status};
}

void Sweep::play_each(const Case& one, Kind kind) {
  const Calm calm = play_calm(one, kind);
  const std::size_t places = calm.places;
  for (const bool lasts : {false, true}) {
    if (lasts && ends_command(kind)) {
      continue;
    }
    Swept& swept =
        swept_[{one.name, fmt::format("{}{}", name(kind), lasts ? ", from then on" : "")}];
    swept.places = places;
    const std::size_t step = std::min(options_.step, std::max<std::size_t>(places / least_runs, 1));
    Chance chance(places, one.name + std::string(name(kind)));
    const auto first = static_cast<std::size_t>(chance.whole(1, static_cast<std::int64_t>(step)));
    for (std::size_t number = first; number <= places; number += step) {
      if (is_own_turn() && !is_over()) {
        disturb(one, {{.kind = kind, .number = number, .lasts = lasts}}, calm, swept);
      }
    }
  }
}

/// The second while the command recovers from the first.
void Sweep::play_pairs(const Case& one) {
  constexpr std::size_t most = 400;
  constexpr std::int64_t recovery = 40; // in frames
  const std::vector<Kind> firsts{Kind::request_lost, Kind::frame_lost, Kind::frame_doubled,
                                 Kind::frame_late, Kind::frame_of_other};
  std::vector<Kind> seconds = firsts;
  seconds.insert(seconds.end(), {Kind::killed, Kind::call_failed, Kind::computer_off});
  Swept& swept = swept_[{one.name, std::string(pairs)}];
  swept.places = most;
  std::map<Kind, Calm> calm;
  for (const Kind kind : firsts) {
    calm.emplace(kind, play_calm(one, kind));
  }
  for (std::size_t i = 0; i < most; i += options_.step) {
    Chance chance(i, one.name);
    const Kind first = chance.one_of(firsts), second = chance.one_of(seconds);
    const Calm& quiet = calm.at(first);
    const Disturbance early{.kind = first,
                            .number = static_cast<std::size_t>(
                                chance.whole(1, static_cast<std::int64_t>(quiet.places)))};
    const Disturbance late{.kind = second,
                           .number = static_cast<std::size_t>(chance.whole(1, recovery))};
    if (is_own_turn() && !is_over()) {
      disturb(one, {early, late}, quiet, swept);
    }
  }
}

/// Each kind of fault of the episodes, alone.
void Sweep::play_faults(const Case& one) {
  constexpr std::size_t most = 40;
  const std::size_t draws = std::clamp<std::size_t>(360 / options_.step, 1, most);
  for (const std::string& kind : fault_kinds()) {
    if (!options_.only.empty() && options_.only != kind) {
      continue;
    }
    Swept& swept = swept_[{one.name, kind}];
    swept.places = most;
    for (std::size_t i = 0; i < draws; ++i) {
      if (!is_own_turn() || is_over()) {
        continue;
      }
      Episode episode = episode_of(one);
      Chance chance(i, one.name + kind);
      plant(episode, kind, chance);
      play_moment(one, episode,
                  {.what = fmt::format("{} number {}", kind, i),
                   .must_converge = one.is_repeatable && leaves_servos_apart(kind),
                   .is_undone_later = one.is_undoable && leaves_servos_apart(kind)},
                  swept);
    }
  }
}

void Sweep::disturb(const Case& one, std::vector<Disturbance> disturbances, const Calm& calm,
                    Swept& swept) {
  std::string what;
  for (std::size_t i = 0; i < disturbances.size(); ++i) {
    disturbances[i].first = i > 0 ? &disturbances[i - 1] : nullptr;
    what += fmt::format("{}{} number {}{}", i > 0 ? ", then " : "", name(disturbances[i].kind),
                        disturbances[i].number, disturbances[i].lasts ? " and all later ones" : "");
  }
  options_.begins();
  const Folder folder(folder_);
  const Episode episode = episode_of(one);
  World world(episode.scenario, folder_);
  const Step step = begin(world, episode, one, disturbances);
  judged(one, what, step, swept, [&] { check(world, one, disturbances, step, calm); });
}

/// Counts a run, and tells what `check` finds.
void Sweep::judged(const Case& one, const std::string& what, const Step& step, Swept& swept,
                   const std::function<void()>& check) {
  swept.runs += 1;
  swept.good += step.outcome.status == 0 ? 1 : 0;
  try {
    check();
  } catch (const std::exception& lie) {
    swept.lies += 1;
    has_found_ = true;
    tell_(fmt::format("case {}: {}: {}\n  {}\n  exit status {}\n  {}\n{}", one.name, what,
                      lie.what(), step.command.text(), step.outcome.status,
                      step.outcome.document.dump(), step.outcome.err));
  }
}

/// What the command changed can be taken back; a trial in RAM only that it saved goes with it.
void Sweep::check_undo(World& world, const Step& changed) {
  const Command take_back{.words = {"undo", "-y"}};
  const Step undo = take_step(world, changed.episode, take_back);
  require(undo.outcome.status == 0, "cannot be taken back: " + undo.outcome.err);
  States due = changed.before;
  for (auto& [serial, state] : due) {
    for (const auto& [address, rom] : state.rom) {
      state.ram[address] = rom;
    }
  }
  require_same(due, undo.after, "undo has not brought everything back");
}

/// The computer is on again: every ID that was given is in the table, and what was changed can be
/// taken back.
void Sweep::check_stores(World& world, const Step& cut, bool is_undoable) {
  const Command list_all{.words = {"alloc", "--list"}};
  const Step list = take_step(world, cut.episode, list_all);
  require(list.outcome.status == 0, "the allocation table cannot be read any more");
  if (cut.command.verb() == "alloc" && cut.command.has("--once")) {
    check_table(list);
  }
  if (is_undoable && !cut.outcome.record.changes().empty()) {
    check_undo(world, cut);
  }
}

/// By turns; nothing, where `undo` may not know what was before.
Sweep::AfterKill Sweep::follows_kill(const Case& one, std::span<const Disturbance> disturbances,
                                     const Step& step) {
  const bool is_killed = disturbances.size() == 1 && disturbances.front().kind == Kind::killed &&
                         disturbances.front().has_struck();
  if (!is_killed || !one.is_undoable || !has_no_trials(step.before) ||
      step.outcome.record.changes().empty()) {
    return AfterKill::nothing;
  }
  constexpr AfterKill turns[]{AfterKill::undo, AfterKill::killed_again, AfterKill::repeated};
  return turns[disturbances.front().number % std::size(turns)];
}

/// Whether its repetition is killed at the same place: else it was done, and the next one is a
/// change of its own.
bool Sweep::is_killed_again(World& world, const Step& tried, Disturbance kill) {
  kill.seen = 0;
  [[maybe_unused]] const Step again =
      take_step(world, tried.episode, tried.command, std::span(&kill, 1));
  world.pass(4s);
  [[maybe_unused]] const auto late = world.take_events();
  return kill.has_struck();
}

void Sweep::check(World& world, const Case& one, std::span<const Disturbance> disturbances,
                  const Step& step, const Calm& calm) {
  check_file(step);
  const auto is_ended = [](const Disturbance& one_of_them) {
    return ends_command(one_of_them.kind) && one_of_them.has_struck();
  };
  if (std::ranges::none_of(disturbances, is_ended)) {
    judge(step);
    if (one.takes_back && step.outcome.status == 0) {
      require_same(calm.first, step.after, "undo has not brought everything back");
    }
  }
  // an opcode that the servo does not heed, and its repetition lost, are two faults
  const bool is_unheeded = one.first.contains(json::json_pointer("/faults/ignore_opcodes"));
  const bool is_alone = disturbances.size() == 1 && !is_unheeded;
  if (is_alone && is_small(disturbances.front())) {
    require(step.outcome.status == calm.status,
            fmt::format("{} instead of {}, and one frame was in its way", step.outcome.status,
                        calm.status));
    require(disturbances.front().kind != Kind::frame_doubled ||
                requests_in(step.outcome.record) <= calm.requests,
            "a frame that came twice made it ask again");
  }
  world.pass(4s);
  [[maybe_unused]] const auto late = world.take_events();
  if (disturbances.back().kind == Kind::computer_off) {
    check_stores(world, step, one.is_undoable);
  }
  const AfterKill after_kill = follows_kill(one, disturbances, step);
  if (after_kill == AfterKill::undo) {
    check_undo(world, step);
    return;
  }
  if (!one.is_repeatable) {
    return;
  }
  const bool was_killed_again =
      after_kill == AfterKill::killed_again && is_killed_again(world, step, disturbances.front());
  const Step again = take_step(world, step.episode, one.command);
  judge(again);
  check_file(again);
  require(again.outcome.status == 0, "does not converge: " + again.outcome.err);
  require_same(calm.goal, again.after, "the same command has another result");
  if ((after_kill == AfterKill::repeated || was_killed_again) && is_one_change(one.command)) {
    check_undo(world, step);
    return;
  }
  const bool is_recorded = std::ranges::none_of(disturbances, [](const Disturbance& disturbance) {
    return disturbance.kind == Kind::call_failed; // commands go on without a record
  });
  const bool is_last = again.outcome.record.changes().empty();
  if (one.is_undoable && step.outcome.status == 0 && is_recorded && is_last) {
    check_undo(world, step);
  }
}

} // namespace blactl::campaign
