#pragma once
// The one place that waits, and the only one that reads the time.

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

/// A watched descriptor (terminal, pipe, socket) is readable or was closed.
struct Ready {
  int descriptor;
};

/// The deadline given to next() has come.
struct DeadlineReached {};

using Event = std::variant<Received, Sent, BusFault, Overflow, Gone, Away, Back, Opened, Ended,
                           Signal, Ready, DeadlineReached>;

/// One thread, one loop: everything above it is a state machine without I/O.
///
/// It also tells when this process has stood still (SIGSTOP, a machine that is too busy), by the
/// time that has passed without it: frames of a bus that does not stamp them have no times then.
///
/// Sending: the kernel transmits what it was given even after the process is gone, so frames are
/// handed over a few at a time. Until something is heard or echoed, one frame probes the bus; after
/// that at most three are in flight without an echo. The rest wait in this process.
class Loop {
 public:
  /// Takes over the bus (null: a loop over descriptors only) and SIGINT, SIGTERM, SIGWINCH; also
  /// SIGHUP, unless it is ignored (nohup). SIGPIPE is ignored.
  explicit Loop(std::unique_ptr<Bus> bus);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  [[nodiscard]] Time now() const;
  [[nodiscard]] WallTime wall() const;

  [[nodiscard]] Bus& bus() { return *bus_; }

  [[nodiscard]] const Bus& bus() const { return *bus_; }

  /// Queues a frame; frames leave in order, as the bus accepts them.
  void send(const Frame& frame);

  /// The number of frames queued here, or handed over and not yet echoed.
  [[nodiscard]] std::size_t unsent() const;

  /// Drops all frames not yet handed over.
  void drop_queue() { queue_.clear(); }

  /// Drops these frames, as far as they are not yet handed over.
  void withdraw(std::span<const Frame> frames);

  /// Since when a frame of ours has waited for its echo while nothing was heard: no node
  /// acknowledges. Empty: no frame does.
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

  Event happening(Time deadline);
  std::optional<Event> wait(Time deadline);
  std::optional<Event> poll_once(Time wake);
  void note_run(Time due);
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
  std::optional<Time> refused_at_; ///< when the bus refused the first frame of the queue
  std::optional<Time> left_at_;    ///< when next() returned last
  Time late_until_{};              ///< what is read by then may have waited
};

} // namespace blactl::can
