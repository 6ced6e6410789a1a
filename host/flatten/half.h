// SPDX-License-Identifier: Apache-2.0
// IEEE halves by integer arithmetic, so that every compiler gives the same bits.
#pragma once
#include <bit>
#include <cstdint>

namespace sunstone {

// Rounds to nearest, ties to even; beyond 65504 gives infinity as IEEE 754 says.
inline std::uint16_t half_from_float(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = (bits >> 16) & 0x8000u, magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) return static_cast<std::uint16_t>(sign | 0x7e00u);
  if (magnitude >= 0x477ff000u) return static_cast<std::uint16_t>(sign | 0x7c00u);  // 65520 and above
  if (magnitude < 0x33000001u) return static_cast<std::uint16_t>(sign);             // up to half of the least subnormal
  const auto rounded = [](std::uint32_t mantissa, std::uint32_t shift) {
    const std::uint32_t kept = mantissa >> shift, rest = mantissa & ((1u << shift) - 1), middle = 1u << (shift - 1);
    return kept + ((rest > middle || (rest == middle && (kept & 1))) ? 1u : 0u);
  };
  if (magnitude < 0x38800000u) {  // subnormal as a half
    const std::uint32_t mantissa = (magnitude & 0x7fffffu) | 0x800000u;
    return static_cast<std::uint16_t>(sign | rounded(mantissa, 126u - (magnitude >> 23)));
  }
  return static_cast<std::uint16_t>(sign | rounded(magnitude - 0x38000000u, 13));  // a carry runs into the exponent, as it should
}

inline float float_from_half(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000u) << 16, exponent = (half >> 10) & 31u, mantissa = half & 0x3ffu;
  if (exponent == 0) {
    const float value = static_cast<float>(mantissa) * 5.9604644775390625e-8f;  // 2^-24
    return sign ? -value : value;
  }
  const std::uint32_t top = exponent == 31 ? 255u : exponent + 112u;
  return std::bit_cast<float>(sign | (top << 23) | (mantissa << 13));
}

}  // namespace sunstone
