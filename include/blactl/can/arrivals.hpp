#pragma once
// When messages of a socket came on the bus clock, and how many had no room.

#include "blactl/can/bus.hpp"

#include <cstdint>
#include <optional>

namespace blactl::can {

/// What the kernel tells beside a message.
struct Aside {
  std::optional<WallTime> stamp{};
  std::optional<std::uint32_t> dropped{}; ///< Messages that had no room before this one.
};

/// Keeps messages in order even if somebody sets the wall clock, by which the kernel stamps them.
class Arrivals {
 public:
  struct Arrival {
    Time at;
    WallTime wall;
    std::optional<Overflow> before; ///< If others before it had no room.
  };

  /// Both clocks now, for the messages that were just read.
  void read_at(Time now, WallTime wall);

  [[nodiscard]] Arrival arrival(const Aside& aside);

 private:
  Time now_;
  WallTime wall_;
  Time last_;
  std::uint32_t dropped_ = 0; ///< As the kernel counts: 32 bits that wrap.
  std::uint64_t lost_ = 0;
};

} // namespace blactl::can
