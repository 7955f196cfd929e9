#include "blactl/fleet/change/change_job.hpp"

#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include "fleet/change/texts.hpp"
#include "fleet/change/unnamed.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace blactl::fleet {

using dronecan::Outcome;
using dronecan::Step;

namespace {

bool has_failed(const std::vector<RegisterChange>& changes) {
  return std::ranges::any_of(changes, [](const RegisterChange& change) {
    return change.error || change.status == ChangeStatus::failed ||
           change.status == ChangeStatus::mismatch;
  });
}

/// The values after ERASE; the IDs are written again after it.
bla::Values expected_after_erase(const Plan& plan) {
  bla::Values expected = plan.expected;
  for (const RegisterChange& change : plan.changes) {
    expected[change.parameter->address] = change.before.value_or(0);
  }
  return expected;
}

} // namespace

std::string_view name(ChangeStage stage) {
  switch (stage) {
  case ChangeStage::erase: return "erase";
  case ChangeStage::write: return "write";
  case ChangeStage::save: return "save";
  case ChangeStage::restart: return "restart";
  case ChangeStage::read: return "read";
  case ChangeStage::end: return "end";
  }
  return {};
}

ChangeJob::ChangeJob(Roster& roster, const bla::Profiles& profiles, const Plan& plan,
                     Options options)
    : roster_(roster), profiles_(profiles), plan_(plan), options_(std::move(options)),
      servo_(plan.before.servo), result_(as_planned(plan)) {
  result_.was_begun = true;
}

Step ChangeJob::next(const Outcome& outcome) {
  if (stage_ == Stage::begin) {
    begin_ = outcome.at;
    return enter(first_stage(), outcome.at);
  }
  Step step = job_->next(outcome);
  if (!step.is_end()) {
    return step;
  }
  return enter(conclude_stage(outcome.kind == Outcome::Kind::cancelled), outcome.at);
}

bool ChangeJob::must_finish() const {
  return stage_ == Stage::read_back || (stage_ == Stage::restart && restart_->must_finish());
}

std::optional<ChangeStage> ChangeJob::told_as(Stage stage) const {
  switch (stage) {
  case Stage::erase: return ChangeStage::erase;
  case Stage::write: return ChangeStage::write;
  case Stage::restart:
    return plan_.restart == RestartKind::save ? ChangeStage::save : ChangeStage::restart;
  case Stage::read_erased:
  case Stage::look:
  case Stage::read_back:
  case Stage::read_shown: return ChangeStage::read;
  case Stage::end: return ChangeStage::end;
  case Stage::begin: break;
  }
  return std::nullopt;
}

bool ChangeJob::is_stopped(Stage next) const {
  const bool changes = next == Stage::erase || next == Stage::write || next == Stage::restart;
  return changes && options_.pace != nullptr && options_.pace->is_stopped();
}

/// Called when another servo has failed.
void ChangeJob::stop() {
  const std::uint8_t id = servo_.id.value();
  result_.was_begun = erase_ || write_;
  result_.is_verified = false;
  if (result_.was_begun) {
    result_.error =
        Error{Code::state, say<texts::stopped_by_another>(id), say<texts::run_again_hint>(), id};
  }
}

void ChangeJob::tell_failure() const {
  if (options_.pace != nullptr && !result_.is_done()) {
    options_.pace->has_failed = true;
  }
}

ChangeJob::Stage ChangeJob::first_stage() const {
  return reads_again_ ? Stage::read_back : plan_.erase ? Stage::erase : after_erase();
}

ChangeJob::Stage ChangeJob::after_erase() const {
  return plan_.changes.empty() ? after_write() : Stage::write;
}

ChangeJob::Stage ChangeJob::after_write() const {
  return plan_.restart ? Stage::restart : to_show();
}

ChangeJob::Stage ChangeJob::to_show() const {
  return brings_unread_rom() || std::ranges::any_of(plan_.shown,
                                                    [this](bla::Address each) {
                                                      return !servo_.identity.is_setting(each);
                                                    })
             ? Stage::read_shown
             : Stage::end;
}

/// A plain restart: its ROM may hold another servo ID, which is not read.
bool ChangeJob::brings_unread_rom() const {
  return plan_.restart == RestartKind::restart && !plan_.proves_rom;
}

std::unique_ptr<SaveRestartJob> ChangeJob::restart() const {
  const auto given = bla::find(plan_.expected, bla::address::static_node_id);
  SaveRestartJob::Options options{.kind = *plan_.restart,
                                  .start = options_.start,
                                  .come_back = options_.come_back,
                                  .patience = options_.identification.patience,
                                  .pace = options_.pace,
                                  .expected_free_since = begin_,
                                  .given_servo_id = plan_.given_servo_id(),
                                  .may_be_driven = may_be_driven(),
                                  .next_servo_id = plan_.rom_servo_id};
  if (given.value_or(0) != 0) {
    options.expected = dronecan::NodeId(static_cast<std::uint8_t>(*given));
  }
  return std::make_unique<SaveRestartJob>(roster_, servo_, options);
}

/// After a save everything is read.
std::unique_ptr<WriteJob> ChangeJob::write() const {
  const bool is_read_later = plan_.restart == RestartKind::save;
  const auto echo = is_read_later ? WriteJob::Echo::suffices : WriteJob::Echo::is_checked;
  return std::make_unique<WriteJob>(
      roster_, servo_, plan_.changes,
      WriteJob::Options{.patience = options_.identification.patience,
                        .echo = echo,
                        .may_be_driven = may_be_driven(),
                        .while_driven = options_.while_driven,
                        .premises = premises(),
                        .surveyed = options_.pace != nullptr ? options_.pace->surveyed : never});
}

/// Begins a stage; one without requests ends at once.
Step ChangeJob::enter(Stage stage, Time now) {
  for (;; stage = conclude_stage(false)) {
    if (is_stopped(stage)) {
      stop();
      stage = Stage::end;
    }
    stage_ = stage;
    if (const auto told = told_as(stage); told && options_.entered) {
      options_.entered(servo_, *told);
    }
    const Patience patience = options_.identification.patience;
    switch (stage) {
    case Stage::erase:
      job_ =
          (erase_ = std::make_unique<EraseJob>(roster_, servo_, patience, may_be_driven())).get();
      break;
    case Stage::write: job_ = (write_ = write()).get(); break;
    case Stage::restart:
      result_.was_restarted = true;
      job_ = (restart_ = restart()).get();
      break;
    case Stage::read_erased:
    case Stage::look:
    case Stage::read_back: job_ = (read_ = read_configuration()).get(); break;
    case Stage::read_shown: job_ = (read_ = read_shown()).get(); break;
    case Stage::begin:
    case Stage::end: tell_failure(); return std::nullopt;
    }
    if (Step step = job_->next({Outcome::Kind::start, {}, now}); !step.is_end()) {
      return step;
    }
  }
}

ChangeJob::Stage ChangeJob::conclude_stage(bool cancelled) {
  const Stage ended = stage_;
  Stage following = Stage::end;
  switch (ended) {
  case Stage::erase: following = conclude_erase(); break;
  case Stage::read_erased: following = conclude_read_erased(); break;
  case Stage::write: following = conclude_write(); break;
  case Stage::restart: following = conclude_restart(); break;
  case Stage::look: following = conclude_look(); break;
  case Stage::read_back: following = conclude_read_back(); break;
  case Stage::read_shown: conclude_read_shown(); break;
  case Stage::begin:
  case Stage::end: break;
  }
  blame_other_writer();
  tell_reach();
  if (servo_.unique_id && result_.node_id_after &&
      roster_.member(*result_.node_id_after).is_another_unit(*servo_.unique_id)) {
    result_.node_id_after = std::nullopt; // it is somewhere else
    if (result_.returned && !result_.error) {
      result_.error = doubled(roster_, *result_.returned);
      result_.is_verified = result_.saved = false;
    }
  }
  if (!cancelled) {
    return following;
  }
  explain_interruption(ended);
  return Stage::end;
}

ChangeJob::Stage ChangeJob::conclude_erase() {
  result_.error = erase_->error();
  was_erased_ = erase_->is_sent();
  return result_.error ? Stage::end : Stage::read_erased;
}

/// The settings are as before the ERASE that the servo refused.
bool ChangeJob::is_as_before() const {
  bla::Values before = plan_.expected;
  for (auto& [address, raw] : before) {
    raw = plan_.before.raw(address).value_or(raw);
  }
  return !compare(read_->snapshot(), before);
}

/// If the registers show that a request without a response was not carried out, it is sent again.
ChangeJob::Stage ChangeJob::conclude_read_erased() {
  take_reading(read_->snapshot());
  if (erase_->is_refused() && is_as_before()) {
    was_erased_ = false;
    const std::uint8_t id = servo_.id.value();
    result_.error = Error{Code::refused, say<texts::opcode_refused>(id, "ERASE"),
                          say<texts::opcode_refused_hint>(id), id};
    return Stage::end;
  }
  result_.error = compare(read_->snapshot(), expected_after_erase(plan_));
  if (!result_.error) {
    result_.error = check_commands(read_->snapshot());
  }
  result_.is_verified = !result_.error;
  result_.values_read = plan_.expected.size();
  if (!result_.error) {
    servo_ = read_->snapshot().servo;
    return after_erase();
  }
  const bool ignored =
      result_.error->code == Code::mismatch && !erase_->is_confirmed() && !erase_->is_refused();
  if (ignored && std::exchange(may_erase_again_, false)) {
    return Stage::erase;
  }
  const std::uint8_t id = servo_.id.value();
  const bool has_restarted = roster_.member(servo_.id).boots != plan_.before.servo.boot;
  if (result_.error->code == Code::mismatch && has_restarted) {
    result_.error =
        Error{Code::state, say<texts::erased_no_more>(id), say<texts::run_again_hint>(), id};
  } else if (ignored) {
    result_.error = Error{Code::timeout, say<texts::opcode_ignored>(id, "ERASE"),
                          say<texts::no_answer_hint>(), id};
  }
  return Stage::end;
}

ChangeJob::Stage ChangeJob::conclude_write() {
  result_.changes = write_->changes();
  servo_ = write_->servo();
  for (RegisterChange& change : result_.changes) {
    blame_other_writer(change);
    if (change.parameter->address == bla::address::static_node_id && change.after) {
      roster_.learn_static_node_id(plan_.before.servo.id, change.after);
    }
    if (change.parameter->address == bla::address::servo_id && change.after) {
      result_.servo.servo_id = change.after;
    }
  }
  const std::uint8_t id = plan_.before.servo.id.value();
  if (plan_.erase && roster_.member(plan_.before.servo.id).boots != plan_.before.servo.boot) {
    result_.error =
        Error{Code::state, say<texts::erased_no_more>(id), say<texts::run_again_hint>(), id};
  }
  result_.is_verified = !result_.error && !has_failed(result_.changes);
  if (result_.is_verified && servo_.boot != plan_.before.servo.boot) {
    result_.warnings.push_back({"restarted", say<texts::restarted_while_written>()});
  }
  return result_.is_verified ? after_write() : Stage::end;
}

ChangeJob::Stage ChangeJob::conclude_restart() {
  constexpr int most_looks = 3;
  if (restart_->is_unproven() && ++looks_ <= most_looks) {
    return Stage::look;
  }
  result_.error = restart_->error();
  if (restart_->is_unproven()) {
    const std::uint8_t id = servo_.id.value();
    const auto writer = restart_->writer(); // as it was before, or it would be another value
    result_.error =
        Error{Code::state,
              writer ? say<texts::written_while_read>(id, writer->value())
                     : say<texts::restarts_while_read>(id),
              writer ? say<texts::other_writer_hint>() : say<texts::restarts_again_hint>(), id};
  }
  result_.may_have_saved = *plan_.restart == RestartKind::save && restart_->may_have_happened();
  if (plan_.restart == RestartKind::restart && restart_->may_have_happened()) {
    std::ranges::move(written_before_restart(roster_, plan_, restart_->sent_at()),
                      std::back_inserter(result_.warnings));
  }
  result_.duration = restart_->duration();
  result_.returned = result_.node_id_after = restart_->returned();
  if (!restart_->is_sent() || restart_->has_run_on()) {
    result_.node_id_after = servo_.id; // it stayed
  }
  result_.is_verified = *plan_.restart == RestartKind::restart && !result_.error;
  if (result_.error && restart_->is_sent() && !restart_->has_run_on()) {
    result_.doubt();
  }
  if (result_.error || !result_.returned) {
    return Stage::end;
  }
  back_ = roster_.member(*result_.returned);
  return brings_unread_rom() ? to_show() : Stage::read_back;
}

/// Before SAVE: RAM must still hold the values to be saved.
ChangeJob::Stage ChangeJob::conclude_look() {
  const Snapshot& now = read_->snapshot();
  const std::uint8_t id = servo_.id.value();
  auto difference = compare(now, plan_.expected);
  if (!difference) {
    servo_ = now.servo;
    servo_.since = read_->began(); // what was written before, has been read since
    return Stage::restart;
  }
  const bool has_restarted = now.has_restarted || now.servo.boot != servo_.boot;
  result_.error = difference->code == Code::mismatch
                      ? Error{Code::state,
                              has_restarted ? say<texts::restarted_before_save>(id)
                                            : say<texts::changed_before_save>(id),
                              say<texts::run_again_hint>(), id}
                      : std::move(*difference);
  result_.is_verified = false;
  tell_saved(now);
  return Stage::end;
}

/// Why what was read after the restart is of another unit, however alike; empty: it is not.
std::optional<Error> ChangeJob::of_another_unit(const Snapshot& now) const {
  const std::uint8_t id = now.servo.id.value();
  if (now.servo.unique_id && servo_.unique_id && now.servo.unique_id != servo_.unique_id) {
    return Error{Code::state, say<texts::another_servo>(id), say<texts::run_again_hint>(), id};
  }
  const auto before = plan_.before.servo.identity.readings().serial_number;
  if (has_other_serial(now.servo, before)) {
    return other_serial(now.servo, *before);
  }
  return std::nullopt;
}

/// Whether it has restarted once more behind a silence: what others wrote to RAM since then was not
/// heard, and passes for what ROM holds.
bool ChangeJob::may_have_missed(const Snapshot& now) const {
  const Member member = roster_.member(now.servo.id);
  return member.boots != back_.boots && member.missed_until > back_.last_heard;
}

ChangeJob::Stage ChangeJob::conclude_read_back() {
  const Snapshot& now = read_->snapshot();
  if (auto other = of_another_unit(now)) { // nothing that it holds is told
    result_.error = std::move(other);
    result_.is_verified = result_.saved = false;
    result_.node_id_after = std::nullopt;
    result_.doubt();
    return Stage::end;
  }
  take_reading(now);
  health_ = roster_.member(now.servo.id).health();
  result_.values_read = plan_.expected.size();
  result_.error = compare(now, plan_.expected);
  // values that RAM held before and does not hold now were not written to ROM
  if (auto unreadable = check_rom(now)) {
    result_.error = std::move(unreadable);
    result_.rom = unread_rom(now);
    result_.is_rom_unread = true;
  } else if (result_.error && result_.error->code == Code::mismatch) {
    result_.error->hint =
        restart_->is_confirmed() ? say<texts::rom_differs_hint>() : say<texts::run_again_hint>();
  }
  const std::uint8_t id = now.servo.id.value();
  if (const auto writer = roster_.setter_of(now.servo.id, restart_->sent_at());
      writer && !result_.error) {
    result_.error = Error{Code::state, say<texts::written_by_other>(id, writer->value()),
                          say<texts::other_writer_hint>(), id};
    result_.doubt(); // it may go on
    result_.is_verified = result_.saved = false;
    return Stage::end;
  }
  if (!unproven_ && may_have_missed(now)) {
    unproven_ =
        Error{Code::state, say<texts::unproven_since>(id), say<texts::run_again_hint>(), id};
  }
  result_.error = result_.error ? std::move(result_.error) : unproven_;
  result_.is_verified = !result_.error;
  result_.saved = result_.is_verified && *plan_.restart == RestartKind::save;
  if (result_.error) {
    tell_saved(now);
    return Stage::end;
  }
  result_.rom = rom_reading(now);
  return to_show();
}

/// Nothing depends on it: unreadable values are not shown.
void ChangeJob::conclude_read_shown() {
  result_.now = read_->snapshot().values();
  if (brings_unread_rom()) {
    const Snapshot& now = read_->snapshot();
    result_.servo.servo_id = bla::find(result_.now, bla::address::servo_id);
    if (const auto unreadable = check_rom(now)) {
      result_.rom = unread_rom(now);
      result_.warnings.push_back({"rom_unread", unreadable->message});
    }
    result_.now.erase(bla::address::servo_id);
    result_.now.erase(bla::address::fault_warning);
  }
}

} // namespace blactl::fleet
