#pragma once
// Writes registers of one identified servo and proves each by its answer, or by reading it again.

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/registers.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/run_proof.hpp"
#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/change/register_change.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// Sends the planned changes in order, once the servo has said that it is still the one that is
/// meant; those that hold the value already are `unchanged` before.
/// An answer may show a clamped or refused value (requirement 73): then, and where nobody reads the
/// whole servo after it, the register is read again after the write. In the end, and before a
/// refusal is believed, the servo must prove that it ran on, also where all values were held
/// already: they were read some time ago. What was written before a restart is written again: it
/// was in RAM only. What the guard forbids ends the writing; what was written is proven then, too.
class WriteJob final : public dronecan::Job {
 public:
  /// What proves a write whose answer shows the requested value.
  enum class Echo : std::uint8_t {
    is_checked, ///< the register, read again
    suffices,   ///< that answer: everything is read after the restart that follows
  };

  /// `roster` outlives the job. `may_be_driven`: also while another node drives the servo.
  WriteJob(const Roster& roster, Servo servo, std::vector<RegisterChange> changes,
           Patience patience, Echo echo = Echo::is_checked, bool may_be_driven = false);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] const std::vector<RegisterChange>& changes() const { return changes_; }

  /// A write has left, or may have.
  [[nodiscard]] bool has_written() const { return has_written_; }

  /// The servo as it was recognised last.
  [[nodiscard]] const Servo& servo() const { return servo_; }

 private:
  enum class At : std::uint8_t { begin, unit, write, read, proof };

  [[nodiscard]] dronecan::Step begin(Time now);
  [[nodiscard]] dronecan::Step go_on(Time now);
  [[nodiscard]] dronecan::Step judge_unit(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step prove(Time now);
  [[nodiscard]] dronecan::Step judge_proof(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step after_write(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step wrote(Time now);
  [[nodiscard]] dronecan::Step hold_off(Time now);
  [[nodiscard]] dronecan::Step after_read(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step write_again(Time now);
  [[nodiscard]] bool doubt_unchanged();
  void judge();
  [[nodiscard]] std::size_t unproven() const;
  [[nodiscard]] Error told_by(const Error& error) const;
  [[nodiscard]] dronecan::Step give_up(std::size_t blamed, Error error);

  [[nodiscard]] std::uint32_t boots() const { return roster_.member(servo_.id).boots; }

  const Roster& roster_;
  Servo servo_;
  std::vector<RegisterChange> changes_;
  Patience patience_;
  Echo echo_;
  Guard guard_;
  At at_ = At::begin;
  std::size_t current_ = 0; ///< the change that is being made or looked at
  bool has_written_ = false;
  bool is_lost_ = false;     ///< no answer to the write of this change
  bool is_doubtful_ = false; ///< the register does not hold what was written
  int restarts_ = 0;         ///< seen while writing
  std::optional<RunProof> run_proof_;
};

} // namespace blactl::fleet
