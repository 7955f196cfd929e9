#pragma once
// Detects several units on one node ID and their starts: by their uptimes, and by their rate of
// actuator.Status.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/dronecan/transfer.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

namespace blactl::fleet {

/// Counts the messages of one type under one node ID.
class MessageRate {
 public:
  /// One unit sends at most `most` of them in a window.
  constexpr MessageRate(Duration window, unsigned most) : window_(window), most_(most) {}

  /// The first frame of one. It counts once if it comes twice, as where the end of its
  /// acknowledgement was disturbed. `most_lost`: so many messages of one unit may be lost before
  /// this one; a transfer ID further ahead, or behind, shows another unit.
  void count(const can::Frame& frame, Time at, unsigned most_lost);

  /// The sender has restarted, or was not listened to.
  void begin_anew() { window_start_.reset(); }

  /// When two units were last seen to send them; empty: never.
  [[nodiscard]] std::optional<Time> of_two_at() const { return of_two_at_; }

 private:
  Duration window_;
  unsigned most_;
  std::optional<Time> window_start_{};
  unsigned count_ = 0;
  unsigned leaps_ = 0; ///< transfer IDs that lost messages do not explain
  can::Frame last_{};
  Time last_at_{};
  std::optional<Time> of_two_at_{};
};

/// Watches the transfers from one node ID.
class UnitWatch {
 public:
  /// The sender of an uptime.
  enum class Start : std::uint8_t {
    known, ///< unchanged, or the first one heard
    anew,  ///< restarted
    twin   ///< another unit
  };

  /// The first frame of a transfer of actuator.Status.
  void count_actuator_status(const can::Frame& frame, Time at);

  /// A frame of NodeStatus with this uptime.
  void count_node_status(const can::Frame& frame, std::uint32_t uptime_s, Time at);

  /// When two servos were last seen to send actuator.Status, provided that the sender is a BLA
  /// servo; empty: never.
  [[nodiscard]] std::optional<Time> too_fast_at() const { return actuator_statuses_.of_two_at(); }

  /// The same of two units that started together, by their NodeStatus.
  [[nodiscard]] std::optional<Time> two_statuses_at() const {
    return std::max(node_statuses_.of_two_at(), two_priorities_at_);
  }

  /// Forgets what was heard.
  void begin_anew();

  /// Some messages were not counted.
  void begin_rates_anew() {
    actuator_statuses_.begin_anew();
    node_statuses_.begin_anew();
  }

  /// The transfers have no times from here on, as in a log without stamps: then only an uptime that
  /// goes back tells of a restart, and nothing here of a second unit.
  void lose_time() { is_timed_ = false; }

  /// The uptime of a NodeStatus.
  [[nodiscard]] Start hear_uptime(std::uint32_t uptime_s, Time at);

  /// Takes a NodeStatus that may be a repetition: receivers drop it if it has the transfer ID of
  /// the last one, but it may be from a unit with the same count. Other ones are ignored.
  [[nodiscard]] Start hear_repetition(dronecan::TransferId transfer_id, std::uint32_t uptime_s,
                                      Time at);

  /// A request for GetNodeInfo: its response is younger.
  void hear_request(dronecan::NodeId client, dronecan::TransferId transfer_id, Time at) {
    requests_[transfer_id] = {client, at};
  }

  /// Takes the uptime of a response, which may have been delayed: its start then looks later than
  /// it was, never earlier.
  [[nodiscard]] Start hear_answer(std::uint32_t uptime_s, const dronecan::Transfer& response);

  /// The latest possible start of the unit that sent the last uptime; empty: none was received.
  [[nodiscard]] std::optional<Time> started() const { return starts_[last_start_]; }

 private:
  struct Request {
    dronecan::NodeId client{};
    Time at{};
  };

  [[nodiscard]] Duration delay(const dronecan::Transfer& response) const;
  void compare_priority(dronecan::Priority priority, Time start, Time at);

  /// A BLA servo sends actuator.Status every 100 ms (table 2-2): with the worst delays one cannot
  /// send more than fourteen in a second.
  MessageRate actuator_statuses_{std::chrono::seconds(1), 14};
  /// One a second is due; who sends more of them in the same second of its uptime numbers them
  /// consecutively.
  MessageRate node_statuses_{std::chrono::seconds(3), 5};
  std::uint32_t counted_uptime_s_ = 0;              ///< of the last one
  std::map<dronecan::Priority, Time> run_starts_{}; ///< by priority of NodeStatus
  dronecan::Priority last_priority_ = 0;            ///< of NodeStatus
  std::optional<Time> two_priorities_at_{};
  std::optional<dronecan::TransferId> last_status_id_{};          ///< of NodeStatus
  std::array<Request, dronecan::transfer_id_modulus> requests_{}; ///< for GetNodeInfo
  std::array<std::optional<Time>, 2> starts_{};
  std::size_t last_start_ = 0;
  std::uint32_t last_uptime_s_ = 0;
  bool is_timed_ = true;
  bool may_be_late_ = false; ///< the latest new start: the uptime has not gone back since
};

} // namespace blactl::fleet
