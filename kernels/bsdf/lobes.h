// SPDX-License-Identifier: Apache-2.0
// What a material makes of one direction wo: the weights of its lobes, found once and used by eval and by sample.
//   facets    GGX reflection, and transmission: mirrored through the plane (thin) or refracted (solid). Deltas where smooth.
//   above     cosine-like, reflected: the diffuse base, and what facets lost and gave back
//   below     cosine-like, transmitted: what facets lost and let through
//   grazing   another way to sample what facets lost: smooth surfaces lose light near grazing directions, which cosines seldom pick
// Shares: metallic m; of the rest, transmission t; m + (1-m)t + (1-m)(1-t) = 1. Each share alone is energy-exact, and all enter linearly.
#ifndef SUN_BSDF_LOBES_H
#define SUN_BSDF_LOBES_H
#include "bsdf/dielectric.h"

SUN_NAMESPACE_BEGIN

typedef struct Bsdf {  // one hit's parameters, textures already looked up
  vec3 base;           // base colour: linear, 0 to 1
  real metallic;
  real alpha;          // roughness^2; below SUN_ALPHA_SMOOTH: perfectly smooth
  vec3 f0;             // dielectric reflectance (Schlick) at normal incidence
  real f90;            // and at grazing incidence; of solid glass: scales the exact reflectance
  real transmission;
  real eta;            // ior of the far side / ior of the side of wo; solid glass alone looks at it
  mask solid;          // transmission refracts; else the surface is a thin slab
  mask inside;         // wo is within the solid: the caller's note of why eta is the inverse
  mask specular;       // has anything but the diffuse lobe
} Bsdf;

typedef struct Lobes {
  vec3 r0, r90;            // facets reflect r0 + (r90 - r0) (1 - o.h)^5, and glass on top
  vec3 t0, t90;            // thin facets transmit likewise
  vec3 glass_tint;         // share of solid glass * base colour
  real glass, glass_f90;   // share of solid glass
  real eta, inverse_eta, alpha;
  real eta_axis, alpha_axis;  // places in the tables
  mask coated;             // reflects by the tables of GGX: has metal, or a coat of Schlick's
  mask some_glass;         // glass > 0
  mask rough_glass;        // and loses light among its facets
  mask refracts;           // solid
  mask delta_reflection, delta_transmission;
  vec3 diffuse;            // times 1 - S(i)
  real s0, s90, s_lost;    // S = s0 a + s90 b + s_lost lost: what the coat over the diffuse base reflects
  vec3 above, below;       // times lost(i)
  real glass_above;        // times 1 - E(i) of the side of wo
  vec3 glass_below;        // times 1 - E(i) of the far side
  real chance_least, chance_most;  // of reflection, where facets both reflect and transmit: 0 and 1, but where one of the two is wanted alone
  real pick_facets, pick_above, pick_below, pick_grazing_above, pick_grazing_below;  // pmf of the strategies of sample
  mask specular;
} Lobes;

// wo.z > 0.
SUN_INLINE Lobes bsdf_lobes(const Bsdf *b, const SUN_GLOBAL float *tables, vec3 wo) {
  const real zero = (real)(0.0f);
  const vec3 black = splat3(zero);
  Lobes l;
  real cosine_o = clamp_real(wo.z, (real)(SUN_MIN_COSINE), (real)(1.0f));
  mask smooth = b->alpha < SUN_ALPHA_SMOOTH;
  real dielectric = 1.0f - b->metallic;
  real clear = dielectric * b->transmission;
  l.specular = b->specular;
  l.chance_least = zero;
  l.chance_most = (real)(1.0f);
  l.alpha = smooth ? (real)(SUN_ALPHA_SMOOTH) : b->alpha;
  l.eta = b->eta;
  l.inverse_eta = 1.0f / b->eta;
  l.refracts = b->solid;
  l.glass = (b->solid & b->specular) ? clear : zero;
  l.glass_f90 = b->f90;
  l.glass_tint = scale3(b->base, l.glass);
  l.some_glass = l.glass > 0.0f;
  l.coated = b->specular & ((dielectric - l.glass > 0.0f) | (b->metallic > 0.0f));
  l.delta_reflection = smooth;
  l.delta_transmission = smooth | (b->solid & (fabs(b->eta - 1.0f) < SUN_SAME_IOR));
  l.rough_glass = l.some_glass & !l.delta_transmission;
  l.alpha_axis = l.eta_axis = zero;
  if (ANY(l.coated | l.rough_glass)) {
    l.alpha_axis = smooth ? zero : table_axis(b->alpha);
    l.eta_axis = glass_axis(b->eta);
  }
  l.diffuse = scale3(b->base, (dielectric - clear) * SUN_INV_PI);
  l.r0 = l.r90 = l.t0 = l.t90 = l.above = l.below = l.glass_below = black;
  l.s0 = l.s90 = l.s_lost = l.glass_above = zero;
  real facets = zero, base = luminance(l.diffuse) * SUN_PI, above = zero, below = zero;  // albedos
  if (ANY(l.coated)) {  // of lanes that are not, all of this is 0, whatever the tables say
    real coat = b->specular ? dielectric - l.glass : zero;  // the share with a Schlick coat
    real metal = b->specular ? b->metallic : zero;
    vec3 thin = scale3(b->base, coat - (b->specular ? dielectric - clear : zero));
    real f90 = b->f90;
    Split at_o = split_albedo(tables, l.alpha_axis, cosine_o), mean = split_mean(tables, l.alpha_axis);
    real scale = at_o.lost * lobe_scale(mean.lost);
    vec3 coat_returns = returned_share3(b->f0, f90, mean.lost), metal_returns = returned_share3(b->base, (real)(1.0f), mean.lost);
    l.r0 = add3(scale3(b->base, metal), scale3(b->f0, coat));
    l.r90 = splat3(metal + coat * f90);
    l.t0 = sub3(thin, mul3(thin, b->f0));
    l.t90 = scale3(thin, 1.0f - f90);
    l.above = scale3(add3(scale3(metal_returns, metal), scale3(coat_returns, coat)), scale);
    l.below = scale3(sub3(thin, mul3(thin, coat_returns)), scale);

    // The diffuse base gets what the coat lets through on the way in, (1 - S(i)), and on the way out; over the mean, as it goes on between them.
    real s0 = max_of3(b->f0);
    l.s0 = b->specular ? s0 : zero;
    l.s90 = b->specular ? f90 : zero;
    l.s_lost = b->specular ? returned_share(s0, f90, mean.lost) : zero;
    real passes = max_real(1.0f - (l.s0 * at_o.a + l.s90 * at_o.b + l.s_lost * at_o.lost), zero);
    real passes_mean = max_real(1.0f - (l.s0 * mean.a + l.s90 * mean.b + l.s_lost * mean.lost), (real)(1e-6f));
    l.diffuse = scale3(l.diffuse, passes / passes_mean);

    facets = luminance(add3(l.r0, l.t0)) * at_o.a + luminance(add3(l.r90, l.t90)) * at_o.b;
    base = base * passes;
    above = luminance(l.above) * mean.lost * SUN_PI;
    below = luminance(l.below) * mean.lost * SUN_PI;
  }
  real lost = zero;
  if (ANY(l.rough_glass)) {
    // Lost light leaves on either side so that the pair is reciprocal, (1 - above) (1 - Emean) n^2 being the same from both sides [Kulla17].
    uint_n side = l.eta < 1.0f ? (uint_n)(1) : (uint_n)(0), far_side = (uint_n)(1) - side;
    real mean_lost = 1.0f - glass_mean(tables, side, l.eta_axis, l.alpha_axis);
    real far_lost = 1.0f - glass_mean(tables, far_side, l.eta_axis, l.alpha_axis);
    // A facet that reflects less than Fresnel asks loses less than the tables say; f90 keeps the sum below 1.
    lost = max_real(1.0f - glass_albedo(tables, side, l.eta_axis, l.alpha_axis, cosine_o), zero) * b->f90;
    lost = l.rough_glass ? lost : zero;
    real through = mean_transmittance(l.eta) * min_real(mean_lost, far_lost) / max_real(mean_lost, (real)(1e-6f));
    l.glass_above = l.glass * (1.0f - through) * lost * lobe_scale(mean_lost);
    l.glass_below = scale3(l.glass_tint, through * lost * lobe_scale(far_lost) * (l.inverse_eta * l.inverse_eta));
    above = above + l.glass * (1.0f - through) * lost;
    below = below + luminance(l.glass_tint) * through * lost;
  }
  facets = facets + l.glass * (1.0f - lost);
  // A floor keeps a faint highlight from being left to rare, heavy samples.
  facets = facets > 0.0f ? max_real(facets, 0.1f * (facets + base + above + below)) : zero;
  real total = facets + base + above + below;
  total = total > 0.0f ? total : (real)(1.0f);
  real grazing = 0.5f - 0.5f * l.alpha;
  l.pick_facets = facets / total;
  l.pick_above = (base + above * (1.0f - grazing)) / total;
  l.pick_below = below * (1.0f - grazing) / total;
  l.pick_grazing_above = above * grazing / total;
  l.pick_grazing_below = below * grazing / total;
  return l;
}

// Where anything but deltas may be: elsewhere lobes_eval gives black.
SUN_FN mask lobes_spread(const Lobes *l) {
  real most = max_real(max_of3(l->diffuse), max_real(max_of3(l->above), max_of3(l->below)));
  return (most > 0.0f) | l->rough_glass | (l->specular & !(l->delta_reflection & l->delta_transmission));
}

// The facets alone, either what they reflect or what they transmit: an effect to be followed by rays of its own.
SUN_FN Lobes facets_alone(const Lobes *lobes, mask through) {
  const real zero = (real)(0.0f), one = (real)(1.0f);
  Lobes l = *lobes;
  l.diffuse = l.above = l.below = l.glass_below = splat3(zero);
  l.glass_above = l.pick_above = l.pick_below = l.pick_grazing_above = l.pick_grazing_below = zero;
  l.pick_facets = one;
  l.chance_least = through ? zero : one;
  l.chance_most = l.chance_least;
  return l;
}

// The lobes without their facets, or the facets without the rest, each with the pmf that it has among all: the two add up, f by f and pdf by pdf.
SUN_FN Lobes lobes_part(const Lobes *lobes, mask facets, mask rest) {
  const real zero = (real)(0.0f);
  const vec3 black = splat3(zero);
  Lobes l = *lobes;
  l.r0 = select3(facets, l.r0, black);
  l.r90 = select3(facets, l.r90, black);
  l.t0 = select3(facets, l.t0, black);
  l.t90 = select3(facets, l.t90, black);
  l.glass_tint = select3(facets, l.glass_tint, black);
  l.glass = facets ? l.glass : zero;
  l.pick_facets = facets ? l.pick_facets : zero;
  l.diffuse = select3(rest, l.diffuse, black);
  l.above = select3(rest, l.above, black);
  l.below = select3(rest, l.below, black);
  l.glass_below = select3(rest, l.glass_below, black);
  l.glass_above = rest ? l.glass_above : zero;
  l.pick_above = rest ? l.pick_above : zero;
  l.pick_below = rest ? l.pick_below : zero;
  l.pick_grazing_above = rest ? l.pick_grazing_above : zero;
  l.pick_grazing_below = rest ? l.pick_grazing_below : zero;
  return l;
}

SUN_NAMESPACE_END
#endif
