// SPDX-License-Identifier: Apache-2.0
// Where a path goes next: one direction of any lobe, or straight on where nothing scatters (a null event).
#ifndef SUN_TRANSPORT_SCATTER_H
#define SUN_TRANSPORT_SCATTER_H
#include "scene/surface.h"

SUN_NAMESPACE_BEGIN

typedef struct Scatter {
  vec3 origin, direction;
  vec3 weight;           // bsdf times cosine over pdf
  real pdf_solid_angle;  // 0: a delta direction
  mask valid;            // the path goes on
  mask straight;         // a null event: same ray, strictly behind this hit; no depth, and the pdf before it is kept for weights
} Scatter;

SUN_FN Scatter sample_scatter(const Scene *scene, const Surface *s, const Lobes *lobes, mask solid, vec3 wo_local, real u_lobe, vec2 u) {
  Scatter scatter;
  BsdfSample sample = lobes_sample(lobes, scene->tables, wo_local, u_lobe, u.x, u.y);
  scatter.direction = normalize3(to_world(&s->shading, sample.wi));
  scatter.straight = sample.valid & sample.delta & sample.transmitted & !solid;
  mask same_side = (dot3(scatter.direction, s->normal) > 0.0f) == (sample.wi.z > 0.0f);
  scatter.valid = sample.valid & (same_side | scatter.straight) & (max_of3(sample.weight) > 0.0f);
  scatter.weight = sample.weight;
  scatter.pdf_solid_angle = sample.delta ? (real)(0.0f) : sample.pdf;
  scatter.origin = surface_origin(s, scatter.direction);
  return scatter;
}

SUN_NAMESPACE_END
#endif
