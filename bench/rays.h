// SPDX-License-Identifier: Apache-2.0
// Rays for the traversal bench, each set made of the hits of the one before, the same on every run.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "flatten/flatten.h"
#include "shared/queues.h"

namespace sunstone {

// As kernels/stages/trace.cl reads them.
struct TraceRay {
  float origin[3], t_max;
  float direction[3], passed_t;
};
static_assert(sizeof(TraceRay) == 32);

// size x size pixel centres in tiles of 4 x 4, as the pipeline orders them; size is rounded up to a multiple of 4.
std::vector<TraceRay> primary_rays(const kernel::Camera &camera, unsigned size);

// One ray a hit, cosine-distributed about the geometric normal on the side that the ray came from; in the order of the hits.
std::vector<TraceRay> bounce_rays(const FlatScene &scene, std::span<const TraceRay> rays, std::span<const kernel::Hit> hits, std::uint32_t seed);

// One ray a hit, to a random point of a square a fifth of the scene wide, just below its top; t_max is short of that point.
std::vector<TraceRay> shadow_rays(const FlatScene &scene, std::span<const TraceRay> rays, std::span<const kernel::Hit> hits, std::uint32_t seed);

// A camera that looks at the whole scene from a corner of its bounds.
kernel::Camera corner_camera(const Bounds &bounds);

// 32-bit hash of a number, for made scenes and rays.
inline std::uint32_t hash_number(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

}  // namespace sunstone
