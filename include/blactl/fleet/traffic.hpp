#pragma once
// What crosses a bus, counted: how busy it is, who sends how much, what controllers complain about.

#include "blactl/base/time.hpp"
#include "blactl/can/bus.hpp"
#include "blactl/dronecan/ids.hpp"

#include <cstdint>
#include <map>
#include <optional>

namespace blactl::fleet {

/// Counts from the first frame to the last. Bounded: one entry a node ID and a kind of fault.
class Traffic {
 public:
  struct Sender {
    std::uint64_t frames = 0;
    std::uint64_t bits = 0;
    std::uint64_t statuses = 0; ///< NodeStatus, which each node sends once a second
  };

  /// A frame of another node.
  void hear(const can::Frame& frame, Time at);

  /// The echo of a frame of ours.
  void hear_own(const can::Frame& frame, Time at);

  void hear(const can::BusFault& fault);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }

  /// Somebody else was heard.
  [[nodiscard]] bool has_others() const { return frames_ > own_frames_; }

  /// With 11-bit identifiers: DroneCAN has none.
  [[nodiscard]] std::uint64_t standard_frames() const { return standard_frames_; }

  /// From the first frame to the last; empty: there were not two.
  [[nodiscard]] std::optional<Duration> duration() const;

  /// How much of a bus of 1 Mbit/s was in use, in thousandths; empty: no duration.
  [[nodiscard]] std::optional<std::uint64_t> load_permille() const;

  /// By node ID; 0: anonymous.
  [[nodiscard]] const std::map<dronecan::NodeId, Sender>& senders() const { return senders_; }

  [[nodiscard]] const std::map<can::FaultKind, std::uint64_t>& faults() const { return faults_; }

 private:
  std::uint64_t frames_ = 0, own_frames_ = 0, bits_ = 0, standard_frames_ = 0;
  std::optional<Time> first_;
  Time last_{};
  std::map<dronecan::NodeId, Sender> senders_;
  std::map<can::FaultKind, std::uint64_t> faults_;
};

} // namespace blactl::fleet
