#pragma once
// Carries out the plan of one servo to its end, without waiting for any other servo.

#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/change/erase_job.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/fleet/change/result.hpp"
#include "blactl/fleet/change/save_restart_job.hpp"
#include "blactl/fleet/change/write_job.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

namespace blactl::fleet {

/// The present work on a servo, for observers.
enum class ChangeStage : std::uint8_t { erase, write, save, restart, read, end };
[[nodiscard]] std::string_view name(ChangeStage stage);

/// Called when a stage begins, with the servo as last recognised.
using StageHook = std::function<void(const Servo& servo, ChangeStage stage)>;

/// Erases and reads back, writes, restarts, recognises the servo and reads it once more: each stage
/// is its own job, and begins only if all earlier ones succeeded. If nothing proves that the servo
/// has not restarted before SAVE, RAM is read again first, as SAVE keeps its contents. Shown values
/// that are not settings are read last, after the changes.
class ChangeJob final : public dronecan::Job {
 public:
  struct Options {
    Identification::Options identification{};
    Time start{};                ///< earliest time of the restart
    Duration come_back{};        ///< the longest time of a restart
    RestartPace* pace = nullptr; ///< outlives the job; null: no other servo is waited for
    bool while_driven = false;   ///< as Manner
    StageHook entered{};         ///< may be empty
  };

  /// `roster`, `profiles` and `plan` outlive the job.
  ChangeJob(Roster& roster, const bla::Profiles& profiles, const Plan& plan, Options options);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// From the request to restart until the servo has been read.
  [[nodiscard]] bool must_finish() const override;

  /// The servo, if what was done is in RAM only: a restart loses it. Empty: it is not, or has
  /// failed.
  [[nodiscard]] std::optional<Servo> in_ram_only() const;

  /// The servo, if it was back from its restart before this time.
  [[nodiscard]] std::optional<Servo> back_before(Time time) const;

  /// For a job that has ended before others: whether the servo has restarted since its ROM was
  /// proven, as far as heard. Its ROM may be another now, or may not have been read.
  [[nodiscard]] bool has_restarted_since() const;

  /// Such a job, run once more, reads the servo again.
  void read_again();

  /// For a job that has ended before others: checks that its result still holds, as far as heard.
  /// Changes in RAM only are lost by a restart, and another node may have written since; the proof
  /// may be of another unit on the same ID. `lost`: of look_last().
  void look_back(std::optional<Error> lost = {});

  /// Whether it was ordered to save or restart, and is not back.
  [[nodiscard]] bool is_away() const { return stage_ == Stage::restart && restart_->is_sent(); }

  [[nodiscard]] bool has_ended() const { return stage_ == Stage::end; }

  /// The result so far; complete when the job has ended.
  [[nodiscard]] const ChangeResult& result() const { return result_; }

 private:
  enum class Stage : std::uint8_t {
    begin,
    erase,
    read_erased,
    write,
    restart,
    look, ///< in place of a SAVE that was not sent
    read_back,
    read_shown,
    end,
  };

  [[nodiscard]] bool is_stopped(Stage next) const;
  void stop();
  void tell_failure() const;
  [[nodiscard]] std::optional<ChangeStage> told_as(Stage stage) const;
  [[nodiscard]] Stage first_stage() const;
  [[nodiscard]] dronecan::Step enter(Stage stage, Time now);
  [[nodiscard]] Stage conclude_stage(bool cancelled);
  [[nodiscard]] Stage conclude_erase();
  [[nodiscard]] bool is_as_before() const;
  [[nodiscard]] Stage conclude_read_erased();
  [[nodiscard]] Stage conclude_write();
  [[nodiscard]] Stage conclude_restart();
  [[nodiscard]] Stage conclude_look();
  [[nodiscard]] std::optional<Error> of_another_unit(const Snapshot& now) const;
  [[nodiscard]] Stage conclude_read_back();
  [[nodiscard]] bool may_have_missed(const Snapshot& now) const;
  void conclude_read_shown();
  [[nodiscard]] std::optional<RomReading> rom_reading(const Snapshot& now) const;
  [[nodiscard]] std::optional<RomReading> unread_rom(const Snapshot& now) const;
  [[nodiscard]] Time known_since() const;
  [[nodiscard]] std::optional<dronecan::NodeId> other_writer() const;
  void explain_interruption(Stage at);
  void blame_other_writer();
  void blame_other_writer(RegisterChange& change) const;
  void tell_reach();
  [[nodiscard]] std::optional<Error> check_commands(const Snapshot& now) const;
  void tell_saved(const Snapshot& now);
  [[nodiscard]] std::unique_ptr<WriteJob> write() const;
  [[nodiscard]] std::vector<WriteJob::Premise> premises() const;
  [[nodiscard]] std::unique_ptr<SaveRestartJob> restart() const;

  [[nodiscard]] bool is_proven() const;

  [[nodiscard]] bool may_be_driven() const {
    return options_.while_driven || !plan_.waits_for_driver();
  }

  [[nodiscard]] Stage after_erase() const;
  [[nodiscard]] Stage after_write() const;
  [[nodiscard]] Stage to_show() const;
  [[nodiscard]] bool brings_unread_rom() const;
  [[nodiscard]] std::unique_ptr<ReadJob> read_configuration();
  [[nodiscard]] std::unique_ptr<ReadJob> read_shown();
  void take_reading(const Snapshot& now);

  Roster& roster_;
  const bla::Profiles& profiles_;
  const Plan& plan_;
  Options options_;
  Stage stage_ = Stage::begin;
  Servo servo_; ///< as last recognised, before our restart
  bool may_erase_again_ = true;
  bool was_erased_ = false; ///< as far as known
  bool reads_again_ = false;
  Member back_{};                          ///< as it was when it was back from our restart
  std::optional<Error> unproven_{};        ///< why that proves nothing, even if all is as expected
  std::optional<dronecan::Health> health_; ///< as it was read
  int looks_ = 0;
  Time begin_{};
  std::unique_ptr<EraseJob> erase_;
  std::unique_ptr<WriteJob> write_;
  std::unique_ptr<SaveRestartJob> restart_;
  std::unique_ptr<ReadJob> read_;
  dronecan::Job* job_ = nullptr; ///< of this stage
  ChangeResult result_;
};

} // namespace blactl::fleet
