// SPDX-License-Identifier: Apache-2.0
// The worth of an emitter that a ray ran into: all of it where no shadow ray could have counted it, otherwise weighted against that, or nothing.
#ifndef SUN_TRANSPORT_EMISSION_H
#define SUN_TRANSPORT_EMISSION_H
#include "math/measure.h"
#include "scene/emitter.h"
#include "scene/surface.h"

SUN_NAMESPACE_BEGIN

// Weight of a hit after `depth` scatterings whose direction was drawn with pdf_solid_angle (0: delta), where a shadow ray draws it with pdf_emitter (0:
// never) [Veach97 9.2]. Without weights it counts where no shadow ray from the vertex before could have: seen directly, or after a delta.
SUN_FN real emission_weight(const Scene *scene, uint_n depth, real pdf_solid_angle, real pdf_emitter) {
  uint flags = scene->frame->flags;
  if ((flags & SUN_FRAME_DIRECT) == 0 || (flags & SUN_FRAME_TWICE)) return (real)(1.0f);
  mask alone = (pdf_solid_angle <= 0.0f) | (pdf_emitter <= 0.0f);
  if (flags & SUN_FRAME_WEIGHTED) return alone ? (real)(1.0f) : power_heuristic(pdf_solid_angle, pdf_emitter);
  if (flags & SUN_FRAME_FIRST) alone = alone | (depth != (uint_n)(1));
  return alone ? (real)(1.0f) : (real)(0.0f);
}

// Chance with which the triangle that was hit is chosen among the emitters; 0 where it stands not among them.
SUN_FN real hit_emitter_pmf(const Scene *scene, const HitLanes *hit, mask emits) {
  uint_n first, own;
  GATHER_UINT(first, scene->instances, hit->instance, first_emitter);
  own = gather_uint(scene->triangle_emitter, hit->primitive);
  mask known = emits & (first != (uint_n)(SUN_NONE)) & (own != (uint_n)(SUN_NONE));
  uint_n index = known ? first + own : (uint_n)(0);
  real pmf;
  GATHER_FLOAT(pmf, scene->emitters, index, pmf);
  return known ? pmf : (real)(0.0f);
}

// Solid-angle pdf with which direct.h would send a shadow ray from the ray's origin to this point of the surface.
SUN_FN real emitter_pdf(const Scene *scene, const Surface *s, const HitLanes *hit, mask emits) {
  real pmf = hit_emitter_pmf(scene, hit, emits);
  real cosine = fabs(s->cos_front);
  mask usable = (pmf > 0.0f) & (s->area > 0.0f) & (cosine > 0.0f);
  return usable ? pmf * (hit->t * hit->t) / ((usable ? s->area : (real)(1.0f)) * (usable ? cosine : (real)(1.0f))) : (real)(0.0f);
}

// Radiance times weight that a hit surface sends back along the ray; `glowing` where it sends any, whatever the weight.
SUN_FN vec3 hit_emission(const Scene *scene, const Surface *s, const HitLanes *hit, uint_n depth, real pdf_solid_angle, mask active, mask *glowing) {
  vec3 emission = surface_emission(scene, s, active);
  mask emits = active & (max_of3(emission) > 0.0f);
  *glowing = emits;
  if (!ANY(emits) || scene->frame->emitter_count == 0) return emission;
  return scale3(emission, emission_weight(scene, depth, pdf_solid_angle, emitter_pdf(scene, s, hit, emits)));
}

// Density by solid angle with which a shadow ray looks beyond the scene in this direction, by the chances of emitters; 0: never.
SUN_FN real environment_emitter_pdf(const Scene *scene, vec3 direction) {
  const SUN_GLOBAL Environment *environment = &scene->frame->environment;
  if (environment->emitter == SUN_NONE) return (real)(0.0f);
  return scene->emitters[environment->emitter].pmf * environment_pdf(environment, scene->environment_cdf, direction);
}

// hit_emission of a ray that leaves the scene.
SUN_FN vec3 escaped_emission(const Scene *scene, vec3 direction, uint_n depth, real pdf_solid_angle, mask active) {
  vec3 black = splat3((real)(0.0f));
  const SUN_GLOBAL Environment *environment = &scene->frame->environment;
  if (environment->kind == SUN_ENVIRONMENT_NONE || !ANY(active)) return black;
  vec3 radiance = environment_radiance(environment, scene->environment_texels, direction);
  real pdf = (real)(1.0f);  // of effects, whose shadow rays reach all of it, see direct.h
  if (!(scene->frame->flags & SUN_FRAME_EFFECTS)) pdf = environment_emitter_pdf(scene, direction);
  return select3(active, scale3(radiance, emission_weight(scene, depth, pdf_solid_angle, pdf)), black);
}

SUN_NAMESPACE_END
#endif
