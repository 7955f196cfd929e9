#pragma once
// Identifies one servo and reads its registers as of one moment.

#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/run_proof.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/snapshot.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// After the last register the servo must prove, once it is old enough for that, that it is still
/// the same and has not restarted since it was identified; otherwise everything is read once more.
/// On earlier contents of RAM, see Proof.
class ReadJob final : public dronecan::Job {
 public:
  /// The registers to read from an identified servo. Errors: reasons for not reading at all.
  using Choice = std::function<Result<std::vector<const bla::Parameter*>>(const Servo& servo)>;

  /// The part that must be proven.
  enum class Proof : std::uint8_t {
    none,   ///< on a recording nothing can be asked
    unit,   ///< the same servo, and values of one run, as far as lost requests tell
    moment, ///< consistent values of one servo; a young servo takes a second for this
    run,    ///< also no restart since it was first heard: RAM is to be saved
  };

  /// Further registers to read, given those read so far; called until it returns nothing new.
  using More = std::function<std::vector<const bla::Parameter*>(const Snapshot& so_far)>;

  ReadJob(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
          Identification::Options options, Choice choice, Proof proof = Proof::moment,
          More more = {});

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// The registers read so far, in the order of the choice. Errors besides those of identification
  /// and choice: timeout (it does not respond any more), state (it is another unit, or restarts
  /// repeatedly), duplicate_node_id.
  [[nodiscard]] const Snapshot& snapshot() const { return snapshot_; }

  /// Whether another node changed one of these values since, or the servo has restarted, as far as
  /// heard.
  [[nodiscard]] bool is_outdated() const;

  /// An ended job: it is to be run once more, and reads the values as they are then.
  void read_anew() { at_ = At::anew; }

  /// When the reading of these values began: nobody is known to have changed them since.
  [[nodiscard]] Time began() const { return pass_began_; }

 private:
  enum class At : std::uint8_t { identify, read, presence, proof, servo_id, static_node_id, anew };

  [[nodiscard]] dronecan::Step begin(Time now);
  [[nodiscard]] dronecan::Step take_reading(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step read_next(Time now);
  [[nodiscard]] bool may_have_restarted(const dronecan::Outcome& outcome);
  [[nodiscard]] bool is_in_doubt() const;
  [[nodiscard]] bool may_be_of_two() const;
  [[nodiscard]] dronecan::Step read_again_after_silence(Time now);
  [[nodiscard]] bool has_next();
  [[nodiscard]] dronecan::Step prove(Time now);
  [[nodiscard]] dronecan::Step judge_presence(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step judge_proof(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step judge_restart(Time now);
  [[nodiscard]] dronecan::Step judge_writers(Time now);
  [[nodiscard]] dronecan::Step begin_anew(Time now);
  [[nodiscard]] bool has_restarted_since() const;
  [[nodiscard]] std::optional<dronecan::NodeId> writer() const;
  [[nodiscard]] dronecan::Step read_again(Time now);
  [[nodiscard]] dronecan::Step read_id(At which);
  [[nodiscard]] dronecan::Step take_id(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step give_up(Error error);
  [[nodiscard]] Error told_by(const Error& error) const;
  [[nodiscard]] bool is_about_earlier_run() const;
  [[nodiscard]] std::optional<Time> must_run_since() const;

  Roster& roster_;
  dronecan::NodeId id_;
  Patience patience_;
  Identification identification_;
  Choice choice_;
  More more_;
  Proof proof_;
  At at_ = At::identify;
  std::vector<const bla::Parameter*> wanted_;
  int silent_ = 0;          ///< consecutive registers
  int passes_ = 1;          ///< over all registers
  int repeats_ = 0;         ///< of requests that made it read again
  bool was_silent_ = false; ///< a request of this pass was repeated, or not answered
  Time asked_last_{};       ///< when the present request was due
  Time pass_began_{};
  std::optional<RunProof> run_proof_;
  Snapshot snapshot_;
};

struct Snapshots {
  std::vector<Snapshot> servos;  ///< in the order asked
  std::optional<Error> broken{}; ///< the error that ended the session early: they are incomplete
};

/// Reads the registers named by `choice` from several servos at once, and those that changed while
/// others were read once more. On a recording nothing is
/// proven, whatever `proof`.
[[nodiscard]] Snapshots take_snapshots(Session& session, const bla::Profiles& profiles,
                                       std::span<const dronecan::NodeId> servos,
                                       const Identification::Options& options,
                                       const ReadJob::Choice& choice,
                                       ReadJob::Proof proof = ReadJob::Proof::moment,
                                       const ReadJob::More& more = {});

} // namespace blactl::fleet
