#pragma once
// Polls the registers of one servo.

#include "blactl/fleet/bus/identification.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// The registers to poll, and how often.
struct PollPlan {
  std::vector<bla::Address> often;          ///< in every round
  std::vector<bla::Address> seldom;         ///< one of them per round
  Duration round = std::chrono::seconds(1); ///< from the start of one round to the next
};

/// Identifies a servo and then reads it in rounds, until it is cancelled or the node turns out not
/// to be a BLA servo. Its responses are taken from the bus like all traffic: the job stores
/// nothing. A servo that restarted is identified again; a silent one is asked again as soon as it
/// is heard, and who it is if another one may have come in the silence. One that is not selected is
/// left alone until it restarts: it may be another unit then.
class PollJob final : public dronecan::Job {
 public:
  /// The additional registers to read from a servo once it is identified; empty: it is not
  /// selected.
  using Further = std::function<std::optional<PollPlan>()>;

  /// All references outlive the job, and `plan` may change meanwhile.
  PollJob(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
          Identification::Options options, const PollPlan& plan, Further further);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// Whether it is read in rounds, or will be as far as is known.
  [[nodiscard]] bool polls() const { return polls_; }

 private:
  enum class At : std::uint8_t { begin, identify, rest, unit, read };

  [[nodiscard]] dronecan::Step identify(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step begin_round(Time now);
  [[nodiscard]] dronecan::Step ask_unit();
  [[nodiscard]] dronecan::Step take_answer(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step read_next(Time now);
  [[nodiscard]] dronecan::Step rest(Time until);
  [[nodiscard]] dronecan::Step wait_for_sign(Time now);
  [[nodiscard]] dronecan::Step wait_for_restart();
  [[nodiscard]] dronecan::Step end();
  [[nodiscard]] bool has_restarted() const;
  [[nodiscard]] bool is_in_doubt() const;

  Roster& roster_;
  dronecan::NodeId id_;
  const bla::Profiles& profiles_;
  Identification::Options options_;
  const PollPlan& plan_;
  Further further_;
  At at_ = At::begin;
  std::optional<Identification> identification_;
  std::optional<Servo> servo_;              ///< set once identified
  std::vector<const bla::Parameter*> left_; ///< still to be read in this round, the last one first
  std::size_t turn_ = 0;                    ///< index into the registers that are read seldom
  int unanswered_ = 0;                      ///< in a row
  bool polls_ = true;
  Time round_began_{};
};

} // namespace blactl::fleet
