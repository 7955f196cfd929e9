#include "blactl/fleet/live/fault_state.hpp"

#include <algorithm>

namespace blactl::fleet {

std::optional<std::int64_t> FaultState::fault_register(bla::Address reg) const {
  return bla::fault_register(snapshot.values(), reg);
}

std::optional<bla::Level> FaultState::worst() const {
  return faults.empty() ? std::nullopt : std::optional(faults.front().level);
}

std::vector<Reading> FaultState::values_of(const bla::Fault& fault) const {
  std::vector<Reading> values;
  for (const Reading& reading : snapshot.readings) {
    const bla::Address address = reading.parameter->address;
    if (reading.raw && fault.known != nullptr &&
        std::ranges::find(fault.known->values, address) != fault.known->values.end()) {
      values.push_back(reading);
    }
  }
  return values;
}

} // namespace blactl::fleet
