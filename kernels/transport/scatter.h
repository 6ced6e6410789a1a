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

SUN_FN mask has_lobes(const Lobes *l) {
  return l->pick_facets + l->pick_above + l->pick_below + l->pick_grazing_above + l->pick_grazing_below > 0.0f;
}

// Draws what is no delta without a look at the lobes: evenly, or with a cosine, over the hemisphere of wo, or over both where light gets through. Deltas are
// left to the lobes: smooth facets as often as these pick them, and a solid without refraction wholly.
SUN_FN BsdfSample sample_shape(const Scene *scene, const Lobes *lobes, vec3 wo, real u_lobe, vec2 u, const BsdfSample *of_lobes) {
  BsdfSample s;
  mask smooth = lobes->delta_reflection & (lobes->pick_facets > 0.0f);
  mask unbent = (lobes->delta_transmission & (lobes->pick_facets > 0.0f)) & !lobes->delta_reflection;
  mask theirs = (smooth & (u_lobe < lobes->pick_facets)) | unbent;
  real picked = smooth ? lobes->pick_facets : (real)(0.0f), left = 1.0f - picked;
  real rest = (u_lobe - picked) / (left > 0.0f ? left : (real)(1.0f));
  // Both sides where the facets, or what they lose, lead to the far one.
  mask through = max_real(max_of3(lobes->glass_tint), max_of3(lobes->t0)) > 0.0f;
  mask clear = (lobes->pick_below + lobes->pick_grazing_below > 0.0f) | (through & !lobes->delta_transmission);
  mask below = clear & (rest >= 0.5f);
  mask even = clear & !clear;
  if (scene->frame->sampling == SUN_SAMPLING_UNIFORM) even = !even;
  s.wi = select3(even, square_to_uniform_hemisphere(u), square_to_cosine_hemisphere(u));
  s.pdf = left * (clear ? (real)(0.5f) : (real)(1.0f)) * (even ? square_to_uniform_hemisphere_pdf(s.wi) : square_to_cosine_hemisphere_pdf(s.wi));
  s.wi.z = below ? -s.wi.z : s.wi.z;
  BsdfEval e = lobes_eval(lobes, scene->tables, wo, s.wi);
  s.valid = (s.pdf > 0.0f) & (wo.z > 0.0f);
  s.weight = scale3(e.f_cos, 1.0f / (s.valid ? s.pdf : (real)(1.0f)));
  s.wi = select3(theirs, of_lobes->wi, s.wi);
  s.weight = select3(theirs, of_lobes->weight, s.weight);
  s.pdf = theirs ? of_lobes->pdf : s.pdf;
  s.valid = theirs ? of_lobes->valid : s.valid;
  s.delta = theirs & of_lobes->delta;
  s.transmitted = theirs ? of_lobes->transmitted : below;
  return s;
}

SUN_FN Scatter sample_scatter(const Scene *scene, const Surface *s, const Lobes *lobes, mask solid, vec3 wo_local, real u_lobe, vec2 u) {
  Scatter scatter;
  BsdfSample sample = lobes_sample(lobes, scene->tables, wo_local, u_lobe, u.x, u.y);
  if (scene->frame->sampling != SUN_SAMPLING_BSDF) sample = sample_shape(scene, lobes, wo_local, u_lobe, u, &sample);
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
