#pragma once
// Counters of a bus: its load, the frames of each sender, the complaints of controllers, and the
// responses to our requests.

#include "blactl/base/time.hpp"
#include "blactl/can/bus.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/fleet/bus/bus_load.hpp"

#include <cstdint>
#include <map>
#include <optional>

namespace blactl::fleet {

/// Counts from the first frame to the last. Bounded: one entry per node ID and kind of fault.
class Traffic {
 public:
  struct Sender {
    std::uint64_t frames = 0;
    std::uint64_t bits = 0;
    std::uint64_t statuses = 0;       ///< NodeStatus, sent once a second by each node
    Duration longest_status_period{}; ///< between two of them, none lost in between
    dronecan::TransferId status_id{}; ///< of the last one
    Time status_at{};
  };

  /// Takes a frame of another node.
  void hear(const can::Frame& frame, Time at);

  /// Takes the echo of a frame of ours.
  void hear_own(const can::Frame& frame, Time at);

  void hear(const can::BusFault& fault);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }

  /// Whether any other node was heard.
  [[nodiscard]] bool has_others() const { return frames_ > own_frames_; }

  /// Counts a request of ours to this node.
  void ask(dronecan::NodeId server) { ++questions_[server].asked; }

  /// Counts a request without a response in time.
  void miss_answer(dronecan::NodeId server) { ++questions_[server].unanswered; }

  /// Each try counts.
  struct Questions {
    std::uint64_t asked = 0, unanswered = 0;
  };

  [[nodiscard]] Questions questions_to(dronecan::NodeId server) const {
    const auto found = questions_.find(server);
    return found != questions_.end() ? found->second : Questions{};
  }

  /// Takes a log's timestamp for its next frame; its bus clock never goes back.
  void stamp(WallTime wall);

  /// Whether the timestamps went back, so that they give no duration.
  [[nodiscard]] bool runs_backwards() const { return runs_backwards_; }

  /// Frames with 11-bit identifiers, which DroneCAN does not use.
  [[nodiscard]] std::uint64_t standard_frames() const { return standard_frames_; }

  /// From the first frame to the last; empty: fewer than two, or the timestamps go backwards.
  [[nodiscard]] std::optional<Duration> duration() const;

  /// The load of a bus of 1 Mbit/s, in thousandths; empty: no duration.
  [[nodiscard]] std::optional<std::uint64_t> load_permille() const;

  /// By node ID; 0: anonymous.
  [[nodiscard]] const std::map<dronecan::NodeId, Sender>& senders() const { return senders_; }

  [[nodiscard]] const std::map<can::FaultKind, std::uint64_t>& faults() const { return faults_; }

 private:
  static void take_status(Sender& sender, const can::Frame& frame, Time at);

  std::uint64_t frames_ = 0, own_frames_ = 0, standard_frames_ = 0;
  BusLoad load_;
  WallTime newest_{};
  bool runs_backwards_ = false;
  std::map<dronecan::NodeId, Sender> senders_;
  std::map<can::FaultKind, std::uint64_t> faults_;
  std::map<dronecan::NodeId, Questions> questions_;
};

} // namespace blactl::fleet
