// SPDX-License-Identifier: Apache-2.0
// The environment's radiance and its distribution over directions.
#pragma once
#include <glm/glm.hpp>

#include "flatten/flatten.h"

namespace sunstone {

// Fills flat.environment (but for its place among the emitters), environment_texels and environment_cdf. Where nothing shines the cdf is empty.
// Gives the luminance of the radiance integrated over the sphere.
double flatten_environment(const Scene &scene, std::size_t max_bytes, FlatScene &flat, Notices &notices);

// The distribution over a map of RGB texels: (height + 1) marginal values, then height rows of (width + 1). Every value is a whole multiple of 2^-24,
// as sample numbers are, so that a cell is chosen exactly as often as its pdf says. Empty where all is black.
//
// A cell weighs the mean luminance of the bilinear footprint over it, less the mean of all directions [Karlik19] (unless nothing were left), times
// sin(theta).
std::vector<float> environment_distribution(std::span<const float> texels, kernel::uint width, kernel::uint height);

}  // namespace sunstone
