// SPDX-License-Identifier: Apache-2.0
// What of a surface looks at photons, and what goes on as a path: sharp facets (mirrors, smooth glass, and what is nearly so) show too little of the photons around a point,
// and a path finds well what they show.
#ifndef SUN_TRANSPORT_PHOTONS_H
#define SUN_TRANSPORT_PHOTONS_H
#include "scene/surface.h"
#include "shared/queues.h"
#include "transport/direct.h"
#include "transport/scatter.h"

SUN_NAMESPACE_BEGIN

// Roughness^2 below which facets are sharp. Where caustics have a map of their own nothing is but deltas behind the surface that looked at it, as caustics are what these alone leave.
#define SUN_SHARP_ALPHA 0.25f

SUN_FN mask sharp_facets(const SUN_GLOBAL Frame *frame, const Lobes *l, uint_n phase) {
  mask counts = phase == (uint_n)(SUN_PHASE_SHARP);
  if ((frame->flags & SUN_FRAME_FINAL_GATHER) == 0) counts = counts | !counts;
  return (l->pick_facets > 0.0f) & (l->delta_reflection | l->delta_transmission | (counts & (l->alpha < SUN_SHARP_ALPHA)));
}

// The part that looks at photons.
SUN_FN Lobes gathering_lobes(const SUN_GLOBAL Frame *frame, const Lobes *l, uint_n phase) {
  mask sharp = sharp_facets(frame, l, phase);
  return lobes_part(l, !sharp, sharp | !sharp);
}

// Sharp facets that are no deltas look at those photons that a path does not find: what mirrors and glass make of lights without extent.
SUN_FN mask blurred_facets(const SUN_GLOBAL Frame *frame, const Lobes *l, uint_n phase) {
  return frame->light_count > 0 ? sharp_facets(frame, l, phase) & !l->delta_reflection : l->delta_reflection & !l->delta_reflection;
}

// The part that the next ray is drawn from, as `u_lobe` picks, which is made to fit. `sharp`: it goes on as a path; else the rays of gathering_lobes.
SUN_FN Lobes next_lobes(const SUN_GLOBAL Frame *frame, const Lobes *l, uint_n phase, real *u_lobe, mask *sharp) {
  mask facets = sharp_facets(frame, l, phase);
  *sharp = facets & (*u_lobe < l->pick_facets);
  mask rest = facets & !*sharp;
  *u_lobe = rest ? *u_lobe - l->pick_facets : *u_lobe;
  return lobes_part(l, !rest, !*sharp);
}

// Next-event estimation for either part by itself, as each is weighted against rays of its own.
SUN_FN DirectSample sample_direct_parts(const Scene *scene, const Surface *s, const Lobes *lobes, uint_n phase, vec3 wo_local, real u_choice, vec2 u_point, mask active) {
  EmitterSample sample = sample_emitter(scene, s, u_choice, u_point, active);
  mask valid = active & (sample.pdf > 0.0f) & (max_of3(sample.emission) > 0.0f);
  Lobes part = gathering_lobes(scene->frame, lobes, phase);
  DirectSample direct = direct_of(scene, s, &part, wo_local, &sample, weighted_by_chance(scene), valid);
  mask sharp = valid & sharp_facets(scene->frame, lobes, phase) & !lobes->delta_reflection;
  if (ANY(sharp)) {
    part = lobes_part(lobes, sharp, sharp & !sharp);
    DirectSample more = direct_of(scene, s, &part, wo_local, &sample, weighted_by_chance(scene), sharp);
    direct.contribution = select3(more.valid, add3(direct.contribution, more.contribution), direct.contribution);
    direct.valid = direct.valid | more.valid;
  }
  return direct;
}

SUN_NAMESPACE_END
#endif
