// SPDX-License-Identifier: Apache-2.0
// Shadow rays, as shading stages leave them for occlude.
#ifndef SUN_PATH_SHADOW_RAY_H
#define SUN_PATH_SHADOW_RAY_H
#include "math/record.h"
#include "math/vector.h"
#include "shared/queues.h"

SUN_NAMESPACE_BEGIN

// The words of LANES of them, in registers.
typedef struct ShadowLanes {
  vec3 origin, direction;
  real t_max;             // negative: none
  vec3 contribution;
  uint_n pixel, sample, depth, vertex, number;
  real time;              // of the path, within the shutter's
} ShadowLanes;

SUN_FN void shadow_rays_store(SUN_GLOBAL ShadowRay *shadow_rays, uint_n index, mask stored, const ShadowLanes *ray) {
  // In the order of shared/queues.h.
  uint_n words[16] = {bits_of_real(ray->origin.x),       bits_of_real(ray->origin.y),       bits_of_real(ray->origin.z),
                      bits_of_real(ray->t_max),          bits_of_real(ray->direction.x),    bits_of_real(ray->direction.y),
                      bits_of_real(ray->direction.z),    ray->pixel,                        bits_of_real(ray->contribution.x),
                      bits_of_real(ray->contribution.y), bits_of_real(ray->contribution.z), ray->sample,
                      ray->depth,                        ray->vertex,                       ray->number,
                      bits_of_real(ray->time)};
  store_records((SUN_GLOBAL uint *)shadow_rays, index, stored, words);
}

SUN_NAMESPACE_END
#endif
