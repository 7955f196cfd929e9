#pragma once
// What the fault registers 0x18-0x1B of a servo tell (4.12).

#include "blactl/bla/profile.hpp"
#include "blactl/bla/values.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace blactl::bla {

/// 0x19, 0x1A, 0x1B: one register a level.
inline constexpr std::array fault_registers{address::fault_notice, address::fault_warning,
                                            address::fault_failure};

/// The same after their summary, 0x18.
inline constexpr std::array all_fault_registers{address::fault_summary, address::fault_notice,
                                                address::fault_warning, address::fault_failure};

/// One bit that is set.
struct Fault {
  Address reg;
  std::uint8_t bit = 0;
  Level level = Level::notice;
  std::string_view group;          ///< hardware, software, communication, other
  const FaultBit* known = nullptr; ///< null: no document tells what it means

  friend bool operator==(const Fault& a, const Fault& b) {
    return a.reg == b.reg && a.bit == b.bit;
  }
};

/// What a fault register holds, as read, or 0 where 0x18 tells that none of its bits is set. Empty:
/// not known.
[[nodiscard]] std::optional<std::int64_t> fault_register(const Values& values, Address reg);

/// Whether 0x18 tells that bits of this register are set; false also where 0x18 is not known.
[[nodiscard]] bool is_summed_up(const Values& values, Address reg);

/// The bits that are set as far as is known, the worst level first. `profiles` outlives them.
[[nodiscard]] std::vector<Fault> faults(const Values& values, const Profiles& profiles);

/// What to read next in order to tell the faults, after 0x18: the registers that it points to, then
/// what tells more about the bits found there. Empty: nothing.
[[nodiscard]] std::vector<Address> fault_details(const Values& values, const Profiles& profiles);

} // namespace blactl::bla
