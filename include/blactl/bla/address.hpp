#pragma once
// The registers of a BLA servo by address (tables 3-1 to 3-11).

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::bla {

/// A register's address, 0x00..0x5F ("0x2A" on the wire and in every output).
class Address {
 public:
  constexpr Address() = default;

  constexpr explicit Address(std::uint8_t value) : value_(value) {}

  [[nodiscard]] constexpr std::uint8_t value() const { return value_; }

  /// The form that the servo requires: "0x" and two upper-case hexadecimal digits (table 2-14).
  [[nodiscard]] std::string name() const;
  friend constexpr auto operator<=>(Address, Address) = default;

 private:
  std::uint8_t value_ = 0;
};

/// The address written as `text`: "0x" and two hexadecimal digits, letters of either case. Null:
/// not an address, or above 0x5F, where the servo has no registers.
[[nodiscard]] std::optional<Address> find_address(std::string_view text);

/// Registers that the program itself must know; all others are in the profiles only.
namespace address {
inline constexpr Address command_angle{0x00}, command_speed{0x01}, command_torque{0x02};
inline constexpr Address current_angle{0x08}, current_speed{0x09}, current_torque{0x0A};
inline constexpr Address current_temperature{0x0B}, current_voltage{0x0C};
inline constexpr Address initialize{0x10}, reboot{0x11}, write_rom{0x12};
inline constexpr Address fault_summary{0x18}, fault_notice{0x19};
inline constexpr Address fault_warning{0x1A}, fault_failure{0x1B};
inline constexpr Address torque_output{0x20}, soft_start{0x21}, smoothing{0x22}, reverse{0x23};
inline constexpr Address extended_angle{0x24}, speed_torque_control{0x25};
inline constexpr Address timeout_action{0x26}, timeout_time{0x27}, overcurrent_limit{0x2A};
inline constexpr Address angle_p_gain{0x2C}, angle_d_gain{0x2D};
inline constexpr Address angle_dead_band{0x2E}, angle_boost{0x2F};
inline constexpr Address speed_p_gain{0x30}, speed_i_gain{0x31};
inline constexpr Address speed_dead_band{0x32}, speed_i_limit{0x33};
inline constexpr Address pwm_neutral{0x34}, pwm_range{0x35};
inline constexpr Address pwm_output_range{0x36}, pwm_mode{0x37};
inline constexpr Address angle_limit_cw{0x38}, angle_limit_ccw{0x39};
inline constexpr Address speed_limit_cw{0x3A}, speed_limit_ccw{0x3B};
inline constexpr Address torque_limit_cw{0x3C}, torque_limit_ccw{0x3D};
inline constexpr Address temperature_limit_high{0x3E}, temperature_limit_low{0x3F};
inline constexpr Address voltage_limit_high{0x40}, voltage_limit_low{0x41};
inline constexpr Address origin{0x44}, servo_id{0x45}, static_node_id{0x46}, bootloader{0x49};
inline constexpr Address model_number{0x50}, serial_number{0x51};
inline constexpr Address firmware_version{0x52}, hardware_version{0x53};
inline constexpr Address production_year{0x58}, production_month{0x59}, production_day{0x5A};
inline constexpr Address production_hour{0x5B}, production_minute{0x5C};
} // namespace address

/// The registers that move the shaft (4.1 to 4.3): none of them is kept in ROM.
inline constexpr std::array command_registers{address::command_angle, address::command_speed,
                                              address::command_torque};

/// Whether no two servos on a bus may hold the same value of it: servo ID, static node ID.
[[nodiscard]] constexpr bool is_id(Address address) {
  return address == address::servo_id || address == address::static_node_id;
}

} // namespace blactl::bla
