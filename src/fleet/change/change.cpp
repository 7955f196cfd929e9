#include "blactl/fleet/change/change.hpp"

#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/guard.hpp"

#include "fleet/change/asking_copies.hpp"
#include "fleet/change/goal_results.hpp"
#include "fleet/change/rounds.hpp"
#include "fleet/change/texts.hpp"
#include "fleet/change/unnamed.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

Wanted wanted(const Goal& goal, Need need) {
  return need == Need::prove ? Wanted{.restart = RestartKind::restart, .proves_rom = true}
                             : goal.wanted;
}

} // namespace

Change::Change(Session& session, const bla::Profiles& profiles, Options options)
    : session_(session), profiles_(profiles), options_(std::move(options)) {
  options_.manner.next_restart = &next_restart_;
}

Change::~Change() = default;

std::vector<Error> Change::prepare(std::vector<Goal> goals) {
  for (Goal& goal : goals) {
    results_.push_back({.goal = std::move(goal)});
    results_.back().change.servo.id = results_.back().goal.id;
  }
  std::vector<std::size_t> all(results_.size());
  std::iota(all.begin(), all.end(), 0U);
  return prepare(all);
}

std::string Change::question() const {
  return rounds_ ? rounds_->question() + overwritten_ : std::string();
}

/// RAM that is going to be saved must be unchanged since before this run, unless the run itself
/// restarted the servo.
Result<Change::Snapshots> Change::read(std::span<const std::size_t> goals) {
  std::map<NodeId, const Goal*> all;
  std::vector<NodeId> nodes;
  auto proof = ReadJob::Proof::moment;
  for (const std::size_t i : goals) {
    const Goal& goal = results_[i].goal;
    nodes.push_back(goal.id);
    if (goal.saves() && !results_[i].change.was_begun) {
      proof = ReadJob::Proof::run;
    }
    all.insert_or_assign(goal.id, &goal);
  }
  auto read = take_snapshots(
      session_, profiles_, nodes, options_.manner.identification,
      [&](const Servo& servo) { return registers_needed(all.at(servo.id)->wanted, servo); }, proof);
  // after a first signal every run of the session is reported as broken; readings remain valid
  if (read.broken && !options_.gives_back) {
    return std::unexpected(*read.broken);
  }
  return std::move(read.servos);
}

/// The reason why the goal cannot be judged; empty: it can, though make_plan() may still refuse it.
std::optional<Error> Change::refuse(const Goal& goal, const Snapshot& held) const {
  const std::uint8_t id = goal.id.value();
  if (session_.roster().is_doubled(goal.id)) { // two that respond at the same time cannot be read
    return doubled(session_.roster(), goal.id);
  }
  if (!held.error && goal.unique_id && held.servo.unique_id != goal.unique_id) {
    return Error{Code::state, say<texts::another_servo>(id), say<texts::run_again_hint>(), id};
  }
  if (!held.error && has_other_serial(held.servo, goal.serial_number)) {
    return other_serial(held.servo, *goal.serial_number);
  }
  const auto error = goal.evidence != Evidence::none ? held.first_error() : std::nullopt;
  return error ? error : check_unit(goal.wanted.assignments, held, profiles_);
}

/// Empty: ROM does not matter, or there is no record.
std::optional<bla::Values> Change::proven_rom(const Goal& goal, const Servo& servo) {
  History* const record = options_.manner.proofs;
  const bool is_asked = goal.saves() && goal.evidence != Evidence::none && record != nullptr;
  return is_asked ? record->proven_rom(servo, session_) : std::nullopt;
}

/// ROM that could not be read may be whole, and SAVE would replace it by initial values. A restart
/// may read it; if one did not, the user decides, before this run has changed anything.
std::optional<Error> Change::refuse_unread_rom(const GoalResult& result, const Snapshot& held,
                                               Need need) {
  const bool saves = result.goal.saves() && (need == Need::save || need == Need::write);
  const bool keeps_nothing = result.goal.wanted.erase && !result.goal.wanted.keep_ids;
  if (!saves || keeps_nothing || !check_rom(held)) {
    return std::nullopt;
  }
  const std::uint8_t id = held.servo.id.value();
  const bool was_tried = options_.manner.proofs != nullptr &&
                         options_.manner.proofs->is_rom_unread(held.servo, session_);
  if (!was_tried) {
    return Error{Code::rom_unread, say<texts::rom_unread>(id), say<texts::rom_unread_hint>(id), id};
  }
  if (options_.manner.overwrite_rom) {
    return std::nullopt;
  }
  if (result.change.was_begun) {
    return Error{Code::rom_unread, say<texts::rom_unread>(id), say<texts::overwrite_rom_hint>(),
                 id};
  }
  overwritten_ += say<texts::question_overwrite_rom>(id);
  return std::nullopt;
}

/// IDs of 0 are to be kept, but an earlier try has made them so, or somebody did since: neither is
/// a guess to be saved.
std::optional<Error> Change::refuse_lost_ids(const LostIds& lost, const Snapshot& held) {
  if (lost.ids.empty() || lost.is_certain) {
    return std::nullopt;
  }
  const std::uint8_t id = held.servo.id.value();
  std::string given;
  for (const auto& [address, raw] : lost.ids) {
    given += fmt::format("{}{}={}", given.empty() ? "" : " ",
                         held.servo.identity.parameter(address)->name, raw);
  }
  return Error{Code::state, say<texts::ids_lost_or_meant>(id, given),
               say<texts::ids_lost_or_meant_hint>(id, given), id};
}

/// Creates tasks for servos with a need.
std::vector<Error> Change::judge(std::span<const std::size_t> goals, Snapshots snapshots,
                                 std::vector<UnitTask>& tasks) {
  std::vector<Error> errors;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    Snapshot& held = snapshots[i];
    GoalResult& result = results_[goals[i]];
    const auto refuse_it = [&](Error why) {
      if (result.change.was_restarted) { // by this run: RAM is not as it was read before
        result.change.doubt();
      }
      result.errors.push_back(why);
      errors.push_back(std::move(why));
    };
    if (auto error = refuse(result.goal, held)) {
      refuse_it(std::move(*error));
      continue;
    }
    const auto rom = proven_rom(result.goal, held.servo);
    const ToldRom told = told_rom(result.goal, held, options_.manner.proofs, session_);
    const Need need = need_of(result.goal, held, rom);
    const bool may_lack_ids = result.goal.wanted.keep_ids && options_.manner.history != nullptr;
    LostIds lost = may_lack_ids ? options_.manner.history->lost_ids(held, session_) : LostIds();
    auto refused = refuse_unread_rom(result, held, need);
    if (refused = refused ? refused : refuse_lost_ids(lost, held); refused) {
      refuse_it(std::move(*refused));
      continue;
    }
    ChangeResult earlier = std::move(result.change); // to read its ROM
    result = compared(std::move(result.goal), need, held);
    result.change.was_begun = earlier.was_begun;
    result.change.was_sent = earlier.was_sent;
    result.change.may_have_changed = earlier.may_have_changed;
    result.change.was_restarted = earlier.was_restarted;
    result.change.duration = earlier.duration;
    result.change.warnings = losses(std::move(earlier.warnings));
    if (result.is_done && result.goal.saves() && result.goal.evidence != Evidence::ram) {
      result.rom_proven = true;
    }
    if (need != Need::nothing) {
      std::ranges::move(unnamed(result.goal, held, told, need),
                        std::back_inserter(result.change.warnings));
      begun_.push_back(goals[i]);
      Wanted next = wanted(result.goal, need);
      next.lost_ids = std::move(lost.ids);
      if (next.restart == RestartKind::restart) {
        next.rom_servo_id = bla::find(told.values, bla::address::servo_id);
        next.told_until = session_.now();
      }
      tasks.push_back({std::move(held), std::move(next)});
    }
  }
  return errors;
}

/// Plans the servos to change, in rounds.
std::vector<Error> Change::make_rounds(std::vector<UnitTask> tasks) {
  rounds_ = std::make_unique<Rounds>(session_, profiles_,
                                     Rounds::Options{.manner = options_.manner,
                                                     .stops_at_failure = options_.stops_at_failure,
                                                     .knows_ids = options_.knows_ids});
  auto errors = rounds_->prepare(std::move(tasks));
  note(rounds_->notes());
  for (std::size_t i = 0; errors.empty() && i < begun_.size(); ++i) {
    GoalResult& result = results_[begun_[i]];
    ChangeResult& change = result.change;
    ChangeResult plan = as_planned(rounds_->units()[i].plan);
    change.warnings.insert(change.warnings.begin(), plan.warnings.begin(), plan.warnings.end());
    if (result.need != Need::prove) {
      change.changes = std::move(plan.changes);
      change.mode_before = plan.mode_before;
      change.mode_after = plan.mode_after;
      change.saves = plan.saves;
    }
  }
  return errors;
}

std::vector<Error> Change::hear() {
  if (options_.gives_back) { // the bus was heard when it was taken
    return {};
  }
  std::vector<dronecan::UniqueId> own;
  for (const GoalResult& result : results_) {
    if (const auto& unit = result.servo().unique_id; unit && result.change.was_begun) {
      own.push_back(*unit);
    }
  }
  auto heard =
      hear_others(session_, options_.manner.identification.patience, options_.searched, own);
  note(heard.notes);
  return std::move(heard.errors);
}

/// A record of one unit must not pass for another: of a servo left unchanged as well.
std::vector<Error> Change::refuse_copies(std::span<const std::size_t> goals) {
  std::vector<Error> errors;
  std::vector<NodeId> nodes;
  for (const std::size_t i : goals) {
    nodes.push_back(results_[i].servo().id);
    if (auto error = not_unique(session_.roster(), nodes.back())) {
      results_[i].errors.push_back(*error);
      errors.push_back(std::move(*error));
    }
  }
  if (options_.gives_back) {
    return {};
  }
  const bool may_hear = errors.empty() && options_.manner.may_allocate;
  return may_hear ? asking_copies(session_, nodes) : errors;
}

std::vector<Error> Change::prepare(std::span<const std::size_t> goals) {
  begun_.clear();
  rounds_.reset();
  overwritten_.clear();
  if (goals.empty()) {
    return {};
  }
  auto snapshots = read(goals);
  if (!snapshots) {
    return {snapshots.error()};
  }
  std::vector<UnitTask> tasks;
  auto errors = judge(goals, std::move(*snapshots), tasks);
  if (!errors.empty() && !options_.gives_back) {
    return errors;
  }
  errors = hear();
  if (errors.empty()) {
    errors = refuse_copies(goals);
  }
  if (!errors.empty()) {
    return errors;
  }
  return options_.gives_back ? make_rounds_of_willing(std::move(tasks))
                             : make_rounds(std::move(tasks));
}

/// Plans without those that refuse: their reasons are in the results.
std::vector<Error> Change::make_rounds_of_willing(std::vector<UnitTask> tasks) {
  for (;;) {
    auto errors = make_rounds(tasks);
    const auto refuses = [&](const UnitTask& task) {
      const auto error = std::ranges::find(errors, task.before.servo.id.value(), &Error::node_id);
      if (error == errors.end()) {
        return false;
      }
      const auto goal = std::ranges::find(begun_, task.before.servo.id,
                                          [&](std::size_t i) { return results_[i].goal.id; });
      results_[*goal].errors.push_back(*error);
      begun_.erase(goal);
      return true;
    };
    if (errors.empty() || std::erase_if(tasks, refuses) == 0) {
      return errors;
    }
  }
}

void Change::note(std::span<const std::string> notes) {
  for (const std::string& text : notes) {
    if (std::ranges::find(notes_, text) == notes_.end()) {
      notes_.push_back(text);
    }
  }
}

} // namespace blactl::fleet
