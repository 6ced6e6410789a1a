// SPDX-License-Identifier: Apache-2.0
// What both walks of a bidirectional method do at a hit, beside the light.
#ifndef SUN_TRANSPORT_STEP_H
#define SUN_TRANSPORT_STEP_H
#include "path/path.h"
#include "transport/both_ways.h"

SUN_NAMESPACE_BEGIN

// Where the surface is a partly transparent one that is not there for this path: a coin that belongs to the triangle decides.
SUN_FN mask surface_absent(const Scene *scene, const Surface *s, const HitLanes *hit, const SamplerKey *key, uint_n vertex, mask found) {
  real alpha = surface_alpha(scene, s, found);
  mask absent = found & (alpha < 1.0f);
  if (ANY(absent)) absent = absent & (alpha <= hash_coin(key, vertex, hit->instance, hit->primitive, 0));
  return absent;
}

// The ray that follows: a new one where the path turned, the same strictly behind this hit where it goes straight on.
SUN_FN void path_step(Path *path, const Scatter *scatter, const HitLanes *hit, mask turned, mask straight) {
  path->origin_x = turned ? scatter->origin.x : path->origin_x;
  path->origin_y = turned ? scatter->origin.y : path->origin_y;
  path->origin_z = turned ? scatter->origin.z : path->origin_z;
  path->direction_x = turned ? scatter->direction.x : path->direction_x;
  path->direction_y = turned ? scatter->direction.y : path->direction_y;
  path->direction_z = turned ? scatter->direction.z : path->direction_z;
  path->pdf_solid_angle = turned ? scatter->pdf_solid_angle : path->pdf_solid_angle;
  path->passed_t = turned ? (real)(0.0f) : straight ? hit->t : path->passed_t;
  path->passed_instance = turned ? (uint_n)(SUN_NONE) : straight ? hit->instance : path->passed_instance;
  path->passed_primitive = turned ? (uint_n)(SUN_NONE) : straight ? hit->primitive : path->passed_primitive;
}

SUN_NAMESPACE_END
#endif
