#pragma once
// Arrival times of a socket's messages on the bus clock, and how many the kernel dropped.

#include "blactl/can/bus.hpp"

#include <cstdint>
#include <optional>

namespace blactl::can {

/// Ancillary data that the kernel delivers with a message.
struct Aside {
  std::optional<WallTime> stamp{};
  std::optional<std::uint32_t> dropped{}; ///< Messages dropped before this one.
};

/// Keeps messages in order even if the wall clock, which the kernel stamps them with, is set.
class Arrivals {
 public:
  struct Arrival {
    Time at;
    WallTime wall;
    std::optional<Overflow> before; ///< If messages before it were dropped.
  };

  /// Sets both clocks to now, for the messages just read.
  void read_at(Time now, WallTime wall);

  [[nodiscard]] Arrival arrival(const Aside& aside);

 private:
  Time now_;
  WallTime wall_;
  Time last_;
  std::uint32_t dropped_ = 0; ///< The kernel's counter: 32 bits, wrapping.
  std::uint64_t lost_ = 0;
};

} // namespace blactl::can
