// What must hold before SAVE or a restart is ordered: the same servo, old enough, unchanged since
// it was read, its IDs still free, and its turn.

#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/save_restart_job.hpp"

#include "fleet/change/id_texts.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Step;

namespace {

/// Uptime counts whole seconds: from this on a restart shows for certain.
constexpr std::uint32_t old_enough_s = 2;

/// One that was young so often restarts by itself.
constexpr int most_times_young = 4;

/// In which a unit that has come tells who it is.
constexpr Duration answer_time = std::chrono::seconds(2);

} // namespace

Step SaveRestartJob::ask_unit() {
  at_ = At::unit;
  return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), options_.patience);
}

/// It must be the same servo, old enough for its restart to show, and its turn.
Step SaveRestartJob::check_unit(const Outcome& outcome) {
  const std::uint8_t id = id_.value();
  if (const auto shared = doubled_id()) {
    return give_up(doubled(roster_, *shared));
  }
  if (!outcome.answered()) {
    return give_up(no_answer(outcome, id_, "GetNodeInfo"));
  }
  const auto info = GetNodeInfo::Response::decode(outcome.payload);
  if (!info || info->unique_id != unique_id_) {
    return give_up({Code::state, say<texts::another_servo>(id), say<texts::run_again_hint>(), id});
  }
  if (info->status.uptime_s < old_enough_s) {
    if (++pauses_ > most_times_young) {
      return give_up(
          {Code::state, say<texts::never_grows_old>(id), say<texts::restarts_again_hint>(), id});
    }
    at_ = At::young;
    return dronecan::Pause{.until = outcome.at +
                                    std::chrono::seconds(old_enough_s - info->status.uptime_s)};
  }
  if (const Member* newcomer = newcomer_with_servo_id();
      newcomer != nullptr && !newcomer->info && !std::exchange(has_waited_for_newcomer_, true)) {
    at_ = At::newcomer;
    return dronecan::Pause{.until = outcome.at + answer_time, .ready = [this] {
                             const Member* there = newcomer_with_servo_id();
                             return there == nullptr || there->info;
                           }};
  }
  if (auto taken = taken_id()) {
    return give_up(std::move(*taken));
  }
  // SAVE keeps the present RAM: it must be unchanged since it was read, whatever was proven since
  writer_ = roster_.writer_to(id_, servo_.since);
  if (options_.kind == RestartKind::save && writer_) {
    is_unproven_ = true;
    return std::nullopt;
  }
  if (options_.kind == RestartKind::save &&
      !has_run_since(since_, info->status.uptime_s, outcome.at)) {
    at_ = At::proof;
    run_proof_.emplace(roster_, servo_, since_, options_.patience);
    return run_proof_->next({Outcome::Kind::start, {}, outcome.at});
  }
  if (options_.pace != nullptr && outcome.at < options_.pace->next) {
    at_ = At::start;
    return dronecan::Pause{.until = options_.pace->next};
  }
  if (options_.pace != nullptr && options_.pace->is_stopped()) {
    return give_up(
        {Code::state, say<texts::stopped_by_another>(id), say<texts::run_again_hint>(), id});
  }
  return request(outcome.at);
}

bool SaveRestartJob::is_leaving(dronecan::NodeId id) const {
  return options_.pace != nullptr && options_.pace->leaving.contains(id);
}

/// The ID was free when the change began: since then a unit was heard there, or another node has
/// given it to another servo.
bool SaveRestartJob::is_expected_id_taken() const {
  const bool is_certain = options_.kind == RestartKind::save && options_.expected;
  if (!is_certain || *options_.expected == id_ || is_leaving(*options_.expected)) {
    return false;
  }
  const Member* there = roster_.find(*options_.expected);
  return (there != nullptr && there->last_heard > options_.expected_free_since) ||
         roster_.giver_of(*options_.expected, id_, options_.expected_free_since);
}

/// Another unit that has come with the given servo ID since the IDs of all were asked. It is asked
/// who it is as it comes: one of the same change may be back under another node ID.
const Member* SaveRestartJob::newcomer_with_servo_id() const {
  return options_.given_servo_id && options_.pace != nullptr
             ? roster_.newcomer_with(*options_.given_servo_id, options_.pace->surveyed, id_,
                                     options_.pace->own)
             : nullptr;
}

/// Since when it is not asked who has the given servo ID, but heard: the servo itself may have been
/// read again since the others were asked.
Time SaveRestartJob::asked_since() const {
  return options_.pace != nullptr ? std::min(servo_.since, options_.pace->surveyed) : servo_.since;
}

/// Why the IDs that the servo is to have are not free any more; empty: they are, as far as heard.
std::optional<Error> SaveRestartJob::taken_id() const {
  const std::uint8_t id = id_.value();
  if (is_expected_id_taken()) {
    return Error{Code::duplicate_node_id,
                 say<texts::id_given_is_kept>(id, options_.expected->value()),
                 say<texts::id_given_is_kept_hint>(), id};
  }
  if (!options_.given_servo_id) {
    return std::nullopt;
  }
  const Member* newcomer = newcomer_with_servo_id();
  const auto holder = newcomer != nullptr
                          ? std::optional(newcomer->id)
                          : roster_.giver_of_servo_id(*options_.given_servo_id, id_, asked_since());
  return holder ? std::optional(Error{Code::duplicate_servo_id,
                                      say<texts::servo_id_given_is_taken>(
                                          id, *options_.given_servo_id, holder->value()),
                                      say<texts::servo_id_taken_hint>(), id})
                : std::nullopt;
}

/// A servo that has not restarted until now is old enough to show a restart after this moment.
Step SaveRestartJob::judge_proof(const Outcome& outcome) {
  if (Step step = run_proof_->next(outcome); !step.is_end()) {
    return step;
  }
  const std::uint8_t id = id_.value();
  switch (run_proof_->verdict()) {
  case RunProof::Verdict::failed: return give_up(*run_proof_->error());
  case RunProof::Verdict::too_late:
    return give_up({Code::state, say<texts::saved_too_late>(id), say<texts::run_again_hint>(), id});
  case RunProof::Verdict::restarted: is_unproven_ = true; return std::nullopt;
  case RunProof::Verdict::ran_on: break;
  }
  since_ = outcome.at;
  return ask_unit();
}

} // namespace blactl::fleet
