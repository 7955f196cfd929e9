#pragma once
// Makes one servo save or restart, and waits until it is back.

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/run_proof.hpp"
#include "blactl/fleet/change/guard.hpp"

#include <cstdint>
#include <optional>
#include <set>

namespace blactl::fleet {

/// The request that restarts a servo: SAVE (opcode 0: RAM to ROM, section 4.11) or RestartNode
/// (4.10).
enum class RestartKind : std::uint8_t { save, restart };

/// Shared by the jobs of several servos: the interval of their requests, and whether one has
/// failed.
struct RestartPace {
  Duration distance{};
  Time next{};                          ///< earliest time of the next first request
  std::set<dronecan::NodeId> leaving{}; ///< ordered to restart, may return under another ID
  bool stops_at_failure = false; ///< after a failure nothing is sent that changes another servo
  bool has_failed = false;
  /// The units of the whole change, which exchange their IDs, and when all others were asked.
  std::set<dronecan::UniqueId> own{};
  Time surveyed = never;

  [[nodiscard]] bool is_stopped() const { return stops_at_failure && has_failed; }
};

/// The request is sent once. Without a response the uptime shows whether it was carried out, and
/// only if not is it sent again. The servo is recognised by its unique ID, whatever its new node
/// ID; units that appear must be asked for theirs (UnitJob). A servo that sends nothing by itself
/// is asked at its node ID.
class SaveRestartJob final : public dronecan::Job {
 public:
  struct Options {
    RestartKind kind = RestartKind::save;
    Time start{};         ///< earliest time
    Duration come_back{}; ///< the longest time from the request on
    Patience patience;
    RestartPace* pace = nullptr; ///< outlives the job; null: no other servo is waited for
    /// The future node ID of the servo, if known.
    std::optional<dronecan::NodeId> expected{};
    Time expected_free_since{}; ///< whoever is heard on that ID after this is another unit
    std::optional<std::int64_t> given_servo_id{}; ///< that it has afterwards, if known to be free
    bool may_be_driven = false;                   ///< also while another node drives the servo
    std::optional<std::int64_t> next_servo_id{};  ///< that ROM brings back, as far as known
  };

  /// `servo` has a unique ID; `roster` outlives the job.
  SaveRestartJob(const Roster& roster, const Servo& servo, Options options);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] bool must_finish() const override { return is_sent_ && !is_over_; }

  /// The present node ID of the servo; empty: it is not back.
  [[nodiscard]] std::optional<dronecan::NodeId> returned() const { return returned_; }

  /// Nothing was sent: the servo has restarted, or another node wrote to it, and its settings may
  /// differ from those read.
  [[nodiscard]] bool is_unproven() const { return is_unproven_; }

  /// The node whose write is the reason of is_unproven(); empty: a restart is.
  [[nodiscard]] std::optional<dronecan::NodeId> writer() const { return writer_; }

  /// The reason why it is not back, or what is uncertain: timeout, not_back, refused, state,
  /// duplicate_node_id, no_acknowledge, interrupted; as Guard::forbids().
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /// Whether a request has left, or may have left, this machine.
  [[nodiscard]] bool is_sent() const { return is_sent_; }

  /// The time of the first request.
  [[nodiscard]] Time sent_at() const { return first_sent_at_; }

  /// Whether the servo has confirmed the request.
  [[nodiscard]] bool is_confirmed() const { return is_confirmed_; }

  /// Whether it ended with a proof that the servo did not restart: RAM is unchanged.
  [[nodiscard]] bool has_run_on() const { return has_run_on_; }

  /// A request has left, or still may, and the servo neither refused it nor went on running without
  /// a response. One that confirms it and goes on running may have carried out part of it.
  [[nodiscard]] bool may_have_happened() const {
    return is_sent_ && (is_confirmed_ || !has_run_on_ || !has_left_);
  }

  /// From the first request until it was back or given up.
  [[nodiscard]] Duration duration() const {
    return is_sent_ ? ended_at_ - first_sent_at_ : Duration::zero();
  }

 private:
  enum class At : std::uint8_t {
    begin,
    start,
    unit,
    young,
    newcomer,
    proof,
    request,
    settling,
    alive,
    away,
    call
  };

  [[nodiscard]] dronecan::Step ask_unit();
  [[nodiscard]] dronecan::Step check_unit(const dronecan::Outcome& outcome);
  [[nodiscard]] bool is_leaving(dronecan::NodeId id) const;
  [[nodiscard]] bool is_expected_id_taken() const;
  [[nodiscard]] const Member* newcomer_with_servo_id() const;
  [[nodiscard]] Time asked_since() const;
  [[nodiscard]] std::optional<Error> taken_id() const;
  [[nodiscard]] dronecan::Step judge_proof(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step request(Time now);
  [[nodiscard]] dronecan::Step judge_answer(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step hold_off(Time now);
  [[nodiscard]] dronecan::Step judge_life(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step wait_for_return(Time now);
  [[nodiscard]] bool runs_on(const dronecan::GetNodeInfo::Response& info, Time now) const;
  [[nodiscard]] dronecan::Step call(Time now);
  [[nodiscard]] dronecan::Step judge_call(const dronecan::Outcome& outcome);
  [[nodiscard]] std::optional<dronecan::NodeId> doubled_id() const;
  [[nodiscard]] bool is_another_at(dronecan::NodeId id) const;

  [[nodiscard]] bool has_news() const { return find_returned(true) || doubled_id(); }

  [[nodiscard]] dronecan::Step conclude();
  [[nodiscard]] dronecan::Step give_up(Error error);
  [[nodiscard]] bool is_after_request(Time started) const;
  [[nodiscard]] bool has_started_anew() const;
  [[nodiscard]] bool lives_on() const;
  [[nodiscard]] Error not_carried_out() const;
  [[nodiscard]] Error not_back() const;
  [[nodiscard]] Error left_waiting() const;
  [[nodiscard]] bool has_answered_ok(dronecan::Bytes payload) const;
  [[nodiscard]] std::optional<dronecan::NodeId> find_returned(bool must_operate) const;

  const Roster& roster_;
  Servo servo_;
  dronecan::NodeId id_;
  dronecan::UniqueId unique_id_;
  Time since_; ///< RAM must not have changed since
  std::optional<RunProof> run_proof_;
  Options options_;
  Guard guard_;
  At at_ = At::begin;
  int pauses_ = 0; ///< of a servo that was too young
  bool has_waited_for_newcomer_ = false;
  std::uint32_t boot_ = 0; ///< of the servo at the time of the request
  Time first_sent_at_{}, sent_at_{}, ended_at_{};
  bool is_sent_ = false;
  bool is_confirmed_ = false;
  bool has_left_ = true; ///< the last request, certainly
  bool may_repeat_ = true;
  bool is_over_ = false;
  bool is_unproven_ = false;
  std::optional<dronecan::NodeId> writer_{};
  bool is_refused_ = false;
  bool has_run_on_ = false;
  bool has_restarted_ = false;  ///< shown by its uptime, the roster may have missed it
  bool calls_expected_ = false; ///< which one it called last
  std::optional<dronecan::NodeId> returned_;
  std::optional<Error> error_;
};

} // namespace blactl::fleet
