#pragma once
// A bus moves frames. One implementation a transport; none of them waits.

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

/// A frame of another node, at the time the kernel (or the simulator) saw it.
struct Received {
  Frame frame;
  Time at;
  WallTime wall;
};

/// The echo of a frame of ours: it has been acknowledged by somebody.
struct Sent {
  Frame frame;
  Time at;
  WallTime wall;
};

/// What a controller tells in an error frame.
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

/// The kernel dropped frames because we read too late; `lost` counts since the bus was opened.
struct Overflow {
  std::uint64_t lost;
};

/// The interface went down or away; nothing more comes from this bus.
struct Gone {
  Error error;
};

/// The transport has finished its opening dialogue (is_open()): frames pass from now on.
struct Opened {
  std::string note{}; ///< What a person should know of it; empty: nothing.
};

/// The interface went away and is waited for: until Back nothing comes, and nothing is sent.
struct Away {
  Error error;
};

/// It is there again. Whatever was on its way is lost.
struct Back {};

/// A log has been read to its end; nothing more comes from this bus.
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

  /// As a person names it and JSON prints it: "vcan0", "sim:".
  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Whether frames can pass: not yet while a transport talks with its adapter.
  [[nodiscard]] virtual bool is_open() const { return true; }

  /// Hands one frame to the transport: true when taken, false when its queue is full for now
  /// (ENOBUFS, EAGAIN). Errors: interface, permission.
  [[nodiscard]] virtual Result<bool> send(const Frame& frame) = 0;

  /// When a frame that was not taken at `refused` can be tried again; receive() may bring that
  /// forward. A full queue of the kernel (ENOBUFS) does not poll as writable: it is tried again
  /// after a time in which a bus of 1 Mbit/s moves some seven frames.
  [[nodiscard]] virtual Time send_again_at(Time refused) const {
    return refused + std::chrono::milliseconds(1);
  }

  /// The next thing that happened, if any.
  [[nodiscard]] virtual std::optional<BusEvent> receive() = 0;

  /// Asks for these frames only (an empty list: all). A filter saves work, nothing may rely on it.
  [[nodiscard]] virtual Result<void> filter(std::span<const Filter> filters) = 0;

  /// Whether every frame of ours comes back as Sent once somebody has acknowledged it.
  [[nodiscard]] virtual bool echoes() const = 0;

  /// What came since the bus was opened and was no frame that can be told: CAN FD, damaged.
  [[nodiscard]] virtual std::uint64_t unreadable() const { return 0; }

  /// What of the transport explains that nothing at all was heard; empty: nothing that it knows.
  /// Code interface: the transport itself fails. not_found: that may be, or the bus is silent.
  [[nodiscard]] virtual std::optional<Error> silence() const { return std::nullopt; }

  /// What ends a bus-off of this transport, for people.
  [[nodiscard]] virtual std::string bus_off_hint() const;

  /// Becomes readable when receive() has something; -1: nothing to poll.
  [[nodiscard]] virtual int descriptor() const = 0;

  /// Whether receive() shall also be called when descriptor() can be written to again: bytes that
  /// the transport has taken wait in this process.
  [[nodiscard]] virtual bool wants_to_write() const { return false; }

  /// What comes has happened long ago: nobody can be asked, and no frame is taken. Ends with Ended.
  [[nodiscard]] virtual bool is_recording() const { return false; }

  /// What was recorded comes when its time has come, by now(); else all of it at once.
  [[nodiscard]] virtual bool is_paced() const { return false; }

  /// The bus clock. Real interfaces: CLOCK_MONOTONIC.
  [[nodiscard]] virtual Time now() const;
  [[nodiscard]] virtual WallTime wall() const;

  /// The wall time of a moment of the bus clock, near now().
  [[nodiscard]] WallTime wall_at(Time at) const;

  /// The loop has nothing to do before `deadline`. Returns when it shall look again at the latest:
  /// a real bus has no wish of its own; on a virtual clock this call lets time pass.
  [[nodiscard]] virtual Time idle_until(Time deadline) { return deadline; }

 protected:
  Bus() = default;
};

} // namespace blactl::can
