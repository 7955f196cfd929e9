#pragma once
// Setting up a CAN interface of this machine (rtnetlink): by itself, or as a command for a person.

#include "blactl/base/error.hpp"
#include "blactl/can/link.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace blactl::can {

/// How BLA servos talk: 1 Mbit/s (Futaba 2.1), sample point 87.5 %, here in tenths of a percent.
inline constexpr std::uint32_t servo_bit_rate = 1'000'000, servo_sample_point = 875;

/// After bus-off: soon enough for a person, and long enough for the others on the bus.
inline constexpr std::chrono::milliseconds usual_restart{100};

/// Holds 13 ms of a full bus.
inline constexpr std::uint32_t usual_queue_length = 100;

/// What is done to an interface, in this order.
struct LinkSetup {
  std::string name{};
  bool goes_down = false;    ///< before the rest: a running controller takes no other bit timing
  bool sets_timing = false;  ///< to that of the servos; of controllers only
  bool sets_restart = false; ///< to usual_restart; of controllers only
  bool sets_queue = false;   ///< to usual_queue_length
  bool goes_up = false;

  /// There is nothing to do.
  [[nodiscard]] bool is_empty() const {
    return !goes_down && !sets_timing && !sets_restart && !sets_queue && !goes_up;
  }
};

/// The same as a command line: "sudo ip link set can0 down; sudo ip link set can0 up …".
[[nodiscard]] std::string command(const LinkSetup& setup);

/// The command that brings the interface up: a controller with the bit timing of the servos,
/// anything else as it is.
[[nodiscard]] std::string up_command(const Link& link);

/// Whether this process may: the kernel is asked for a change that changes nothing, because it
/// knows that of containers and capabilities too.
/// Errors: permission (with the command as a hint), interface.
[[nodiscard]] Result<void> may_set_up(const LinkSetup& setup);

/// Does it. An interface that goes down goes up again also when it did not take what was set.
/// What a driver lacks it may pass over in silence: only another look tells what is so now.
/// Errors: permission, interface.
[[nodiscard]] Result<void> set_up(const LinkSetup& setup);

} // namespace blactl::can
