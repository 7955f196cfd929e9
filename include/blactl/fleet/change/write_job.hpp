#pragma once
// Writes registers of one identified servo and verifies each by its response, or by reading it
// again.

#include "blactl/bla/parameter.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/register_access.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/run_proof.hpp"
#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/change/register_change.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// Sends the planned changes in order, once the servo has proven to be the same unit; registers
/// that already have the value become `unchanged`. A response may show a clamped or refused value
/// (requirement 73): then the register is read at once. If the whole servo is not read afterwards,
/// each named register is read after the last write, which may have changed others; one that was
/// held already is written then. At
/// the end, and before a refusal is believed, the servo must prove that it has not restarted, also
/// if all values were unchanged, as they were read some time ago. Values written before a restart
/// are written again, as they were in RAM only, provided that the values on which the plan was
/// judged have come back from ROM as they were. If the guard forbids a write, no more are sent, and
/// those that were made are proven.
class WriteJob final : public dronecan::Job {
 public:
  /// The proof of a write whose response shows the requested value.
  enum class Echo : std::uint8_t {
    is_checked, ///< the register, read again
    suffices,   ///< the response: everything is read after the following restart
  };

  /// A setting by which the changes were judged; not one of them. Once another node has written to
  /// it nothing more is sent.
  struct Premise {
    const bla::Parameter* parameter = nullptr;
    std::int64_t raw = 0;
  };

  struct Options {
    Patience patience{};
    Echo echo = Echo::is_checked;
    bool may_be_driven = false; ///< also while another node drives the servo
    bool while_driven = false;  ///< also a servo ID that another node commands
    std::vector<Premise> premises{};
    Time surveyed = never; ///< when all others were asked for their servo IDs
  };

  /// `roster` outlives the job.
  WriteJob(const Roster& roster, Servo servo, std::vector<RegisterChange> changes, Options options);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  [[nodiscard]] const std::vector<RegisterChange>& changes() const { return changes_; }

  /// Whether a write has left, or may have.
  [[nodiscard]] bool has_written() const { return has_written_; }

  /// Whether one of them may have been carried out: not if the servo is known to hold what it held
  /// before.
  [[nodiscard]] bool may_have_changed() const;

  /// The servo as last recognised.
  [[nodiscard]] const Servo& servo() const { return servo_; }

 private:
  enum class At : std::uint8_t { begin, unit, write, read, look, proof, premise };

  [[nodiscard]] dronecan::Step begin(Time now);
  [[nodiscard]] dronecan::Step go_on(Time now);
  [[nodiscard]] dronecan::Step judge_unit(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step prove(Time now);
  [[nodiscard]] dronecan::Step judge_proof(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step after_write(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step wrote(Time now);
  void take_written();
  void doubt_unread(const bla::Parameter& last, std::optional<std::int64_t> raw);
  [[nodiscard]] dronecan::Step hold_off(Time now);
  void write_after_others(std::size_t change);
  [[nodiscard]] bool may_try_again();
  [[nodiscard]] std::optional<std::int64_t> next_servo_id() const;
  [[nodiscard]] std::optional<Error> not_any_more() const;
  [[nodiscard]] bool is_taken(dronecan::NodeId given) const;
  void move_on();
  [[nodiscard]] dronecan::Step after_read(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step doubt(std::size_t change, Time now);
  [[nodiscard]] dronecan::Step next_look(Time now);
  [[nodiscard]] dronecan::Step judge_look(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step check_premises(Time now);
  [[nodiscard]] dronecan::Step next_premise(Time now);
  [[nodiscard]] dronecan::Step judge_premise(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step write_again(Time now);
  [[nodiscard]] bool doubt_unchanged();
  void judge(RegisterChange& change) const;
  [[nodiscard]] std::size_t unproven() const;
  [[nodiscard]] Error told_by(const Error& error) const;
  [[nodiscard]] dronecan::Step lose(Error error);
  [[nodiscard]] dronecan::Step give_up(std::size_t blamed, Error error);

  [[nodiscard]] std::uint32_t boots() const { return roster_.member(servo_.id).boots; }

  const Roster& roster_;
  Servo servo_;
  std::vector<RegisterChange> changes_;
  Options options_;
  Guard guard_;
  At at_ = At::begin;
  Time begun_{};
  std::size_t current_ = 0; ///< the change being written or checked
  bool has_written_ = false;
  int tries_ = 0;                      ///< of this change, beyond the first
  bool is_lost_ = false;               ///< no response to the write of this change
  std::optional<std::size_t> doubted_; ///< the change whose register differs from what was written
  int restarts_ = 0;                   ///< seen while writing
  std::size_t looked_ = 0;  ///< the change whose register is being read after the last write
  std::size_t premise_ = 0; ///< being read again after a restart
  std::optional<RunProof> run_proof_;
};

} // namespace blactl::fleet
