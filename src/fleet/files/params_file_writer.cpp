#include "blactl/fleet/files/params_file.hpp"

#include <fmt/format.h>

namespace blactl::fleet {

std::string params_file(const Snapshot& servo, const FleetFileStyle& style) {
  const auto serial = servo.servo.identity.readings().serial_number;
  // The GUI Tool reads lines of at least two words only.
  std::string text = fmt::format("# {} {} blactl {}\n", servo.servo.identity.model(),
                                 serial ? std::to_string(*serial) : "unknown", style.tool_version);
  for (const Reading& reading : servo.readings) {
    if (reading.parameter->is_setting() && reading.raw) {
      text += fmt::format("{} {}\n", reading.parameter->address.name(), *reading.raw);
    }
  }
  return text;
}

} // namespace blactl::fleet
