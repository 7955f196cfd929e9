#pragma once
// Commands one servo for a bounded time, watches it meanwhile, and brings it to a defined end.

#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/run_proof.hpp"
#include "blactl/fleet/motion/command_plan.hpp"
#include "blactl/fleet/motion/command_result.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace blactl::fleet {

/// Writes 0x00, 0x01 or 0x02 again and again, at less than half of 0x27 (requirement 149), and
/// reads angle, speed and torque in between. Before every write it looks at what was heard: where
/// the vehicle says armed, another node commands, or a second unit has the ID, nothing is written
/// any more, and the servo's own timeout acts (0x26, 0x27).
/// Its end is a command, too: a speed or torque of 0; for an angle that was not reached where the
/// shaft is. That is repeated until the shaft stands, so that no timeout looks like a stop, and
/// read back. A servo that restarted is brought to its end as soon as it is recognised. Last it
/// must prove that it ran on.
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
    look,     ///< at what the plan rests on
    pause,    ///< until the next command or sample is due
    write,    ///< a command
    shown,    ///< whether the register holds it
    read,     ///< a sample
    settings, ///< what the servo does now that the commands have ended
    proof,    ///< that it is the same, or ran on
  };
  enum class Phase : std::uint8_t { moving, ending, ended };

  // Before.
  [[nodiscard]] dronecan::Step judge_unit(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step look();
  [[nodiscard]] dronecan::Step judge_condition(const dronecan::Outcome& outcome);

  // Commands and samples, in either phase.
  [[nodiscard]] dronecan::Step go_on();
  [[nodiscard]] dronecan::Step move();
  [[nodiscard]] dronecan::Step end();
  [[nodiscard]] dronecan::Step command(std::int64_t raw);
  [[nodiscard]] dronecan::Step judge_echo(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step read_back();
  [[nodiscard]] dronecan::Step judge_shown(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step sample();
  [[nodiscard]] dronecan::Step take_sample(const dronecan::Outcome& outcome);
  void conclude_sample();

  // The end.
  [[nodiscard]] dronecan::Step finish();
  void choose_end();
  void watch_standing();
  [[nodiscard]] bool stands(const CommandSample& sample) const;
  [[nodiscard]] Error not_standing() const;
  [[nodiscard]] dronecan::Step read_settings();
  [[nodiscard]] dronecan::Step judge_setting(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step recognise();
  [[nodiscard]] dronecan::Step judge_proof(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step fail(Error error);
  [[nodiscard]] dronecan::Step give_up(Error error);
  void add_error(Error error);

  [[nodiscard]] std::optional<Error> forbidden() const;
  [[nodiscard]] std::optional<Error> disturbed() const;
  [[nodiscard]] std::optional<dronecan::NodeId> newcomer() const;
  [[nodiscard]] bool has_restarted() const;
  [[nodiscard]] Time command_due() const;
  [[nodiscard]] bool has_answered(const dronecan::Outcome& outcome);
  [[nodiscard]] Error silent_since() const;
  [[nodiscard]] Error not_taken(std::optional<std::int64_t> held, Code code) const;
  [[nodiscard]] Patience once() const;
  [[nodiscard]] std::optional<std::int64_t> value(const dronecan::Outcome& outcome,
                                                  bla::Address address) const;

  [[nodiscard]] std::uint8_t id() const { return plan_.servo().id.value(); }

  const Roster& roster_;
  const CommandPlan& plan_;
  Options options_;
  Servo servo_; ///< as it was recognised last
  Phase phase_ = Phase::moving;
  At at_ = At::begin;
  Time now_{};                                         ///< when the next step is decided
  bla::Values conditions_;                             ///< still to be looked at
  Time looked_at_{};                                   ///< when they were
  std::map<dronecan::NodeId, std::uint32_t> others_{}; ///< there when it began: their restarts
  std::int64_t target_ = 0;
  Time last_command_{};
  bool reads_first_ = false;            ///< a question is due before the next command
  Time ended_{};                        ///< when its end began
  bool has_end_ = false;                ///< what is commanded in the end is known
  std::optional<CommandSample> seen_{}; ///< the last whole one, once its end is known
  int standing_ = 0;                    ///< samples in a row
  CommandSample stood_{};               ///< the first of them
  bool has_crept_ = false;              ///< at a speed that its register does not show
  int unanswered_ = 0;                  ///< in a row
  int restarts_ = 0;
  CommandSample sample_{};
  std::size_t reading_ = 0; ///< which of 0x08-0x0A
  Time sample_due_{};
  std::optional<RunProof> proof_;
  CommandResult result_;
};

} // namespace blactl::fleet
