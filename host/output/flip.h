// SPDX-License-Identifier: Apache-2.0
// FLIP: how different two pictures look to somebody who alternates between them on a screen. [Andersson20]
#pragma once
#include <span>
#include <vector>

namespace sunstone {

// A 0.7 m wide screen of 3840 pixels seen from 0.7 m.
constexpr double flip_pixels_per_degree = 67;

// A number from 0 to 1 for each pixel. The pictures are finite linear RGB; they are shown at exposure 0 without a tone curve, that is clamped to
// 0..1.
std::vector<float> flip_errors(std::span<const float> test, std::span<const float> reference, int width, int height, double pixels_per_degree);

}  // namespace sunstone
