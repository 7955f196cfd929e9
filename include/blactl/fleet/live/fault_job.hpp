#pragma once
// Reads the faults of one or several servos.

#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/live/fault_state.hpp"

#include <optional>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Reads 0x18, and if it shows faults the registers behind it. If NodeStatus reports more than
/// that, all four registers are read once more; on a recording the faults are not_recorded then,
/// unless some were found.
class FaultJob final : public dronecan::Job {
 public:
  /// `session` outlives the job, `profiles` its state too.
  FaultJob(Session& session, const bla::Profiles& profiles, dronecan::NodeId id,
           const Identification::Options& options);

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override;

  /// Valid once the job has ended.
  [[nodiscard]] const FaultState& state() const { return state_; }

 private:
  void look(std::span<const bla::Address> first);
  [[nodiscard]] dronecan::Step judge(Time now);

  Session& session_;
  const bla::Profiles& profiles_;
  Identification::Options options_;
  std::optional<ReadJob> read_;
  bool is_second_ = false; ///< the second read, of all four registers
  FaultState state_;
};

/// The faults of several servos, in the order asked.
struct FaultStates {
  std::vector<FaultState> servos;
  std::optional<Error> broken; ///< the error that ended the session early
};

/// Reads the faults of several servos at once. `profiles` outlives the states.
[[nodiscard]] FaultStates read_faults(Session& session, const bla::Profiles& profiles,
                                      std::span<const dronecan::NodeId> servos,
                                      const Identification::Options& options);

} // namespace blactl::fleet
