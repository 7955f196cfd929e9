#pragma once
// The serial ports of this machine that may have a CAN adapter behind them.

#include <filesystem>
#include <string>
#include <vector>

namespace blactl::can {

/// Ports of USB converters: by the names that tell the product and stay the same
/// (/dev/serial/by-id, made by udev), then those without such a name (ttyUSB*, ttyACM*), sorted.
/// `devices` is /dev.
[[nodiscard]] std::vector<std::filesystem::path>
serial_adapters(const std::filesystem::path& devices = "/dev");

/// For a person, as -i takes them: "serial adapters of this machine: slcan:/dev/ttyACM0"; empty if
/// there are none.
[[nodiscard]] std::string describe(const std::vector<std::filesystem::path>& adapters);

} // namespace blactl::can
