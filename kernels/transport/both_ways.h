// SPDX-License-Identifier: Apache-2.0
// A point of a surface where a walk from the eye and one from a light may meet. What light does there is always asked as the eye asks, wo being the way back to
// the eye and wi that to the light: so both walks see the same surface, its normals bent towards wo, and both estimate the same integral.
#ifndef SUN_TRANSPORT_BOTH_WAYS_H
#define SUN_TRANSPORT_BOTH_WAYS_H
#include "math/measure.h"
#include "scene/surface.h"
#include "transport/scatter.h"
#include "transport/vertex_weights.h"

SUN_NAMESPACE_BEGIN

typedef struct Meeting {
  vec3 position;
  vec3 normal, unbent;  // true and shading normal, on the side from which the point was found
  real offset;
  Bsdf bsdf;            // as seen from that side
} Meeting;

SUN_FN Meeting meeting_of(const Surface *s, const Bsdf *bsdf) {
  Meeting m;
  m.position = s->position;
  m.normal = s->normal;
  m.unbent = s->unbent;
  m.offset = s->offset;
  m.bsdf = *bsdf;
  return m;
}

// What a walk that came from wo makes of it: lobes in the frame of its side.
typedef struct Side {
  Frame3 shading;
  Lobes lobes;
  vec3 wo_local, normal;
} Side;

SUN_FN Side side_of(const Scene *scene, const Meeting *m, vec3 wo) {
  Side side;
  mask same = dot3(wo, m->normal) > 0.0f;
  side.normal = select3(same, m->normal, negate3(m->normal));
  side.shading = frame_of_normal(bend_normal(select3(same, m->unbent, negate3(m->unbent)), wo, side.normal));
  side.wo_local = to_local(&side.shading, wo);
  Bsdf bsdf = m->bsdf;
  bsdf.eta = same ? bsdf.eta : 1.0f / bsdf.eta;
  side.lobes = bsdf_lobes(&bsdf, scene->tables, side.wo_local);
  return side;
}

// f cos and pdf of wi, 0 where the true side does not agree with the shading side.
SUN_FN BsdfEval side_eval(const Scene *scene, const Side *side, vec3 wi) {
  vec3 wi_local = to_local(&side->shading, wi);
  BsdfEval e = lobes_eval(&side->lobes, scene->tables, side->wo_local, wi_local);
  mask agrees = (dot3(wi, side->normal) > 0.0f) == (wi_local.z > 0.0f);
  e.f_cos = select3(agrees, e.f_cos, splat3((real)(0.0f)));
  e.pdf = agrees ? e.pdf : (real)(0.0f);
  return e;
}

// Light that came from `to_light` with the flux of a light subpath, seen from `to_eye`: f |cos| of the shading normals' one side over that of the true ones
// [Veach97 5.3.2], as the flux counts true area.
SUN_FN real flux_factor(const Meeting *m, vec3 to_light, vec3 to_eye) {
  return abs_cosine(dot3(to_eye, m->normal)) / max_real(fabs(dot3(to_light, m->normal)), (real)(SUN_LEAST_COSINE));
}

// Chance that sampling takes the delta to this side of the surface.
SUN_FN real delta_chance(const Lobes *lobes, real cosine, mask through) {
  Facet facet = facet_of(lobes, clamp_real(fabs(cosine), (real)(0.0f), (real)(1.0f)));
  return lobes->pick_facets * (through ? 1.0f - facet.reflection_chance : facet.reflection_chance);
}

SUN_FN mask only_delta(const Lobes *l) {
  mask facets_delta = (l->delta_reflection & (l->delta_transmission | ((l->glass <= 0.0f) & (max_of3(l->t0) <= 0.0f)))) | (l->pick_facets <= 0.0f);
  return facets_delta & (l->pick_above + l->pick_below + l->pick_grazing_above + l->pick_grazing_below <= 0.0f);
}

// The next ray of either walk, and what it does to the walk's weights. `light`: a walk from a light, whose scatter weight becomes the adjoint one.
SUN_FN Scatter scatter_walk(const Scene *scene, const Surface *s, const Meeting *m, const Lobes *lobes, vec3 wo, vec3 wo_local, real u_lobe, vec2 u, mask wanted,
                            int light, Walk *walk) {
  const SUN_GLOBAL Frame *frame = scene->frame;
  Scatter scatter = sample_scatter(scene, s, lobes, m->bsdf.solid, wo_local, u_lobe, u);
  mask turns = wanted & scatter.valid & !scatter.straight;
  if (!ANY(turns)) return scatter;
  mask smooth = turns & (scatter.pdf_solid_angle <= 0.0f), rough = turns & !smooth;
  real cosine_out = dot3(scatter.direction, m->normal);
  mask through = cosine_out < 0.0f;
  Side back = side_of(scene, m, scatter.direction);
  BsdfEval reverse = side_eval(scene, &back, wo);
  if (ANY(smooth)) {
    real cosine_s = to_local(&s->shading, scatter.direction).z;
    mask bent = through & m->bsdf.solid;
    real squeeze = bent ? 1.0f / (m->bsdf.eta * m->bsdf.eta) : (real)(1.0f);
    real chance = delta_chance(lobes, wo_local.z, through), chance_back = delta_chance(&back.lobes, back.wo_local.z, through);
    weights_delta(frame, walk, smooth, chance > 0.0f ? squeeze * chance_back / (chance > 0.0f ? chance : (real)(1.0f)) : (real)(0.0f), s->cos_front);
    if (light) {
      // Radiance thins in a dense medium, flux does not; and the normals' cosines [Veach97 5.3.2].
      real factor = fabs(wo_local.z) / max_real(fabs(cosine_s), (real)(SUN_LEAST_COSINE)) * flux_factor(m, wo, scatter.direction) / squeeze;
      scatter.weight = select3(smooth, scale3(scatter.weight, factor), scatter.weight);
    }
  }
  if (ANY(rough)) {
    weights_scatter(frame, walk, rough, scatter.pdf_solid_angle, reverse.pdf, cosine_out);
    if (light) {
      real scale = flux_factor(m, wo, scatter.direction) / (rough ? scatter.pdf_solid_angle : (real)(1.0f));
      scatter.weight = select3(rough, scale3(reverse.f_cos, scale), scatter.weight);
      scatter.valid = scatter.valid & (!rough | (max_of3(scatter.weight) > 0.0f));
    }
  }
  return scatter;
}

SUN_NAMESPACE_END
#endif
