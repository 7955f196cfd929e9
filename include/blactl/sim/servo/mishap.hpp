#pragma once
// Sudden faults of a simulated servo, other than those that follow from its surroundings.

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

namespace blactl::sim {

enum class Mishap : std::uint8_t {
  power_off,      ///< dead, RAM is lost; the same as plugged=off
  power_on,       ///< starts from ROM
  clock_error,    ///< restarts by itself and reports the cause (4.12, note 2): 0x1B.8
  watchdog_error, ///< the same: 0x1B.9
  ram_error,      ///< the same: 0x1B.11
  rom_error,      ///< restarts by itself, and cannot read ROM at that start: 0x1A.15
};

/// All mishaps with their words: "power_off", "power_on", "clock_error", "watchdog_error",
/// "ram_error", "rom_error".
inline constexpr std::array mishaps{
    std::pair{std::string_view("power_off"), Mishap::power_off},
    std::pair{std::string_view("power_on"), Mishap::power_on},
    std::pair{std::string_view("clock_error"), Mishap::clock_error},
    std::pair{std::string_view("watchdog_error"), Mishap::watchdog_error},
    std::pair{std::string_view("ram_error"), Mishap::ram_error},
    std::pair{std::string_view("rom_error"), Mishap::rom_error},
};

} // namespace blactl::sim
