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

/// Frames take the time of their bits, stuffing and CRC included; the lowest identifier wins the
/// arbitration; a frame that no node acknowledges waits. Two nodes that send different frames under
/// one identifier destroy each other's frames until the error counters let one of them through.
/// Errors follow WireFaults. Not simulated: receive error counters, suspend transmission, overload
/// frames.
class Medium {
 public:
  /// A node's side of the bus. Calls must not attach or detach ports; they may send.
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
    std::uint64_t frames = 0; ///< transmitted completely
    std::uint64_t collisions = 0;
    std::uint64_t errors = 0; ///< frames destroyed by WireFaults
    Duration busy{};          ///< bits of frames, errors and intermissions
  };

  explicit Medium(const WireFaults& faults = {}, std::uint64_t seed = 0)
      : disturbance_(faults, seed) {}

  /// `capacity`: maximum number of frames in this node's queue. `listener` must outlive the port.
  PortId attach(Listener& listener, std::size_t capacity, Time now);

  /// The listener receives nothing more; frames still in its queue are sent, as a kernel does.
  void detach(PortId port);

  /// A node with a cut cable receives nothing; its frames wait for an acknowledgement.
  void cut(PortId port, bool is_cut, Time now);

  /// The node's controller leaves the bus as after too many errors.
  void bus_off(PortId port, Time now);

  /// Queues a frame; false: the queue is full.
  bool send(PortId port, const can::Frame& frame, Time now);

  /// The time of the next start or end of a frame; `never` if nothing can happen without a call.
  [[nodiscard]] Time next_event() const;

  /// Carries out the single step announced by next_event(), if it is due. The start of a frame is a
  /// step of its own, so that all nodes that send at one moment take part in the arbitration.
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
    std::vector<PortId> senders; ///< several, if they send the same frame
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
