#pragma once
// An slcan adapter's answers about itself, and other senders on a serial port.

#include <cstdint>
#include <optional>
#include <string>

namespace blactl::can {

/// The answers to V, N and F; many adapters give none. Source: Lawicel CAN232 manual 1.4.
struct SlcanAnswers {
  std::string version{}; ///< verbatim: "1013"
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

/// Kinds of traffic on a port instead of slcan.
enum class ForeignSpeech : std::uint8_t {
  none,    ///< nothing, slcan, or unrecognised (another baud rate)
  mavlink, ///< the telemetry of an autopilot
  text,    ///< lines that are not slcan: a satellite receiver, a console
};

} // namespace blactl::can
