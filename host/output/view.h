// SPDX-License-Identifier: Apache-2.0
// What a screen shows of a film: exposure, tone curve, sRGB. And the linear pictures of radiance, .hdr and .tif, which take none of these.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "output/output.h"

namespace sunstone {

// The EV that brings the geometric mean of the positive luminances to 0.18, a middle grey [Reinhard02 eq. 1]; 0 where nothing shines. `rgb` is
// linear.
float automatic_exposure(std::span<const float> rgb);

// A curve that rolls off the highlights: the fit of ACES' reference curve [Narkowicz15]. 0 -> 0, infinity -> 1.
double filmic(double x);

// Rows of RGB, or RGBA with straight alpha where the background is transparent.
std::vector<std::uint8_t> view_bytes(const Film &film, const ViewOptions &options);

void write_view(const std::filesystem::path &path, const Film &film, const ViewOptions &options);

}  // namespace sunstone
