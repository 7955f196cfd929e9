#pragma once
// Checks that a servo is still the same after requests, and has not restarted.

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/roster.hpp"

#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Requests GetNodeInfo for the unique ID and the uptime. If the uptime is inconclusive, as in a
/// servo that has only just started, it is requested again at suitable moments. Finally a second
/// unit on the ID has time to show.
class RunProof final : public dronecan::Job {
 public:
  enum class Verdict : std::uint8_t {
    ran_on,    ///< the same servo, without a restart in between, alone on its ID
    restarted, ///< the same servo, but RAM may have been reloaded from ROM
    failed,    ///< see error()
    too_late,  ///< the responses come too late to decide
  };

  /// The additional time for the response of a second unit on the ID.
  static constexpr Duration twin_time = std::chrono::milliseconds(20);

  /// `servo`: as recognised. It is to prove that it has run since `since`; empty: only that it is
  /// still the same, unless a restart was heard. `roster` outlives the job.
  RunProof(const Roster& roster, const Servo& servo, std::optional<Time> since, Patience patience);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] Verdict verdict() const { return verdict_; }

  /// timeout, no_acknowledge, interrupted, state (it is another unit), duplicate_node_id.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /// Whether the error is one of the last two.
  [[nodiscard]] bool has_met_another() const {
    return error_ && (error_->code == Code::state || error_->code == Code::duplicate_node_id);
  }

 private:
  enum class At : std::uint8_t { begin, unit, later, twin };

  [[nodiscard]] dronecan::Step ask_unit();
  [[nodiscard]] dronecan::Step judge(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step judge_uptime(std::uint32_t uptime_s,
                                            const dronecan::Outcome& outcome);
  [[nodiscard]] Time next_turn(Time now);
  [[nodiscard]] dronecan::Step hear_twin(Time now);
  [[nodiscard]] dronecan::Step conclude(Verdict verdict);
  [[nodiscard]] dronecan::Step fail(Error error);

  [[nodiscard]] bool has_another_boot() const;

  const Roster& roster_;
  dronecan::NodeId id_;
  std::optional<dronecan::UniqueId> unique_id_;
  std::uint32_t boot_;
  std::optional<Time> since_;
  std::optional<UptimeCheck> check_; ///< empty: restarts are allowed
  Patience patience_;
  At at_ = At::begin;
  int uptimes_ = 0; ///< that were inconclusive
  Verdict verdict_ = Verdict::failed;
  std::optional<Error> error_;
};

} // namespace blactl::fleet
