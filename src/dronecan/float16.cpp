// IEEE 754 binary16: 1 sign bit, 5 exponent bits (bias 15), 10 fraction bits.

#include "blactl/dronecan/types.hpp"

#include "dronecan/wire.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace blactl::dronecan {
namespace {

constexpr std::uint16_t sign_bit = 0x8000;
constexpr std::uint16_t infinity = 0x7C00;
constexpr std::uint16_t not_a_number = 0x7FFF;
constexpr float largest = 65504;

// binary32: 8 exponent bits (bias 127), 23 fraction bits.
constexpr std::uint32_t f32_infinity = 0x7F80'0000;
constexpr std::uint32_t f32_smallest_normal = 0x3880'0000; // 2^-14, the smallest normal binary16
constexpr unsigned f32_fraction_bits = 23;
constexpr unsigned dropped_bits = 23 - 10;
constexpr std::uint32_t bias_difference = (127U - 15U) << f32_fraction_bits;

constexpr std::uint32_t shift_rounding_up(std::uint32_t value, unsigned shift) {
  return (value + (1U << (shift - 1))) >> shift;
}

// The unit of subnormal numbers is 2^-24. The significand (24 bits) counts in units of
// 2^(exponent - 150).
constexpr std::uint32_t to_subnormal(std::uint32_t magnitude) {
  const auto exponent = magnitude >> f32_fraction_bits;
  const auto implicit = 1U << f32_fraction_bits;
  const auto significand = (magnitude & (implicit - 1U)) | implicit;
  const auto shift = 150U - 24U - exponent;
  return shift > f32_fraction_bits + 1 ? 0 : shift_rounding_up(significand, shift);
}

} // namespace

std::uint16_t to_float16(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto magnitude = bits & 0x7FFF'FFFFU;
  if (magnitude > f32_infinity) {
    return not_a_number;
  }
  const auto rounded = magnitude < f32_smallest_normal
                           ? to_subnormal(magnitude)
                           : shift_rounding_up(magnitude - bias_difference, dropped_bits);
  const auto sign = (bits >> 16U) & sign_bit;
  return static_cast<std::uint16_t>(sign | std::min<std::uint32_t>(rounded, infinity));
}

float from_float16(std::uint16_t bits) {
  const auto magnitude = bits & 0x7FFFU;
  float value = 0;
  if (magnitude > infinity) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  if (magnitude == infinity) {
    value = std::numeric_limits<float>::infinity();
  } else if (magnitude < 0x0400) {
    value = static_cast<float>(magnitude) * 0x1p-24F;
  } else {
    value = std::bit_cast<float>((magnitude << dropped_bits) + bias_difference);
  }
  return (bits & sign_bit) != 0 ? -value : value;
}

void put_float16(Payload& payload, float value) {
  const auto saturated = std::isfinite(value) ? std::clamp(value, -largest, largest) : value;
  put_integer(payload, to_float16(saturated), 2);
}

} // namespace blactl::dronecan
