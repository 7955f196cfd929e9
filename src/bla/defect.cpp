#include "blactl/bla/defect.hpp"

#include <string>

namespace blactl::bla {

bool may_stall(const Identity& servo) {
  constexpr std::int64_t mended_in = 1400;
  const auto firmware = servo.readings().firmware_version;
  const std::string model = servo.model();
  return firmware && *firmware < mended_in &&
         (model.starts_with("BLA15") || model.starts_with("BLA21"));
}

} // namespace blactl::bla
