#pragma once
// The one place that waits, and the only one that knows the time.

#include "blactl/can/bus.hpp"

#include <deque>
#include <memory>
#include <span>
#include <variant>
#include <vector>

namespace blactl::can {

/// SIGINT, SIGTERM, SIGHUP or SIGWINCH arrived.
struct Signal {
  int number;
};

/// A watched descriptor (terminal, pipe, socket) can be read or was closed.
struct Ready {
  int descriptor;
};

/// The deadline given to next() has come.
struct DeadlineReached {};

using Event = std::variant<Received, Sent, BusFault, Overflow, Gone, Away, Back, Opened, Ended,
                           Signal, Ready, DeadlineReached>;

/// One thread, one loop: everything above it is a state machine without I/O.
///
/// Sending: the kernel transmits what it was given even after the process is gone, so frames are
/// handed over a few at a time. Until something was heard or echoed on the bus one frame probes
/// it; then at most three are on their way without an echo. The rest waits in this process.
class Loop {
 public:
  /// Takes over the bus (may be null: a loop of descriptors only) and SIGINT, SIGTERM, SIGWINCH;
  /// SIGHUP too, unless it is ignored (nohup). SIGPIPE is ignored.
  explicit Loop(std::unique_ptr<Bus> bus);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  [[nodiscard]] Time now() const;
  [[nodiscard]] WallTime wall() const;

  [[nodiscard]] Bus& bus() { return *bus_; }

  [[nodiscard]] const Bus& bus() const { return *bus_; }

  /// Queues a frame; it leaves in order, as the bus takes it.
  void send(const Frame& frame);

  /// Frames queued here or handed over and not echoed yet.
  [[nodiscard]] std::size_t unsent() const;

  /// Forgets the frames that were not handed over yet.
  void drop_queue() { queue_.clear(); }

  /// Forgets these frames, as far as they were not handed over yet.
  void withdraw(std::span<const Frame> frames);

  /// Since when a frame of ours waits for its echo while nothing at all was heard: nobody
  /// acknowledges. Empty: not so.
  [[nodiscard]] std::optional<Time> unacknowledged_since() const;

  /// Reports a descriptor as Ready whenever it can be read.
  void watch(int descriptor);
  void unwatch(int descriptor);

  /// The next event; waits until `deadline` at most. Signals come first, then the bus.
  [[nodiscard]] Event next(Time deadline);

 private:
  struct Pending {
    Frame frame;
    Time since;
  };

  std::optional<Event> poll_once(Time deadline);
  std::optional<Event> from_signals();
  std::optional<Event> from_bus();
  void heard(Time at);
  void pump();
  [[nodiscard]] Time pump_again_at() const;

  std::unique_ptr<Bus> bus_;
  int signals_;
  std::vector<int> watched_;
  std::size_t next_watched_ = 0;
  std::deque<Frame> queue_;
  std::deque<Pending> in_flight_;
  std::deque<Event> ready_;
  bool heard_ = false;
  bool gone_ = false;
  Time last_heard_{};
  std::optional<Time> refused_at_; ///< when the bus did not take the first frame of the queue
};

} // namespace blactl::can
