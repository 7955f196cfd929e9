#pragma once
// What an slcan adapter says of itself, and what else may speak on a serial port.

#include <cstdint>
#include <optional>
#include <string>

namespace blactl::can {

/// The answers to V, N and F; many adapters have none. Source: Lawicel CAN232 manual 1.4.
struct SlcanAnswers {
  std::string version{}; ///< as it writes it: "1013"
  std::string serial_number{};
  std::optional<std::uint8_t> status{}; ///< flags; see the bits below
};

/// Bits of the status.
namespace slcan_status {
inline constexpr std::uint8_t receive_queue_full = 1U << 0U;
inline constexpr std::uint8_t transmit_queue_full = 1U << 1U;
inline constexpr std::uint8_t error_warning = 1U << 2U;
inline constexpr std::uint8_t data_overrun = 1U << 3U;
inline constexpr std::uint8_t error_passive = 1U << 5U;
inline constexpr std::uint8_t bus_error = 1U << 7U;
} // namespace slcan_status

/// What is heard on a port instead of slcan.
enum class ForeignSpeech : std::uint8_t {
  none,    ///< nothing, slcan, or what nobody knows: another baud rate
  mavlink, ///< the telemetry of an autopilot
  text,    ///< lines that are no slcan: a satellite receiver, a console
};

} // namespace blactl::can
