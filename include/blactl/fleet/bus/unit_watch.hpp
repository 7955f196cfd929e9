#pragma once
// How many units send under one node ID, and when they started: by their uptimes, and by how often
// they send actuator.Status.

#include "blactl/base/time.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace blactl::fleet {

/// Hears what comes from one node ID.
class UnitWatch {
 public:
  /// What an uptime says of its sender.
  enum class Start : std::uint8_t {
    known, ///< it has run on, or it is the first that is heard
    anew,  ///< it has started since
    twin   ///< another unit told it
  };

  /// The start of a transfer of actuator.Status.
  void count_status(dronecan::TransferId transfer_id, Time at);

  /// Two servos send actuator.Status, as far as its sender is a BLA servo.
  [[nodiscard]] bool is_too_fast() const { return is_too_fast_; }

  /// The uptime of a NodeStatus.
  [[nodiscard]] Start hear_uptime(std::uint32_t uptime_s, Time at);

  /// That of a NodeStatus which may be a repetition: receivers drop it where it has the transfer ID
  /// of the last one, but it may be of a unit that counts alike. Of others nothing is said.
  [[nodiscard]] Start hear_repetition(dronecan::TransferId transfer_id, std::uint32_t uptime_s,
                                      Time at);

  /// That of an answer, which may have been under way for long: its start then looks later than it
  /// was, and never earlier.
  [[nodiscard]] Start hear_answer(std::uint32_t uptime_s, Time at);

  /// When the unit that told the last uptime started at the latest; empty: none was told.
  [[nodiscard]] std::optional<Time> started() const { return starts_[last_start_]; }

 private:
  std::optional<Time> window_start_{};
  unsigned count_ = 0;
  unsigned leaps_ = 0; ///< transfer IDs that did not follow the one before
  dronecan::TransferId last_actuator_id_ = 0;
  bool is_too_fast_ = false;
  std::optional<dronecan::TransferId> last_status_id_{}; ///< of NodeStatus
  std::array<std::optional<Time>, 2> starts_{};
  std::size_t last_start_ = 0;
  std::uint32_t last_uptime_s_ = 0;
  bool may_be_late_ = false; ///< the last new start: the uptime has not gone back for it, nor since
};

} // namespace blactl::fleet
