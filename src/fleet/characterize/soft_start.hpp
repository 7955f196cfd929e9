#pragma once
// The registers that the soft start overrides while it lasts (4.14).

#include "blactl/bla/values.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace blactl::fleet {

inline constexpr std::array<std::pair<bla::Address, std::int64_t>, 5> soft_start_limits{
    {{bla::address::speed_torque_control, 1},
     {bla::address::speed_limit_cw, 30},
     {bla::address::speed_limit_ccw, -30},
     {bla::address::torque_limit_cw, 30},
     {bla::address::torque_limit_ccw, -30}}};

/// Whether a servo with these settings starts softly.
[[nodiscard]] inline bool starts_softly(const bla::Values& held) {
  return bla::find(held, bla::address::torque_output) == 0 &&
         bla::find(held, bla::address::soft_start) == 1;
}

/// Whether the value may be that of a soft start instead of the register's own.
[[nodiscard]] inline bool is_soft_start_limit(bla::Address address, std::int64_t told) {
  return std::ranges::find(soft_start_limits, std::pair(address, told)) != soft_start_limits.end();
}

} // namespace blactl::fleet
