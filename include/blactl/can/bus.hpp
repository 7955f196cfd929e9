#pragma once
// A bus moves frames. There is one implementation per transport; none of them waits.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/can/frame.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace blactl::can {

/// A frame from another node, with the time at which the kernel (or the simulator) saw it; see
/// Bus::stamps().
struct Received {
  Frame frame;
  Time at;
  WallTime wall;
  /// False: from a line of a log without a stamp, and `at` is that of a line before; or it has
  /// waited while this process stood still, and `at` is when it was read.
  bool is_timed = true;
};

/// The echo of one of our frames: some node has acknowledged it.
struct Sent {
  Frame frame;
  Time at;
  WallTime wall;
};

/// The kinds of fault that a controller reports in an error frame.
enum class FaultKind : std::uint8_t {
  bus_off,
  error_passive,
  error_warning,
  error_active,
  no_acknowledge,
  transmit_timeout,
  receive_overflow,
  restarted,
  protocol,
};

struct BusFault {
  FaultKind kind;
  Time at;
};

/// The kernel dropped frames because we read too late; `lost` counts from when the bus was opened.
struct Overflow {
  std::uint64_t lost;
};

/// The interface went down or disappeared; this bus delivers nothing more.
struct Gone {
  Error error;
};

/// The transport has completed its opening dialogue (is_open()): frames pass from now on.
struct Opened {
  std::string note{}; ///< A remark for the user; empty: none.
};

/// The interface disappeared and is awaited: until Back nothing is received or sent.
struct Away {
  Error error;
};

/// The interface is back. Frames that were on their way are lost.
struct Back {};

/// A log has been read to its end; this bus delivers nothing more.
struct Ended {};

using BusEvent = std::variant<Received, Sent, BusFault, Overflow, Gone, Away, Back, Opened, Ended>;

/// Extended data frames whose ID agrees with `id` in the bits of `mask`.
struct Filter {
  std::uint32_t id;
  std::uint32_t mask;
};

/// A transport. send() and receive() never wait; can::Loop does, on descriptor().
class Bus {
 public:
  virtual ~Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// The name that the user gives and JSON prints: "vcan0", "sim:".
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Whether frames can pass: not while a transport is still in dialogue with its adapter.
  [[nodiscard]] virtual bool is_open() const { return true; }

  /// Hands one frame to the transport: true when taken, false when its queue is full for now
  /// (ENOBUFS, EAGAIN). Errors: interface, permission.
  [[nodiscard]] virtual Result<bool> send(const Frame& frame) = 0;

  /// When to retry a frame that was refused at `refused`; receive() may bring that forward. A full
  /// kernel queue (ENOBUFS) does not poll as writable: it is retried after the time in which a bus
  /// at 1 Mbit/s moves some seven frames.
  [[nodiscard]] virtual Time send_again_at(Time refused) const {
    return refused + std::chrono::milliseconds(1);
  }

  /// The next event, if any.
  [[nodiscard]] virtual std::optional<BusEvent> receive() = 0;

  /// Asks for these frames only (an empty list: all). A filter saves work; nothing may rely on it.
  [[nodiscard]] virtual Result<void> filter(std::span<const Filter> filters) = 0;

  /// Whether every frame of ours comes back as Sent once somebody has acknowledged it.
  [[nodiscard]] virtual bool echoes() const = 0;

  /// The number of frames since the bus was opened that could not be decoded: CAN FD, damaged.
  [[nodiscard]] virtual std::uint64_t unreadable() const { return 0; }

  /// The transport's explanation for a silent bus; empty: it knows of none. Code interface: the
  /// transport itself fails. not_found: it may be failing, or the bus is silent.
  [[nodiscard]] virtual std::optional<Error> silence() const { return std::nullopt; }

  /// How to end a bus-off on this transport, as a hint for people.
  [[nodiscard]] virtual std::string bus_off_hint() const;

  /// Becomes readable when receive() has something; -1: nothing to poll.
  [[nodiscard]] virtual int descriptor() const = 0;

  /// Whether to call receive() also when descriptor() becomes writable: bytes that the transport
  /// has accepted are still waiting in this process.
  [[nodiscard]] virtual bool wants_to_write() const { return false; }

  /// Whether a frame bears the time at which it came; else that at which this process read it.
  [[nodiscard]] virtual bool stamps() const { return true; }

  /// Events come from the past: no node can be asked, no frame is accepted. Ends with Ended.
  [[nodiscard]] virtual bool is_replay() const { return false; }

  /// Whether recorded events come at their time, by now(), rather than all at once.
  [[nodiscard]] virtual bool is_paced() const { return false; }

  /// The bus clock. Real interfaces: CLOCK_MONOTONIC.
  [[nodiscard]] virtual Time now() const;
  [[nodiscard]] virtual WallTime wall() const;

  /// The wall time of a bus time near now().
  [[nodiscard]] WallTime wall_at(Time at) const;

  /// The loop has nothing to do before `deadline`. Returns the latest time to look again: a real
  /// bus returns `deadline`; on a virtual clock this call lets time pass.
  [[nodiscard]] virtual Time idle_until(Time deadline) { return deadline; }

 protected:
  Bus() = default;
};

} // namespace blactl::can
