#pragma once
// Identifies one servo and reads registers of it, as they were at one moment.

#include "blactl/fleet/identification.hpp"
#include "blactl/fleet/snapshot.hpp"

#include <functional>
#include <vector>

namespace blactl::fleet {

/// After the last register the servo is asked once more who it is and how long it has run. Where
/// that does not prove that it ran on since it was identified, all is read once more: what reads
/// the same twice was true in between; for what RAM held before that, see Proof. Two units on the
/// ID have 20 ms to show.
class ReadJob final : public dronecan::Job {
 public:
  /// The registers to read of a servo, once it is identified.
  /// Errors: whatever makes reading pointless; nothing is read then.
  using Choice = std::function<Result<std::vector<const bla::Parameter*>>(const Servo& servo)>;

  /// How much of it must be proven. On a recording nothing can be asked. `moment`: that it was true
  /// of one servo at one time. `run`: also that the servo has not restarted since it was first
  /// heard, without which RAM may have lost what it is told to save; this may take some seconds.
  enum class Proof : std::uint8_t { none, moment, run };

  /// What else to read, after what was read so far; asked until it names nothing new.
  using More = std::function<std::vector<const bla::Parameter*>(const Snapshot& so_far)>;

  /// How long a second unit on the ID may take longer to answer than the first.
  static constexpr Duration twin_time = std::chrono::milliseconds(20);

  ReadJob(Roster& roster, dronecan::NodeId id, const bla::Profiles& profiles,
          Identification::Options options, Choice choice, Proof proof = Proof::moment,
          More more = {});

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// What was read so far, in the order of the choice. Errors beside those of identification and
  /// choice: timeout (it does not answer any more), state (it is another unit, or restarts again
  /// and again), duplicate_node_id.
  [[nodiscard]] const Snapshot& snapshot() const { return snapshot_; }

 private:
  enum class At : std::uint8_t { identify, read, presence, proof, uptime, settle };

  [[nodiscard]] dronecan::Step begin(Time now);
  [[nodiscard]] dronecan::Step take_reading(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step read_next();
  [[nodiscard]] bool has_next();
  [[nodiscard]] dronecan::Step ask_unit(At at);
  [[nodiscard]] dronecan::Step judge_presence(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step judge_proof(const dronecan::Outcome& outcome);
  [[nodiscard]] dronecan::Step judge_uptime(std::uint32_t uptime_s, Time now);
  [[nodiscard]] dronecan::Step judge_passes(bool runs_on, Time now);
  [[nodiscard]] dronecan::Step read_again(Time now);
  [[nodiscard]] dronecan::Step settle(Time now);
  [[nodiscard]] dronecan::Step give_up(Error error);
  [[nodiscard]] bool agrees_with_before() const;
  [[nodiscard]] bool has_another_boot() const;
  [[nodiscard]] Time must_run_since() const;

  Roster& roster_;
  dronecan::NodeId id_;
  Patience patience_;
  Identification identification_;
  Choice choice_;
  More more_;
  Proof proof_;
  At at_ = At::identify;
  std::vector<const bla::Parameter*> wanted_;
  int silent_ = 0;              ///< registers in a row
  int passes_ = 1;              ///< of reading all
  int uptimes_ = 0;             ///< asked for at a certain moment
  std::vector<Reading> before_; ///< of the pass before
  Snapshot snapshot_;
};

} // namespace blactl::fleet
