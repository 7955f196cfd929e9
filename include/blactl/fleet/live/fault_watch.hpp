#pragma once
// Looks at the faults of servos again and again.

#include "blactl/fleet/live/fault_job.hpp"

#include <memory>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Looks at each servo in its own time: one that does not answer holds up no other.
class FaultWatch {
 public:
  /// `interval`: from the end of a look at a servo to the next one. `session` and `profiles`
  /// outlive the watch, `profiles` also the states.
  FaultWatch(Session& session, const bla::Profiles& profiles,
             std::span<const dronecan::NodeId> servos, const Identification::Options& options,
             Duration interval);
  ~FaultWatch();
  FaultWatch(const FaultWatch&) = delete;
  FaultWatch(FaultWatch&&) = delete;
  FaultWatch& operator=(const FaultWatch&) = delete;
  FaultWatch& operator=(FaultWatch&&) = delete;

  /// Lives until some looks have ended: what they saw. On a recording, which never changes, that is
  /// all servos, the first time. Errors: as Session::live_until().
  [[nodiscard]] Result<std::vector<FaultState>> next();

 private:
  struct Look {
    dronecan::NodeId id;
    Time due{};                      ///< of the next one
    std::unique_ptr<FaultJob> job{}; ///< the one that is under way
  };

  void begin();
  [[nodiscard]] bool has_ended(const Look& look) const;
  [[nodiscard]] Time next_due() const;

  Session& session_;
  const bla::Profiles& profiles_;
  Identification::Options options_;
  Duration interval_;
  std::vector<Look> looks_;
};

} // namespace blactl::fleet
