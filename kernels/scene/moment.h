// SPDX-License-Identifier: Apache-2.0
// The time of LANES paths within the shutter's, and what is linear between two keys (shared/motion.h).
#ifndef SUN_SCENE_MOMENT_H
#define SUN_SCENE_MOMENT_H
#include "math/sampler.h"
#include "shared/frame.h"
#include "shared/motion.h"

SUN_NAMESPACE_BEGIN

typedef struct Moment {
  real time;    // 0 to below 1
  uint_n step;  // the key before it
  real blend;   // from that key to the next, below 1
} Moment;

SUN_FN Moment still_moment(void) {
  Moment moment;
  moment.time = moment.blend = (real)(0.0f);
  moment.step = (uint_n)(0);
  return moment;
}

SUN_FN Moment moment_of(const SUN_GLOBAL Frame *frame, real time) {
  if (!SUN_MOTION) return still_moment();
  Moment moment;
  moment.time = time;
  real scaled = time * (float)frame->motion_steps, step = floor(scaled);  // exact, as in ray_moment
  moment.step = uint_of_int(int_of_real(step));
  moment.blend = scaled - step;
  return moment;
}

// A sample has one time, whatever its vertices draw: a dimension of its own. Integrators that join vertices of several pixels need one for all of them.
SUN_FN Moment sample_moment(const SUN_GLOBAL Frame *frame, const SamplerKey *key) {
  if (!SUN_MOTION || frame->motion_steps == 0) return still_moment();
  SamplerKey of_time = *key;
  if ((frame->flags & SUN_FRAME_ONE_TIME) && (frame->flags & SUN_FRAME_PHOTONS)) of_time.sample = (uint_n)(frame->sample_first);  // all of an iteration, too
  if (frame->flags & SUN_FRAME_ONE_TIME) of_time.pixel_hash = hash3((uint_n)(frame->seed), (uint_n)(SUN_NONE), (uint_n)(SUN_NONE));
  return moment_of(frame, sample_1d(&of_time, (uint_n)(SUN_DIM_TIME)));
}

// As between_keys of scene/ray.h.
SUN_FN real blend_real(real a, real b, real blend) { return fma(blend, b - a, a); }
SUN_FN vec3 blend3(vec3 a, vec3 b, real blend) { return make_vec3(blend_real(a.x, b.x, blend), blend_real(a.y, b.y, blend), blend_real(a.z, b.z, blend)); }

SUN_NAMESPACE_END
#endif
