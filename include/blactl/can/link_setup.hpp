#pragma once
// Setting up a CAN interface of this machine: over rtnetlink, or as a command for the user.

#include "blactl/base/error.hpp"
#include "blactl/can/link.hpp"

#include <chrono>
#include <cstdint>
#include <string>

namespace blactl::can {

/// Bit timing of BLA servos: 1 Mbit/s (Futaba 2.1), sample point 87.5 %, in tenths of a percent.
inline constexpr std::uint32_t servo_bit_rate = 1'000'000, servo_sample_point = 875;

/// The restart delay after bus-off: short for a person, long enough for other nodes on the bus.
inline constexpr std::chrono::milliseconds usual_restart{100};

/// Holds 13 ms of a full bus.
inline constexpr std::uint32_t usual_queue_length = 100;

/// The steps to set up an interface, in this order.
struct LinkSetup {
  std::string name{};
  bool goes_down = false;    ///< before the rest: a running controller accepts no new bit timing
  bool sets_timing = false;  ///< to that of the servos; of controllers only
  bool sets_restart = false; ///< to usual_restart; of controllers only
  bool sets_queue = false;   ///< to usual_queue_length
  bool goes_up = false;

  /// Whether there is nothing to do.
  [[nodiscard]] bool is_empty() const {
    return !goes_down && !sets_timing && !sets_restart && !sets_queue && !goes_up;
  }
};

/// The setup as a command line: "sudo ip link set can0 down; sudo ip link set can0 up …".
[[nodiscard]] std::string command(const LinkSetup& setup);

/// The command that brings the interface up: a controller with the bit timing of the servos,
/// anything else as it is.
[[nodiscard]] std::string up_command(const Link& link);

/// Checks whether this process has permission, by asking the kernel for a change without effect:
/// only the kernel takes containers and capabilities into account. Errors: permission (with the
/// command as a hint), interface.
[[nodiscard]] Result<void> may_set_up(const LinkSetup& setup);

/// Performs the setup. An interface taken down goes up again even if it refused the settings. A
/// driver may silently ignore what it lacks: read the link again to see the result. Errors:
/// permission, interface.
[[nodiscard]] Result<void> set_up(const LinkSetup& setup);

} // namespace blactl::can
