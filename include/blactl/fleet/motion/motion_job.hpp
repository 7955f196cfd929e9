#pragma once
// Commands one servo for a limited time, watches it meanwhile, and brings it to a defined end.

#include "blactl/fleet/bus/bystanders.hpp"
#include "blactl/fleet/bus/roster.hpp"
#include "blactl/fleet/bus/run_proof.hpp"
#include "blactl/fleet/motion/motion_plan.hpp"
#include "blactl/fleet/motion/motion_result.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace blactl::fleet {

/// Writes 0x00, 0x01 or 0x02 repeatedly, at intervals below half of 0x27 (requirement 149), and
/// reads angle, speed and torque in between. Before every write it checks the traffic: if the
/// vehicle reports armed, another node commands, or a second unit has the ID, nothing more is
/// written, and the servo's own timeout acts (0x26, 0x27). The end is a command, too: a speed or
/// torque of 0; for an angle that was not reached, the present angle. It is repeated until the
/// shaft stands still, so that no timeout looks like a stop, and read back. A servo that restarted
/// is brought to its end as soon as it is recognised. Finally it must prove that it has run without
/// a restart.
class MotionJob final : public dronecan::Job {
 public:
  struct Options {
    Patience patience{};
    bool while_driven = false;
    /// The present time: a process that was stopped may receive a response long after it came, but
    /// sends its next command now.
    std::function<Time()> now;
    std::function<void(const MotionSample&)> sampled{}; ///< may be empty
    /// Sends an ArrayCommand; required if MotionPlan::by_servo_id.
    std::function<void(const dronecan::ArrayCommand&)> broadcast{};
  };

  /// `roster` and `plan` outlive the job.
  MotionJob(const Roster& roster, const MotionPlan& plan, Options options);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// From the first command until the end is proven.
  [[nodiscard]] bool must_finish() const override { return result_.has_commanded(); }

  /// Begins the end now.
  void stop() { result_.is_cut = true; }

  [[nodiscard]] const MotionResult& result() const { return result_; }

 private:
  enum class At : std::uint8_t {
    begin,
    unit,
    look,     ///< reads the conditions of the plan
    pause,    ///< waits until the next command or sample is due
    write,    ///< writes a command
    shown,    ///< reads the register back
    read,     ///< reads a sample
    settings, ///< reads the servo's behaviour after the commands
    who,      ///< asks after a silence whether it is the same unit
    faults,   ///< reads whether a protection holds its output off
    proof,    ///< proves that the servo is the same, or has not restarted
  };
  enum class Phase : std::uint8_t { moving, ending, ended };

  // Before the first command.
  [[nodiscard]] dronecan::Step judge_unit(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step look();
  [[nodiscard]] dronecan::Step judge_condition(const dronecan::Outcome& outcome);

  // Commands and samples, before and during the end.
  [[nodiscard]] dronecan::Step go_on();
  [[nodiscard]] dronecan::Step move();
  [[nodiscard]] dronecan::Step end();
  [[nodiscard]] std::optional<Error> disturbed_in_the_end() const;
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
  [[nodiscard]] bool stands(const MotionSample& sample) const;
  [[nodiscard]] Error not_standing() const;
  [[nodiscard]] dronecan::Step read_settings();
  [[nodiscard]] dronecan::Step judge_setting(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step read_faults();
  [[nodiscard]] dronecan::Step judge_fault(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step prove();
  void judge_output();
  [[nodiscard]] dronecan::Step recognise();
  [[nodiscard]] dronecan::Step judge_who(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step judge_proof(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step fail(Error error);
  [[nodiscard]] dronecan::Step give_up(Error error);
  void add_error(Error error);

  [[nodiscard]] std::optional<Error> forbidden() const;
  [[nodiscard]] std::optional<Error> disturbed() const;
  [[nodiscard]] std::optional<dronecan::NodeId> newcomer() const;
  [[nodiscard]] bool has_restarted() const;
  [[nodiscard]] bool may_be_another();
  [[nodiscard]] Duration usual_time() const;
  [[nodiscard]] Duration patient_time(int unanswered) const;
  [[nodiscard]] Time command_due() const;
  [[nodiscard]] bool has_answered(const dronecan::Outcome& outcome);
  [[nodiscard]] bool is_silent() const;
  [[nodiscard]] dronecan::Step go_on_unless_silent();
  [[nodiscard]] Error silent_since() const;
  [[nodiscard]] Error not_taken(std::optional<std::int64_t> held, Code code) const;
  [[nodiscard]] Patience once() const;
  [[nodiscard]] std::optional<std::int64_t> value(const dronecan::Outcome& outcome,
                                                  bla::Address address) const;

  [[nodiscard]] std::uint8_t id() const { return plan_.servo().id.value(); }

  const Roster& roster_;
  const MotionPlan& plan_;
  Options options_;
  Servo servo_; ///< as last recognised
  Phase phase_ = Phase::moving;
  At at_ = At::begin;
  Time now_{};             ///< when the next step is decided
  bla::Values conditions_; ///< still to be read
  Time looked_at_{};       ///< the time they were read
  Bystanders others_;      ///< since the start
  std::int64_t target_ = 0;
  Time last_command_{};
  Time heard_{};                       ///< its last frame, at the step before
  bool is_unsure_ = false;             ///< it may be another unit
  Time told_who_{};                    ///< when it last told its serial number
  bool is_another_ = false;            ///< it is
  bool reads_first_ = false;           ///< a read is due before the next command
  Time ended_{};                       ///< the time its end began
  bool has_end_ = false;               ///< the final command is known
  std::optional<MotionSample> seen_{}; ///< the last complete one, once the final command is known
  int standing_ = 0;                   ///< consecutive samples
  MotionSample stood_{};               ///< the first of them
  bool has_crept_ = false;             ///< slower than its speed register shows
  int unanswered_ = 0;                 ///< consecutive
  Time answered_{};                    ///< the last response, or the beginning of the end
  Duration slowest_{}, latest_{};      ///< of the responses
  int restarts_ = 0;
  MotionSample sample_{};
  std::size_t reading_ = 0; ///< index of 0x08-0x0A
  Time sample_due_{};
  bla::Values faults_{}; ///< fault registers at the end, and what details them
  bla::Address asked_;   ///< the next of them
  std::optional<RunProof> proof_;
  MotionResult result_;
};

} // namespace blactl::fleet
