// SPDX-License-Identifier: Apache-2.0
// Everything that emits, in one alias table by power.
#pragma once
#include "flatten/flatten.h"

namespace sunstone {

// Fills emitters, lights, environment and its arrays, and Instance::first_emitter. Geometry, materials, textures and tables have to be in place.
// Order: the emissive triangles of each instance, in the order of the triangles, then the lights, then the environment.
//
// Powers, in W for radiance in W/(m^2 sr), as luminance; R is the scene's radius (half the diagonal of its bounds):
//   triangle       pi * area * mean emission, twice that where it is double-sided
//   point, spot    integral of the intensity over directions
//   directional    pi R^2 * irradiance
//   environment    pi R^2 * integral of the radiance over directions
void flatten_emitters(const Scene &scene, std::size_t max_bytes, FlatScene &flat, Notices &notices);

}  // namespace sunstone
