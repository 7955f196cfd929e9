#pragma once
// The values that override five registers during the soft start (4.14).

#include "sim/servo/names.hpp"

#include <cstdint>
#include <optional>

namespace blactl::sim {

/// The value in effect instead of the register's own; empty: the register is in effect.
[[nodiscard]] constexpr std::optional<std::int64_t> soft_start_value(bla::Address address) {
  constexpr std::int64_t on = 1, rpm = 30, percent = 30;
  if (address == address::speed_torque_control) {
    return on;
  }
  if (address == address::speed_limit_cw) {
    return rpm;
  }
  if (address == address::speed_limit_ccw) {
    return -rpm;
  }
  if (address == address::torque_limit_cw) {
    return percent;
  }
  return address == address::torque_limit_ccw ? std::optional(-percent) : std::nullopt;
}

} // namespace blactl::sim
