// SPDX-License-Identifier: Apache-2.0
// A picture taken as radiance from all around: three floats a pixel, linear, finite and not negative.
#pragma once
#include <cstddef>

#include "image/image.h"

namespace sunstone {

// Values that stand for no radiance and were set to 0.
struct RadianceFaults {
  std::size_t nan = 0, infinite = 0, negative = 0;
};

// Grey is spread over the three channels, alpha is left out; 8-bit pictures are decoded from sRGB, all others are taken as linear.
Image radiance_map(const Image &picture, RadianceFaults &faults);

}  // namespace sunstone
