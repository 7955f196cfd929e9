#pragma once
// Registers that only the simulated servo must know by address, beside those of bla::address.

#include "blactl/bla/parameter.hpp"

namespace blactl::sim::address {

using namespace bla::address;
using bla::Address;

inline constexpr Address current_speed{0x09}, current_torque{0x0A};
inline constexpr Address current_temperature{0x0B}, current_voltage{0x0C};
inline constexpr Address fault_summary{0x18}, fault_notice{0x19};
inline constexpr Address fault_warning{0x1A}, fault_failure{0x1B};
inline constexpr Address soft_start{0x21}, smoothing{0x22};
inline constexpr Address speed_torque_control{0x25}, overcurrent_limit{0x2A};
inline constexpr Address angle_p_gain{0x2C}, angle_d_gain{0x2D};
inline constexpr Address angle_dead_band{0x2E}, angle_boost{0x2F};
inline constexpr Address pwm_neutral{0x34}, pwm_range{0x35};
inline constexpr Address speed_limit_cw{0x3A}, speed_limit_ccw{0x3B};
inline constexpr Address torque_limit_cw{0x3C}, torque_limit_ccw{0x3D};
inline constexpr Address temperature_limit_high{0x3E}, temperature_limit_low{0x3F};
inline constexpr Address voltage_limit_high{0x40}, voltage_limit_low{0x41};

} // namespace blactl::sim::address
