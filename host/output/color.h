// SPDX-License-Identifier: Apache-2.0
// The transfer function of sRGB, and the luminance of linear Rec. 709. [IEC61966]
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sunstone {

inline double srgb_encode(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }
inline double srgb_decode(double encoded) { return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4); }

inline double luminance(double r, double g, double b) { return 0.2126 * r + 0.7152 * g + 0.0722 * b; }

// 0..1 to the nearest of 256 steps; what lies outside is clamped.
inline std::uint8_t byte_of(double x) { return static_cast<std::uint8_t>(std::clamp(x, 0.0, 1.0) * 255 + 0.5); }

}  // namespace sunstone
