#pragma once
// The wire: a CAN bus at 1 Mbit/s, true to the bit, as a state machine without I/O.

#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"
#include "blactl/sim/scenario/wire_faults.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

namespace blactl::sim {

/// Frames take their bits' time, stuffing and CRC included; whoever is lowest in arbitration goes
/// first; a frame that nobody acknowledges waits. Two nodes that send different frames under one
/// identifier destroy each other's until the error counters let one of them through. Errors come as
/// WireFaults says.
/// Not simulated: receive error counters, suspend transmission, overload frames.
class Medium {
 public:
  /// A node's side of the bus. A call must not attach or detach; it may send.
  class Listener {
   public:
    virtual ~Listener() = default;
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    /// A frame of another node has ended.
    virtual void heard(const can::Frame& frame, Time at) = 0;
    /// A frame of this node has ended and was acknowledged.
    virtual void sent(const can::Frame& frame, Time at) = 0;
    /// This node's controller left the bus for a moment; the frames of its queue are lost.
    virtual void bus_off(Time at) = 0;

   protected:
    Listener() = default;
  };

  using PortId = std::uint32_t;

  struct Counters {
    std::uint64_t frames = 0; ///< transmitted whole
    std::uint64_t collisions = 0;
    std::uint64_t errors = 0; ///< frames that WireFaults has destroyed
    Duration busy{};          ///< bits of frames, errors and intermissions
  };

  explicit Medium(const WireFaults& faults = {}, std::uint64_t seed = 0)
      : disturbance_(faults, seed) {}

  /// `capacity`: frames that wait in this node's queue at most. `listener` must outlive the port.
  PortId attach(Listener& listener, std::size_t capacity, Time now);

  /// The listener hears nothing more; what its queue holds is sent all the same, as a kernel does.
  void detach(PortId port);

  /// A node whose cable is cut hears nothing; what it sends waits, for nobody acknowledges it.
  void cut(PortId port, bool is_cut, Time now);

  /// The node's controller leaves the bus as after too many errors.
  void bus_off(PortId port, Time now);

  /// Queues a frame; false: the queue is full.
  bool send(PortId port, const can::Frame& frame, Time now);

  /// When the next frame starts or ends; `never` if nothing can happen without a call.
  [[nodiscard]] Time next_event() const;

  /// Does the one thing that next_event() announced, if it is due. A start is a thing of its own,
  /// so that all who send at one moment take part in the arbitration.
  void advance(Time now);

  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  struct Waiting {
    can::Frame frame;
    Time since;
  };

  struct Port {
    Listener* listener; ///< null: detached, its queue is still to be sent
    std::size_t capacity;
    std::deque<Waiting> queue;
    unsigned error_count = 0; ///< ISO 11898-1 transmit error counter
    Time off_until{};
    bool cut = false;

    [[nodiscard]] Time ready() const;
  };

  struct Transmission {
    can::Frame frame;
    std::vector<PortId> senders; ///< several, if they send the very same frame
    Time end;
    bool destroyed = false;
  };

  [[nodiscard]] Time next_start() const;
  void start(Time at);
  void begin(const can::Frame& frame, std::vector<PortId> senders,
             const std::vector<PortId>& rivals, Time at);
  void punish(PortId port, Time at);
  static void leave(Port& port, Time at);
  void finish();
  void release(const std::vector<PortId>& senders);
  void deliver(const Transmission& transmission, bool repeated);

  std::map<PortId, Port> ports_;
  PortId next_id_ = 0;
  std::optional<Transmission> on_wire_;
  Time idle_from_{};
  Counters counters_;
  WireDisturbance disturbance_;
};

} // namespace blactl::sim
