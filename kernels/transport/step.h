// SPDX-License-Identifier: Apache-2.0
// What a walk does at a hit, beside the light.
#ifndef SUN_TRANSPORT_STEP_H
#define SUN_TRANSPORT_STEP_H
#include "path/path.h"
#include "shared/queues.h"
#include "transport/scatter.h"

SUN_NAMESPACE_BEGIN

// Where the surface is a partly transparent one that is not there for this path: a coin that belongs to the triangle decides.
SUN_FN mask surface_absent(const Scene *scene, const Surface *s, const HitLanes *hit, const SamplerKey *key, uint_n vertex, mask found) {
  real alpha = surface_alpha(scene, s, found);
  mask absent = found & (alpha < 1.0f);
  if (ANY(absent)) absent = absent & (alpha <= hash_coin(key, vertex, hit->instance, hit->primitive, 0));
  return absent;
}

// The ray that follows: a new one where the path turned ...
SUN_FN void path_turn(Path *path, const Scatter *scatter, mask turned) {
  path_aim(path, turned, scatter->origin, scatter->direction);
  path->pdf_solid_angle = turned ? scatter->pdf_solid_angle : path->pdf_solid_angle;
}
// ... the same strictly behind this hit where it goes straight on.
SUN_FN void path_pass(Path *path, const HitLanes *hit, mask turned, mask straight) {
  path->passed_t = turned ? (real)(0.0f) : straight ? hit->t : path->passed_t;
  path->passed_instance = turned ? (uint_n)(SUN_NONE) : straight ? hit->instance : path->passed_instance;
  path->passed_primitive = turned ? (uint_n)(SUN_NONE) : straight ? hit->primitive : path->passed_primitive;
}

// The status that a surface leaves a path with: alive, or ended for a reason; how many shadow rays its slot sends; and its depth from here on.
SUN_FN uint_n status_after(mask alive, uint_n reason, uint_n shadows, uint_n depth) {
  uint_n ended = (uint_n)(SUN_STATUS_ENDED) | (reason << (uint_n)(SUN_STATUS_ENDED_SHIFT));
  uint_n word = (alive ? (uint_n)(SUN_STATUS_ALIVE) : ended) | (shadows << (uint_n)(SUN_STATUS_SHADOWS_SHIFT));
  return word | (shadows != (uint_n)(0) ? (uint_n)(SUN_STATUS_SHADOW) : (uint_n)(0)) | depth;
}

SUN_NAMESPACE_END
#endif
