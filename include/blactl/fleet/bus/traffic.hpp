#pragma once
// What crosses a bus, counted: how busy it is, who sends how much, what controllers complain about,
// what of our requests is answered.

#include "blactl/base/time.hpp"
#include "blactl/can/bus.hpp"
#include "blactl/dronecan/ids.hpp"
#include "blactl/fleet/bus/bus_load.hpp"

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

  /// A request of ours to this node went out.
  void ask(dronecan::NodeId server) { ++questions_[server].asked; }

  /// It was not answered in time.
  void miss_answer(dronecan::NodeId server) { ++questions_[server].unanswered; }

  /// Each try counts.
  struct Questions {
    std::uint64_t asked = 0, unanswered = 0;
  };

  [[nodiscard]] Questions questions_to(dronecan::NodeId server) const {
    const auto found = questions_.find(server);
    return found != questions_.end() ? found->second : Questions{};
  }

  /// What a log says of when its next frame was; its bus clock never goes back.
  void stamp(WallTime wall);

  /// The stamps did: they tell no duration.
  [[nodiscard]] bool runs_backwards() const { return runs_backwards_; }

  /// With 11-bit identifiers: DroneCAN has none.
  [[nodiscard]] std::uint64_t standard_frames() const { return standard_frames_; }

  /// From the first frame to the last; empty: there were not two, or its stamps run backwards.
  [[nodiscard]] std::optional<Duration> duration() const;

  /// How much of a bus of 1 Mbit/s was in use, in thousandths; empty: no duration.
  [[nodiscard]] std::optional<std::uint64_t> load_permille() const;

  /// By node ID; 0: anonymous.
  [[nodiscard]] const std::map<dronecan::NodeId, Sender>& senders() const { return senders_; }

  [[nodiscard]] const std::map<can::FaultKind, std::uint64_t>& faults() const { return faults_; }

 private:
  std::uint64_t frames_ = 0, own_frames_ = 0, standard_frames_ = 0;
  BusLoad load_;
  WallTime newest_{};
  bool runs_backwards_ = false;
  std::map<dronecan::NodeId, Sender> senders_;
  std::map<can::FaultKind, std::uint64_t> faults_;
  std::map<dronecan::NodeId, Questions> questions_;
};

} // namespace blactl::fleet
