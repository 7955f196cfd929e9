#include "blactl/fleet/bus/run_proof.hpp"

#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"

#include <utility>

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;
using dronecan::Step;

namespace {

/// Uptimes that may be too late to be conclusive.
constexpr int most_uptimes = 8;

/// So many servos, all switched on at once, can tell theirs early enough in the same second.
constexpr std::size_t servos_a_second = 16;

} // namespace

RunProof::RunProof(const Roster& roster, const Servo& servo, std::optional<Time> since,
                   Patience patience)
    : roster_(roster), id_(servo.id), unique_id_(servo.unique_id), boot_(servo.boot), since_(since),
      patience_(patience) {
  if (since) {
    check_.emplace(*since);
  }
}

Step RunProof::next(const Outcome& outcome) {
  switch (at_) {
  case At::begin: return ask_unit();
  case At::unit: return judge(outcome);
  case At::later:
    return outcome.kind == Outcome::Kind::cancelled ? fail(no_answer(outcome, id_, "GetNodeInfo"))
                                                    : ask_unit();
  case At::twin: break;
  }
  return roster_.is_doubled(id_) ? fail(doubled(roster_, id_)) : conclude(Verdict::ran_on);
}

Step RunProof::ask_unit() {
  at_ = At::unit;
  return ask(id_, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
}

Step RunProof::judge(const Outcome& outcome) {
  const std::uint8_t id = id_.value();
  Error silent = outcome.answered() ? Error() : no_answer(outcome, id_, "GetNodeInfo");
  const bool may_be_disturbed = outcome.answered() || silent.code == Code::timeout;
  if (may_be_disturbed && roster_.is_doubled(id_)) {
    return fail(doubled(roster_, id_));
  }
  if (!outcome.answered()) {
    return fail(std::move(silent));
  }
  const auto info = GetNodeInfo::Response::decode(outcome.payload);
  if (!info || info->unique_id != unique_id_) {
    return fail({Code::state, say<texts::another_servo>(id), say<texts::run_again_hint>(), id});
  }
  return has_another_boot() ? conclude(Verdict::restarted)
                            : judge_uptime(info->status.uptime_s, outcome);
}

Step RunProof::judge_uptime(std::uint32_t uptime_s, const Outcome& outcome) {
  if (!check_) {
    return hear_twin(outcome.at);
  }
  switch (check_->judge(uptime_s, outcome.asked, outcome.at)) {
  case UptimeCheck::Verdict::ran_on: return hear_twin(outcome.at);
  case UptimeCheck::Verdict::restarted: return conclude(Verdict::restarted);
  case UptimeCheck::Verdict::unclear: break;
  }
  if (++uptimes_ == most_uptimes) {
    return conclude(Verdict::too_late);
  }
  at_ = At::later;
  return dronecan::Pause{.until = next_turn(outcome.at),
                         .ready = [this] { return roster_.is_doubled(id_) || has_another_boot(); }};
}

/// Many servos that are asked at once are late for that reason alone. They take turns then, a
/// second each, and the delays measured before do not count.
Time RunProof::next_turn(Time now) {
  const std::size_t turns = 1 + roster_.members().size() / servos_a_second;
  if (turns > 1 && uptimes_ == 1) {
    check_.emplace(*since_);
  }
  const Time next = check_->next(now);
  const auto second = std::chrono::floor<std::chrono::seconds>(next.time_since_epoch()).count();
  const std::size_t turn = (static_cast<std::size_t>(second) + id_.value()) % turns;
  return turn == 0 ? next : check_->next(next + std::chrono::seconds(turns - turn - 1));
}

/// A second unit on this ID responds to the last request, too, a little later.
Step RunProof::hear_twin(Time now) {
  at_ = At::twin;
  return dronecan::Pause{.until = now + twin_time,
                         .ready = [this] { return roster_.is_doubled(id_); }};
}

bool RunProof::has_another_boot() const {
  return roster_.member(id_).boots != boot_;
}

Step RunProof::conclude(Verdict verdict) {
  verdict_ = verdict;
  return std::nullopt;
}

Step RunProof::fail(Error error) {
  error_ = std::move(error);
  return conclude(Verdict::failed);
}

} // namespace blactl::fleet
