#pragma once
// Polls the faults of servos.

#include "blactl/fleet/live/fault_job.hpp"

#include <memory>
#include <span>
#include <vector>

namespace blactl::fleet {

/// Polls each servo at its own pace: one that does not respond delays no other.
class FaultWatch {
 public:
  /// `interval`: from the end of one read of a servo to the start of the next. `session` and
  /// `profiles` outlive the watch, `profiles` also the states.
  FaultWatch(Session& session, const bla::Profiles& profiles,
             std::span<const dronecan::NodeId> servos, const Identification::Options& options,
             Duration interval);
  ~FaultWatch();
  FaultWatch(const FaultWatch&) = delete;
  FaultWatch(FaultWatch&&) = delete;
  FaultWatch& operator=(const FaultWatch&) = delete;
  FaultWatch& operator=(FaultWatch&&) = delete;

  /// Waits until some reads have ended, and returns their results; also the state of a servo that
  /// has just fallen silent, without waiting for the end of its read. On a recording, which never
  /// changes, the first call returns all servos. Errors: as Session::live_until().
  [[nodiscard]] Result<std::vector<FaultState>> next();

 private:
  struct Look {
    dronecan::NodeId id;
    Time due{};                      ///< of the next read
    std::unique_ptr<FaultJob> job{}; ///< under way
    Time told_silent{};              ///< when the servo was last heard before its told silence
  };

  void begin();
  [[nodiscard]] bool has_ended(const Look& look) const;
  [[nodiscard]] Time next_due() const;
  [[nodiscard]] Time silent_from(const Look& look) const;
  void tell_silent(std::vector<FaultState>& states);

  Session& session_;
  const bla::Profiles& profiles_;
  Identification::Options options_;
  Duration interval_;
  std::vector<Look> looks_;
};

} // namespace blactl::fleet
