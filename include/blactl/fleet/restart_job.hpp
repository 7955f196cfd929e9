#pragma once
// Makes one servo save or restart, and waits until the same servo is back.

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/registers.hpp"
#include "blactl/fleet/roster.hpp"

#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// What restarts a servo: SAVE (opcode 0: RAM to ROM, section 4.11) or RestartNode (4.10).
enum class RestartKind : std::uint8_t { save, restart };

/// The distance between the requests to several servos: their jobs share it.
struct RestartPace {
  Duration distance{};
  Time next{}; ///< when the next first request may go out
};

/// The request goes out once. Without an answer the uptime tells whether it was carried out, and
/// only if it was not the request is sent once more. The servo is recognised by its unique ID,
/// whatever node ID it comes back with; somebody must ask the nodes that appear for theirs
/// (Recognizer).
class RestartJob final : public dronecan::Job {
 public:
  struct Options {
    RestartKind kind = RestartKind::save;
    Time start{};         ///< not before
    Duration come_back{}; ///< how long it may take from the request on
    Patience patience;
    RestartPace* pace = nullptr; ///< outlives the job; null: nobody else is waited for
  };

  /// `servo` has been identified; both references outlive the job.
  RestartJob(Roster& roster, const Member& servo, Options options);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] bool must_finish() const override { return is_sent_ && !is_over_; }

  /// The servo under its present node ID; null: it is not back.
  [[nodiscard]] Member* returned() const { return returned_; }

  /// Why it is not, or what is not known: timeout, not_back, refused, state, no_acknowledge,
  /// interrupted.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /// A request has left, or may have left, this machine.
  [[nodiscard]] bool is_sent() const { return is_sent_; }

  /// From the request until it was back or given up.
  [[nodiscard]] Duration duration() const {
    return is_sent_ ? ended_at_ - sent_at_ : Duration::zero();
  }

 private:
  enum class At : std::uint8_t { begin, start, unit, young, request, settling, alive, away };

  [[nodiscard]] dronecan::Step ask_unit();
  [[nodiscard]] dronecan::Step check_unit(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step request(Time now);
  [[nodiscard]] dronecan::Step judge_answer(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step judge_life(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step wait_for_return();
  [[nodiscard]] dronecan::Step conclude();
  [[nodiscard]] dronecan::Step give_up(Error error);
  [[nodiscard]] Error not_carried_out() const;
  [[nodiscard]] Error not_back() const;
  [[nodiscard]] Error left_waiting() const;
  [[nodiscard]] bool has_answered_ok(dronecan::Bytes payload) const;
  [[nodiscard]] Member* find_returned() const;

  Roster& roster_;
  dronecan::NodeId id_;
  dronecan::UniqueId unique_id_;
  Options options_;
  At at_ = At::begin;
  std::uint32_t boot_ = 0; ///< of the servo when the request was sent
  Time sent_at_{}, ended_at_{};
  bool is_sent_ = false;
  bool is_confirmed_ = false; ///< the servo answered that it does it
  bool has_left_ = true;      ///< the last request, for certain
  bool may_repeat_ = true;
  bool is_over_ = false;
  Member* returned_ = nullptr;
  std::optional<Error> error_;
};

} // namespace blactl::fleet
