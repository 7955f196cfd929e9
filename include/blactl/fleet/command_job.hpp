#pragma once
// Commands one servo for a bounded time, watches it meanwhile, and brings it to a defined end.

#include "blactl/fleet/command_plan.hpp"
#include "blactl/fleet/command_result.hpp"
#include "blactl/fleet/roster.hpp"
#include "blactl/fleet/run_proof.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// Writes 0x00, 0x01 or 0x02 again and again, at less than half of 0x27 (requirement 149), and
/// reads angle, speed and torque in between. Before every write it looks at what was heard: a
/// vehicle that says armed, another node that commands, a second unit on the ID, a restart end it.
/// In the end a speed or torque is set to 0 and the shaft must stand; an angle that was not reached
/// is commanded where the shaft is. Last the servo must prove that it ran on. Where nothing may be
/// written any more, the servo's own timeout (0x26, 0x27) acts.
class CommandJob final : public dronecan::Job {
 public:
  struct Options {
    Patience patience{};
    bool while_driven = false;
    /// An answer may be told of long after it came, of a process that was stopped: what is sent
    /// then is sent now.
    std::function<Time()> now;
    std::function<void(const CommandSample&)> sampled{}; ///< may be empty
    /// Sends an ArrayCommand; needed where CommandPlan::by_servo_id.
    std::function<void(const dronecan::ArrayCommand&)> broadcast{};
  };

  /// `roster` and `plan` outlive the job.
  CommandJob(const Roster& roster, const CommandPlan& plan, Options options);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// Once something was commanded, until the end is proven.
  [[nodiscard]] bool must_finish() const override { return result_.has_commanded(); }

  /// Brings it to its end now.
  void stop() { result_.is_cut = true; }

  [[nodiscard]] const CommandResult& result() const { return result_; }

 private:
  enum class At : std::uint8_t {
    begin,
    unit,
    look,
    run,
    write,
    shown, ///< whether the register shows an ArrayCommand
    read,
    end_write,
    end,
    proof,
  };

  [[nodiscard]] dronecan::Step judge_unit(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step look();
  [[nodiscard]] dronecan::Step judge_condition(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step go_on();
  [[nodiscard]] dronecan::Step command();
  [[nodiscard]] dronecan::Step judge_echo(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step judge_shown(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step ask_sample();
  [[nodiscard]] dronecan::Step take_sample(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step finish();
  [[nodiscard]] dronecan::Step end_sample();
  [[nodiscard]] dronecan::Step hold();
  [[nodiscard]] dronecan::Step write_end(std::int64_t raw);
  [[nodiscard]] dronecan::Step judge_end(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step stand();
  [[nodiscard]] dronecan::Step prove();
  [[nodiscard]] dronecan::Step judge_proof(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step fail(Error error);
  [[nodiscard]] dronecan::Step give_up(Error error);

  [[nodiscard]] std::optional<Error> forbidden() const;
  [[nodiscard]] std::optional<dronecan::NodeId> newcomer() const;
  [[nodiscard]] bool has_answered(const dronecan::Outcome& outcome);
  [[nodiscard]] Error silent_since() const;
  [[nodiscard]] Error not_taken(std::optional<std::int64_t> held, Code code) const;
  [[nodiscard]] CommandSample angle_sample(const dronecan::Outcome& outcome,
                                           std::optional<std::int64_t> angle) const;
  [[nodiscard]] Patience patience_until(Time deadline) const;
  [[nodiscard]] std::optional<std::int64_t> value(const dronecan::Outcome& outcome,
                                                  bla::Address address) const;

  [[nodiscard]] std::uint8_t id() const { return plan_.servo().id.value(); }

  const Roster& roster_;
  const CommandPlan& plan_;
  Options options_;
  At at_ = At::begin;
  Time now_{};                             ///< when the next step is decided
  bla::Values conditions_;                 ///< still to be looked at
  std::vector<dronecan::NodeId> others_{}; ///< that were there when it began
  bool is_ending_ = false;                 ///< the end was commanded
  std::int64_t target_ = 0;
  Time last_command_{};
  int unanswered_ = 0; ///< in a row
  CommandSample sample_{};
  std::size_t reading_ = 0; ///< which of 0x08-0x0A
  Time sample_due_{};
  std::optional<RunProof> proof_;
  CommandResult result_;
};

} // namespace blactl::fleet
