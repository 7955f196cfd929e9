#pragma once
// The serial ports of this machine that may belong to a CAN adapter.

#include <filesystem>
#include <string>
#include <vector>

namespace blactl::can {

/// Ports of USB converters: by the stable names that include the product (/dev/serial/by-id, made
/// by udev), then those without such a name (ttyUSB*, ttyACM*), sorted. `devices` is /dev.
[[nodiscard]] std::vector<std::filesystem::path>
serial_adapters(const std::filesystem::path& devices = "/dev");

/// For people, in the form that -i accepts: "serial adapters of this machine: slcan:/dev/ttyACM0";
/// empty if there are none.
[[nodiscard]] std::string describe(const std::vector<std::filesystem::path>& adapters);

} // namespace blactl::can
