#include "blactl/bla/faults.hpp"

#include <algorithm>
#include <span>

namespace blactl::bla {
namespace {

Level level_of(Address reg) {
  return static_cast<Level>(reg.value() - address::fault_notice.value());
}

/// The four bits of 0x18 that summarise the register of this level (4.12).
std::int64_t summary_mask(Level level) {
  std::int64_t mask = 0;
  for (std::uint8_t bit = 0; bit < fault_register_bits; ++bit) {
    mask |= std::int64_t{1} << summary_bit(level, bit);
  }
  return mask;
}

/// How far the measured value is beyond its limit; of each pair the first bit is that above it.
/// Empty: one of them is not known.
std::optional<std::int64_t> excess(const FaultBit& bit, const Values& values) {
  const auto measured = find(values, bit.values.front());
  const auto limit = find(values, bit.values.back());
  if (!measured || !limit) {
    return std::nullopt;
  }
  return bit.bit % 2 == 0 ? *measured - *limit : *limit - *measured;
}

} // namespace

Cause cause(const Fault& fault, const Values& values) {
  if (fault.known == nullptr) {
    return {};
  }
  const FaultBit& bit = *fault.known;
  return bit.or_values.empty() || bit.values.empty() || excess(bit, values).value_or(0) >= 0
             ? Cause{bit.condition_en, bit.condition_ja, bit.values}
             : Cause{bit.or_condition_en, bit.or_condition_ja, bit.or_values};
}

std::optional<bool> holds_output_off(const Fault& fault, const Values& values) {
  if (fault.known == nullptr || fault.known->vendor_only) {
    return std::nullopt;
  }
  if (!fault.known->output_off || fault.known->values.empty()) {
    return fault.known->output_off;
  }
  const auto beyond = excess(*fault.known, values).value_or(0);
  return beyond > 0 ? std::optional(true) : std::nullopt; // else it may have come back meanwhile
}

std::optional<std::int64_t> fault_register(const Values& values, Address reg) {
  if (const auto read = find(values, reg)) {
    return read;
  }
  const auto summary = find(values, address::fault_summary);
  const bool is_clear =
      reg != address::fault_summary && summary && (*summary & summary_mask(level_of(reg))) == 0;
  return is_clear ? std::optional<std::int64_t>(0) : std::nullopt;
}

bool is_summed_up(const Values& values, Address reg) {
  const auto summary = find(values, address::fault_summary);
  return summary && (*summary & summary_mask(level_of(reg))) != 0;
}

std::vector<Fault> faults(const Values& values, const Profiles& profiles) {
  std::vector<Fault> found;
  for (auto it = fault_registers.rbegin(); it != fault_registers.rend(); ++it) {
    const std::int64_t bits = fault_register(values, *it).value_or(0);
    for (std::uint8_t bit = 0; bit < fault_register_bits; ++bit) {
      if ((bits >> bit & 1) != 0) {
        found.push_back({*it, bit, level_of(*it), fault_group(bit), profiles.fault_bit(*it, bit)});
      }
    }
  }
  return found;
}

std::vector<Address> fault_details(const Values& values, const Profiles& profiles) {
  std::vector<Address> wanted;
  for (const Address reg : fault_registers) {
    if (!fault_register(values, reg)) {
      wanted.push_back(reg);
    }
  }
  if (!wanted.empty()) {
    return wanted;
  }
  const auto want = [&](std::span<const Address> addresses) {
    for (const Address address : addresses) {
      if (!find(values, address) && std::ranges::find(wanted, address) == wanted.end()) {
        wanted.push_back(address);
      }
    }
  };
  for (const Fault& fault : faults(values, profiles)) {
    if (fault.known != nullptr) {
      want(fault.known->values);
      want(fault.known->or_values);
    }
  }
  return wanted;
}

} // namespace blactl::bla
