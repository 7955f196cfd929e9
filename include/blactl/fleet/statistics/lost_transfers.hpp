#pragma once
// Counts the lost transfers of one sender and type.

#include "blactl/base/time.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Transfer IDs count modulo 32 (DroneCAN specification 4.1), so a gap shows the number of losses,
/// but not whether 32 more were lost or the sender restarted. Therefore a gap is counted only if
/// the time since the last transfer agrees with it, judged by the usual period; otherwise it is a
/// jump.
class LostTransfers {
 public:
  /// Takes the next complete transfer. Broken ones count as lost, too.
  void take(dronecan::TransferId id, Time at);

  /// Empty: no two transfers were consecutive, so that the period is unknown.
  [[nodiscard]] std::optional<std::uint64_t> lost() const {
    return usual_us_ ? std::optional(lost_) : std::nullopt;
  }

  /// The number of jumps in the IDs that losses do not explain: after a restart, after a silence
  /// long enough for 32 transfers, with two senders on one node ID, or if clocks went back.
  [[nodiscard]] std::uint64_t jumps() const { return jumps_; }

 private:
  [[nodiscard]] bool explains(unsigned steps, double elapsed_us) const;
  [[nodiscard]] bool is_round(double elapsed_us) const;
  void take_next(double elapsed_us);
  void learn(double elapsed_us);

  std::optional<dronecan::TransferId> last_;
  Time at_{};
  std::optional<double> usual_us_; ///< from one transfer to the next
  std::uint64_t lost_ = 0, jumps_ = 0;
  bool was_silent_ = false; ///< for 32 periods, before the last transfer
  bool pauses_ = false;     ///< it sends in bursts, or its rate has changed
};

} // namespace blactl::fleet
