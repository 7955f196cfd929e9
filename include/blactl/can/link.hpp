#pragma once
// The CAN interfaces of this machine, as the kernel configures them (rtnetlink).

#include "blactl/base/error.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::can {

/// The error state of a controller (linux/can/netlink.h, enum can_state).
enum class LinkState : std::uint8_t {
  error_active,
  error_warning,
  error_passive,
  bus_off,
  stopped,
  sleeping,
};

/// Errors that a controller has counted (ISO 11898-1): passive from 128, bus-off above 255.
struct ErrorCounters {
  std::uint16_t transmit;
  std::uint16_t receive;
};

/// One network interface of type ARPHRD_CAN. Members that only controllers (kind "can") have are
/// empty for the others, and where the driver does not report them.
struct Link {
  std::string name{};
  std::string kind{}; ///< "can" (a controller), "vcan", "vxcan"; empty: the driver does not say.
  bool is_up = false;
  std::uint32_t queue_length = 0;              ///< txqueuelen, in frames.
  std::optional<std::uint32_t> bit_rate{};     ///< bit/s
  std::optional<std::uint32_t> sample_point{}; ///< in tenths of a percent: 875 is 87.5 %.
  std::optional<std::chrono::milliseconds> restart_after{}; ///< after bus-off; 0: manually only.
  std::optional<LinkState> state{};
  std::optional<ErrorCounters> errors{};
};

/// All CAN interfaces, in the order of the kernel; none on a kernel without CAN.
/// Errors: interface (rtnetlink does not answer). Source: libnl, netlink/route/link/can.h.
[[nodiscard]] Result<std::vector<Link>> links();

/// The only interface that is up; null when none is, or several are.
[[nodiscard]] const Link* only_one_up(std::span<const Link> links);

/// For a person: "CAN interfaces of this machine: can0 (up), vcan0 (down)".
[[nodiscard]] std::string describe(std::span<const Link> links);

} // namespace blactl::can
