#pragma once
// Decoding of a servo's fault registers 0x18-0x1B (4.12).

#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace blactl::bla {

/// 0x19, 0x1A, 0x1B: one register per level.
inline constexpr std::array fault_registers{address::fault_notice, address::fault_warning,
                                            address::fault_failure};

/// The same registers, preceded by their summary, 0x18.
inline constexpr std::array all_fault_registers{address::fault_summary, address::fault_notice,
                                                address::fault_warning, address::fault_failure};

/// One bit that is set.
struct Fault {
  Address reg;
  std::uint8_t bit = 0;
  Level level = Level::notice;
  std::string_view group;          ///< hardware, software, communication, other
  const FaultBit* known = nullptr; ///< null: undocumented

  friend bool operator==(const Fault& a, const Fault& b) {
    return a.reg == b.reg && a.bit == b.bit;
  }
};

/// The condition that holds of those that set a bit, and its registers.
struct Cause {
  std::string_view condition_en, condition_ja;
  std::span<const Address> values;
};

/// By what the servo holds; empty texts: an undocumented bit.
[[nodiscard]] Cause cause(const Fault& fault, const Values& values);

/// Whether it holds the motor output off: a measured value beyond its limit (4.7, 4.8), or a
/// failure that is present (4.12). Empty: unknown. At its limit a value sets the bit, and what the
/// output does then is unproven.
[[nodiscard]] std::optional<bool> holds_output_off(const Fault& fault, const Values& values);

/// The value of a fault register: as read, or 0 if 0x18 shows that none of its bits is set. Empty:
/// unknown.
[[nodiscard]] std::optional<std::int64_t> fault_register(const Values& values, Address reg);

/// Whether 0x18 shows that bits of this register are set; false also if 0x18 is unknown.
[[nodiscard]] bool is_summed_up(const Values& values, Address reg);

/// The bits known to be set, the worst level first. `profiles` outlives them.
[[nodiscard]] std::vector<Fault> faults(const Values& values, const Profiles& profiles);

/// The registers to read next for the faults, after 0x18: those that it points to, then those that
/// detail the bits found there. Empty: none.
[[nodiscard]] std::vector<Address> fault_details(const Values& values, const Profiles& profiles);

} // namespace blactl::bla
