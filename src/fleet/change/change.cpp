#include "blactl/fleet/change/change.hpp"

#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/change/history.hpp"

#include "fleet/change/asking_copies.hpp"
#include "fleet/change/goal_results.hpp"
#include "fleet/change/last_look.hpp"
#include "fleet/change/rounds.hpp"
#include "fleet/change/texts.hpp"
#include "fleet/change/unnamed.hpp"

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

/// Whether a restart has not shown that ROM holds the goal.
bool is_unproven(const GoalResult& result, const UnitChange& unit) {
  return result.need == Need::prove && unit.is_done && unit.last &&
         !(unit.last->rom && holds(unit.last->rom->values, result.goal));
}

/// Of a unit that waits on a temporary ID, where the rounds have broken off.
Error made_way(const UnitChange& unit, NodeId before) {
  const std::uint8_t now = unit.now.value();
  return {Code::state,
          say<texts::has_made_way>(before.value(), now, unit.static_node_id()->value()),
          say<texts::run_again_hint>(), now};
}

} // namespace

Change::Change(Session& session, const bla::Profiles& profiles, Options options)
    : session_(session), profiles_(profiles), options_(std::move(options)) {}

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
  const auto error = goal.evidence != Evidence::none ? held.first_error() : std::nullopt;
  return error ? error : check_unit(goal.wanted.assignments, held, profiles_);
}

/// Empty: ROM does not matter, or there is no record.
std::optional<bla::Values> Change::proven_rom(const Goal& goal, const Servo& servo) {
  History* const record = options_.manner.proofs;
  return goal.saves() && goal.evidence != Evidence::none && record != nullptr
             ? record->proven_rom(servo, session_)
             : std::nullopt;
}

/// ROM that could not be read may be whole, and SAVE would replace it by initial values. A restart
/// may read it; if one did not, the user decides, before this run has changed anything.
std::optional<Error> Change::refuse_unread_rom(const GoalResult& result, const Snapshot& held,
                                               Need need) {
  const bool saves = result.goal.saves() && (need == Need::save || need == Need::write);
  if (!saves || result.goal.wanted.erase || !check_rom(held)) {
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

/// Creates tasks for servos with a need.
std::vector<Error> Change::judge(std::span<const std::size_t> goals, Snapshots snapshots,
                                 std::vector<UnitTask>& tasks) {
  std::vector<Error> errors;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    Snapshot& held = snapshots[i];
    GoalResult& result = results_[goals[i]];
    if (auto error = refuse(result.goal, held)) {
      result.errors.push_back(*error);
      errors.push_back(std::move(*error));
      continue;
    }
    const auto rom = proven_rom(result.goal, held.servo);
    const ToldRom told = told_rom(result.goal, held, options_.manner.proofs, session_);
    const Need need = need_of(result.goal, held, rom);
    if (auto error = refuse_unread_rom(result, held, need)) {
      result.errors.push_back(*error);
      errors.push_back(std::move(*error));
      continue;
    }
    const ChangeResult earlier = std::move(result.change); // to read its ROM
    result = compared(std::move(result.goal), need, held);
    result.change.was_begun = earlier.was_begun;
    result.change.was_sent = earlier.was_sent;
    result.change.was_restarted = earlier.was_restarted;
    result.change.duration = earlier.duration;
    if (result.is_done && result.goal.saves() && result.goal.evidence != Evidence::ram) {
      result.rom_proven = true;
    }
    if (need != Need::nothing) {
      result.change.warnings = unnamed(result.goal, held, told, need);
      begun_.push_back(goals[i]);
      Wanted next = wanted(result.goal, need);
      if (next.keep_ids && options_.manner.history != nullptr) {
        next.lost_ids = options_.manner.history->lost_ids(held, session_);
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
  auto heard = hear_others(session_, options_.manner.identification.patience, options_.searched);
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
  return errors.empty() && options_.manner.may_allocate ? asking_copies(session_, nodes) : errors;
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

std::vector<Error> Change::carry_out(const MoveHook& moved) {
  std::vector<Error> errors;
  if (!begun_.empty()) {
    errors = rounds_->carry_out(moved);
    conclude();
    const bool has_failed = std::ranges::any_of(rounds_->units(), &UnitChange::has_failed);
    if (errors.empty() && !(has_failed && options_.stops_at_failure)) {
      errors = write_what_rom_lacks();
    }
  }
  if (auto lost = errors.empty() && !begun_.empty() ? look_at_unchanged() : Lost(); lost) {
    look_back(*lost);
  } else {
    errors.push_back(lost.error());
    look_back({});
  }
  end_record();
  return errors;
}

/// Of servos left unchanged while others were changed, those whose ROM does not hold their goals.
Result<Change::Lost> Change::look_at_unchanged() {
  std::vector<Servo> servos;
  for (const GoalResult& result : results_) {
    if (result.need == Need::nothing && !result.rom_proven) {
      servos.push_back(result.servo());
    }
  }
  auto looked = look_last(session_, servos, options_.manner.identification.patience);
  if (!looked) {
    return std::unexpected(looked.error());
  }
  Lost lost;
  for (std::size_t i = 0; i < servos.size(); ++i) {
    if ((*looked)[i]) {
      lost.emplace(servos[i].id, std::move(*(*looked)[i]));
    }
  }
  return lost;
}

/// Checks that servos left unchanged still hold their goals, as far as heard.
void Change::look_back(const Lost& lost) {
  const Roster& roster = session_.roster();
  for (GoalResult& result : results_) {
    if (result.need != Need::nothing) {
      look_back(result); // of one round; its own job has checked the rest
      continue;
    }
    const Servo& servo = result.servo();
    const std::uint8_t id = servo.id.value();
    const bool restarted = roster.member(servo.id).boots != servo.boot;
    if (roster.is_doubled(servo.id)) {
      result.errors.push_back(doubled(roster, servo.id));
    } else if (const auto writer = result.rom_proven ? roster.setter_of(servo.id, servo.since)
                                                     : roster.writer_to(servo.id, servo.since)) {
      result.errors.push_back({Code::state, say<texts::written_by_other>(id, writer->value()),
                               say<texts::other_writer_hint>(), id});
    } else if (restarted && !result.rom_proven) { // RAM was reloaded from ROM
      result.errors.push_back(
          {Code::state, say<texts::lost_since>(id), say<texts::run_again_hint>(), id});
    } else if (const auto found = lost.find(servo.id); found != lost.end()) {
      result.errors.push_back(found->second);
    }
    result.is_done = result.errors.empty();
    if (!result.is_done) {
      result.change.doubt();
    }
  }
}

/// Later rounds may have taken long: another unit, or another node's write, may have come since.
void Change::look_back(GoalResult& result) const {
  const Roster& roster = session_.roster();
  const auto id = result.change.node_id_after;
  if (!result.is_done || !id) {
    return;
  }
  const Time since = result.change.looked_at;
  const bool is_in_ram_only = result.change.was_sent && !result.change.may_have_saved;
  if (roster.is_doubled(*id)) {
    result.errors.push_back(doubled(roster, *id));
  } else if (const auto saver = is_in_ram_only ? roster.saver_of(*id, since) : std::nullopt) {
    result.errors.push_back({Code::state, say<texts::saved_by_other>(id->value(), saver->value()),
                             say<texts::run_again_hint>(), id->value()});
    result.change.doubt();
  } else if (is_in_ram_only && roster.member(*id).boots != result.change.boots) {
    result.errors.push_back({Code::state, say<texts::lost_since>(id->value()),
                             say<texts::run_again_hint>(), id->value()});
    result.change.doubt();
  } else if (const auto by =
                 is_in_ram_only ? roster.writer_to(*id, since) : roster.setter_of(*id, since)) {
    result.errors.push_back({Code::state, say<texts::written_by_other>(id->value(), by->value()),
                             say<texts::other_writer_hint>(), id->value()});
    result.change.doubt();
  } else {
    return;
  }
  result.is_done = result.change.saved = result.change.is_verified = false;
  result.rom_proven = result.rom_proven ? std::optional(false) : std::nullopt;
}

void Change::conclude() {
  for (std::size_t i = 0; i < begun_.size(); ++i) {
    conclude(rounds_->units()[i], results_[begun_[i]]);
  }
}

void Change::conclude(const UnitChange& unit, GoalResult& result) {
  result.is_done = unit.is_done && !is_unproven(result, unit);
  if (!unit.last) {
    return;
  }
  const ChangeResult& last = *unit.last;
  result.change = merged(std::move(result.change), last);
  result.errors = result.change.errors();
  if (unit.has_made_way && (last.is_done() || !last.may_have_saved)) {
    result.errors.push_back(made_way(unit, result.goal.id));
  }
  if (unit.is_done && !result.is_done && !last.rom) {
    const std::uint8_t id = last.servo.id.value();
    result.errors.push_back(
        {Code::state, say<texts::restarts_while_read>(id), say<texts::restarts_again_hint>(), id});
  }
  result.rom_proven = result.goal.saves() ? std::optional(result.is_done) : std::nullopt;
  if (result.need == Need::prove && last.rom) {
    result.change.warnings =
        unnamed(result.goal, unit.plan.before, {last.rom->values, true}, result.need, true);
  }
}

/// Writes goals that a restart has shown to be missing in ROM.
std::vector<Error> Change::write_what_rom_lacks() {
  std::vector<std::size_t> lacking;
  for (std::size_t i = 0; i < begun_.size(); ++i) {
    GoalResult& result = results_[begun_[i]];
    if (is_unproven(result, rounds_->units()[i])) {
      result.goal.id = result.change.node_id_after.value_or(result.goal.id);
      lacking.push_back(begun_[i]);
    }
  }
  if (lacking.empty()) {
    return {};
  }
  auto errors = prepare(lacking);
  if (errors.empty() && !begun_.empty()) {
    errors = rounds_->carry_out({});
    conclude();
  }
  return errors;
}

/// A completed change is not continued when the command is repeated.
void Change::end_record() {
  std::vector<dronecan::UniqueId> units;
  for (const GoalResult& result : results_) {
    if (result.is_done && result.servo().unique_id) {
      units.push_back(*result.servo().unique_id);
    }
  }
  const Manner& manner = options_.manner;
  const auto ended = manner.history != nullptr ? manner.history->end(units) : Result<void>();
  if (!ended && manner.end_not_recorded) {
    manner.end_not_recorded(ended.error());
  }
}

} // namespace blactl::fleet
