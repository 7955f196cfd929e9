#include "sim/scenario/firmware_history.hpp"

#include <algorithm>

namespace blactl::sim {
std::vector<std::int64_t> shipped_firmware(const bla::Profiles& profiles, std::string_view model) {
  std::vector<std::int64_t> versions;
  for (const bla::FirmwareRelease& release : profiles.firmware()) {
    if (std::ranges::any_of(release.shipments,
                            [&](const auto& shipment) { return shipment.covers(model); })) {
      versions.push_back(release.version);
    }
  }
  return versions;
}

} // namespace blactl::sim
