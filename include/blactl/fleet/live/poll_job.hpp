#pragma once
// Asks one servo for registers again and again.

#include "blactl/fleet/bus/identification.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// What is asked of every servo, and how often.
struct PollPlan {
  std::vector<bla::Address> often;          ///< in every round
  std::vector<bla::Address> seldom;         ///< one of them a round
  Duration round = std::chrono::seconds(1); ///< from the beginning of a round to the next
};

/// Identifies a servo and then reads it in rounds, until it is cancelled or the node is no BLA
/// servo. What it answers is heard like everything on the bus: the job keeps nothing. A servo that
/// restarted is identified again; one that is silent is asked again as soon as it is heard. One
/// that is not meant is not asked for anything more, until it restarts: it may be another then.
class PollJob final : public dronecan::Job {
 public:
  /// What to read of a servo besides, now that it is identified; empty: it is not meant.
  using Further = std::function<std::optional<PollPlan>()>;

  /// All references outlive the job, and `plan` may change meanwhile.
  PollJob(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
          Identification::Options options, const PollPlan& plan, Further further);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// It is asked in rounds, or will be as far as is known.
  [[nodiscard]] bool polls() const { return polls_; }

 private:
  enum class At : std::uint8_t { begin, identify, rest, read };

  [[nodiscard]] dronecan::Step identify(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step begin_round(Time now);
  [[nodiscard]] dronecan::Step take_answer(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step read_next(Time now);
  [[nodiscard]] dronecan::Step rest(Time until);
  [[nodiscard]] dronecan::Step wait_for_sign(Time now);
  [[nodiscard]] dronecan::Step wait_for_restart();
  [[nodiscard]] dronecan::Step end();
  [[nodiscard]] bool has_restarted() const;

  Roster& roster_;
  dronecan::NodeId id_;
  const bla::Profiles& profiles_;
  Identification::Options options_;
  const PollPlan& plan_;
  Further further_;
  At at_ = At::begin;
  std::optional<Identification> identification_;
  std::optional<Servo> servo_;              ///< once it was identified
  std::vector<const bla::Parameter*> left_; ///< to read in this round, the last one first
  std::size_t turn_ = 0;                    ///< of the registers that are read seldom
  int unanswered_ = 0;                      ///< in a row
  bool polls_ = true;
  Time round_began_{};
};

} // namespace blactl::fleet
