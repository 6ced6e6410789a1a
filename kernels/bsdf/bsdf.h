// SPDX-License-Identifier: Apache-2.0
// The one BSDF of every material: eval, sample, albedo. Local space: z is the shading normal on the side of wo, wo.z > 0; wo and wi point away from
// the surface. bsdf_eval and bsdf_sample are short for the pair bsdf_lobes (once a hit) and lobes_eval, lobes_sample.
// f is for radiance: what refraction lets through holds the factor 1 / eta^2, by which radiance thins on leaving a dense medium [Veach97 5.2], as in
// Walter's formula. A path that enters and leaves has none left; one that ends within the glass keeps it.
// Reciprocal: f(wo, wi) = f(wi, wo), and across a solid's surface eta^2 f(wo, wi) = f'(wi, wo), f' being the same surface from the other side.
#ifndef SUN_BSDF_BSDF_H
#define SUN_BSDF_BSDF_H
#include "bsdf/lobes.h"
#include "math/warp.h"

SUN_NAMESPACE_BEGIN

typedef struct BsdfEval {
  vec3 f_cos;  // f |cos i|
  real pdf;    // of lobes_sample giving wi, by solid angle
} BsdfEval;

typedef struct BsdfSample {
  vec3 wi;
  vec3 weight;  // f |cos i| / pdf
  real pdf;     // by solid angle; 0 for a delta
  mask delta;
  mask valid;   // else the path ends: weight is 0
  mask transmitted;
} BsdfSample;

// Directions whose cosine c has density 1 / (2 sqrt(c)): of a cosine-distributed one, c = z^4.
SUN_FN vec3 cosine_to_grazing_hemisphere(vec3 v) {
  real z = v.z * v.z;
  z = max_real(z * z, (real)(SUN_MIN_COSINE));
  real scale = sqrt_or_zero((1.0f - z) * (1.0f + z) / max_real((1.0f - v.z) * (1.0f + v.z), (real)(1e-20f)));
  return make_vec3(v.x * scale, v.y * scale, z);
}
SUN_FN real grazing_hemisphere_pdf(real cosine) { return SUN_INV_FOUR_PI / sqrt(cosine); }

// What one facet does to light, and the chance that sample takes reflection there.
typedef struct Facet {
  vec3 reflected, transmitted;
  real reflection_chance;
} Facet;

SUN_FN Facet facet_of(const Lobes *l, real cosine_oh) {
  Facet f;
  real w = schlick_weight(cosine_oh);
  f.reflected = lerp3(l->r0, l->r90, w);
  f.transmitted = lerp3(l->t0, l->t90, w);
  if (ANY(l->some_glass)) {
    real cosine_far = refracted_cosine(cosine_oh, l->inverse_eta);
    real exact = fresnel_dielectric(cosine_oh, l->eta, cosine_far);
    real scaled = cosine_far > 0.0f ? exact * l->glass_f90 : (real)(1.0f);  // nothing can leave under total reflection
    mask bends = !(fabs(l->eta - 1.0f) < SUN_SAME_IOR);
    scaled = bends ? scaled : (real)(0.0f);
    f.reflected = add3(f.reflected, splat3(l->glass * scaled));
    f.transmitted = add3(f.transmitted, scale3(l->glass_tint, 1.0f - scaled));
  }
  real reflected = luminance(f.reflected), both = reflected + luminance(f.transmitted);
  f.reflection_chance = clamp_real(both > 0.0f ? reflected / both : (real)(1.0f), l->chance_least, l->chance_most);
  return f;
}

// Everything that is not a delta.
SUN_FN BsdfEval lobes_eval(const Lobes *l, const SUN_GLOBAL float *tables, vec3 wo, vec3 wi) {
  const real zero = (real)(0.0f);
  BsdfEval e;
  mask upper = wi.z > 0.0f;
  real cosine_o = clamp_real(wo.z, (real)(SUN_MIN_COSINE), (real)(1.0f)), cosine_i = clamp_real(fabs(wi.z), (real)(SUN_MIN_COSINE), (real)(1.0f));
  vec3 f = select3(upper, l->diffuse, splat3(zero));
  e.pdf = (upper ? l->pick_above : l->pick_below) * (cosine_i * SUN_INV_PI);
  if (ANY(l->coated)) {
    Split at_i = split_albedo(tables, l->alpha_axis, cosine_i);
    f = scale3(f, 1.0f - (l->s0 * at_i.a + l->s90 * at_i.b + l->s_lost * at_i.lost));
    f = add3(f, scale3(select3(upper, l->above, l->below), at_i.lost));
  }
  if (ANY(l->specular)) {
    e.pdf = e.pdf + (upper ? l->pick_grazing_above : l->pick_grazing_below) * grazing_hemisphere_pdf(cosine_i);
  }
  if (ANY(l->rough_glass)) {
    mask thinner = l->eta < 1.0f;
    uint_n side = (upper & thinner) | (!upper & !thinner) ? (uint_n)(1) : (uint_n)(0);
    real lost = max_real(1.0f - glass_albedo(tables, side, l->eta_axis, l->alpha_axis, cosine_i), zero);
    f = add3(f, scale3(select3(upper, splat3(l->glass_above), l->glass_below), lost));
  }
  e.f_cos = scale3(f, cosine_i);
  mask refraction = l->refracts & !upper;
  mask facets = upper ? !l->delta_reflection : !l->delta_transmission;
  facets = facets & l->specular;
  if (ANY(facets)) {
    // A thin slab's transmission is its reflection, mirrored through the plane. A refracted direction has a normal and a Jacobian of its own.
    vec3 h = normalize3(make_vec3(wo.x + wi.x, wo.y + wi.y, wo.z + fabs(wi.z)));
    if (ANY(refraction)) h = select3(refraction, refraction_normal(wo, wi, l->eta), h);
    real cosine_oh = dot3(wo, h), cosine_ih = dot3(wi, h);
    facets = facets & (cosine_oh > 0.0f) & ((cosine_ih < 0.0f) | !refraction);
    cosine_oh = clamp_real(cosine_oh, zero, (real)(1.0f));
    real root_o = smith_root(cosine_o, l->alpha), root_i = smith_root(cosine_i, l->alpha);
    real density = ggx_density(h, l->alpha);
    real spread = cosine_oh + l->eta * cosine_ih;
    real jacobian = refraction ? 4.0f * cosine_oh * fabs(cosine_ih) / max_real(spread * spread, (real)(1e-16f)) : (real)(1.0f);
    real squeeze = refraction ? l->eta * l->eta : (real)(1.0f);
    Facet facet = facet_of(l, cosine_oh);
    real chance = upper ? facet.reflection_chance : 1.0f - facet.reflection_chance;
    real common = facets ? density * jacobian : zero;
    e.f_cos = add3(e.f_cos, scale3(select3(upper, facet.reflected, facet.transmitted),
                                   common * cosine_i * smith_visibility(cosine_o, root_o, cosine_i, root_i)));
    e.pdf = e.pdf + l->pick_facets * chance * (common * squeeze * smith_masking(cosine_o, root_o));
  }
  mask seen = wo.z > 0.0f;
  e.f_cos = select3(seen, e.f_cos, splat3(zero));
  e.pdf = seen ? e.pdf : zero;
  return e;
}

// u_lobe picks a strategy (see lobes.h), and then what the facet does; u0, u1 the direction.
SUN_FN BsdfSample lobes_sample(const Lobes *l, const SUN_GLOBAL float *tables, vec3 wo, real u_lobe, real u0, real u1) {
  const real zero = (real)(0.0f);
  BsdfSample s;
  mask facets = u_lobe < l->pick_facets;
  real to_grazing_below = l->pick_facets + l->pick_grazing_below, to_grazing_above = to_grazing_below + l->pick_grazing_above;
  real to_below = to_grazing_above + l->pick_below;
  mask grazing = u_lobe < to_grazing_above;
  s.transmitted = (u_lobe < to_grazing_below) | (!grazing & (u_lobe < to_below));  // of facets: below
  s.delta = s.transmitted & !s.transmitted;
  s.valid = wo.z > 0.0f;
  s.wi = square_to_cosine_hemisphere(make_vec2(u0, u1));
  s.wi = select3(grazing, cosine_to_grazing_hemisphere(s.wi), s.wi);
  s.wi.z = s.transmitted ? -s.wi.z : s.wi.z;
  vec3 delta_weight = splat3(zero);
  if (ANY(facets)) {
    const vec3 up = make_vec3(zero, zero, (real)(1.0f));
    vec3 h = select3(l->delta_reflection, up, sample_visible_normal(wo, l->alpha, u0, u1));
    real cosine_oh = clamp_real(dot3(wo, h), zero, (real)(1.0f));
    Facet facet = facet_of(l, cosine_oh);
    real u = u_lobe / max_real(l->pick_facets, (real)(1e-20f));
    mask through = facets & (u >= facet.reflection_chance);
    vec3 wi = mirror_about(wo, h);
    mask fits = wi.z > 0.0f;
    wi.z = through ? -wi.z : wi.z;
    if (ANY(through & l->refracts)) {
      real cosine_far = refracted_cosine(cosine_oh, l->inverse_eta);
      vec3 refracted = refract_about(wo, h, l->inverse_eta, cosine_oh, cosine_far);
      mask bent = through & l->refracts;
      wi = select3(bent, refracted, wi);
      fits = bent ? (refracted.z < 0.0f) & (cosine_far > 0.0f) : fits;
    }
    mask delta = through ? l->delta_transmission : l->delta_reflection;
    mask straight = through & delta & ((fabs(l->eta - 1.0f) < SUN_SAME_IOR) | !l->refracts);
    wi = select3(straight, negate3(wo), wi);
    fits = fits | straight;
    real chance = through ? 1.0f - facet.reflection_chance : facet.reflection_chance;
    real thinning = (through & l->refracts & !straight) ? l->inverse_eta * l->inverse_eta : (real)(1.0f);
    delta_weight = scale3(select3(through, facet.transmitted, facet.reflected), thinning / max_real(l->pick_facets * chance, (real)(1e-20f)));
    s.wi = select3(facets, wi, s.wi);
    s.transmitted = facets ? through : s.transmitted;
    s.delta = facets & delta;
    s.valid = s.valid & (fits | !facets);
  }
  BsdfEval e = lobes_eval(l, tables, wo, s.wi);
  s.pdf = s.delta ? zero : e.pdf;
  s.valid = s.valid & (s.delta | (e.pdf > 0.0f));
  vec3 weight = select3(s.delta, delta_weight, scale3(e.f_cos, 1.0f / (e.pdf > 0.0f ? e.pdf : (real)(1.0f))));
  s.weight = select3(s.valid, weight, splat3(zero));
  return s;
}

// The deltas under the cosine of wo, both at once, for those who follow each: mirrored, and refracted or straight on. Weights are f |cos i| over a chance of 1,
// and what has none is black.
typedef struct Deltas {
  vec3 reflected, transmitted;
  real cosine_far;  // see refract_about
  mask straight;    // what is transmitted is not bent
} Deltas;

SUN_FN Deltas lobes_deltas(const Lobes *l, real cosine_o) {
  Deltas d;
  real cosine = clamp_real(cosine_o, (real)(0.0f), (real)(1.0f));
  Facet facet = facet_of(l, cosine);
  d.cosine_far = refracted_cosine(cosine, l->inverse_eta);
  d.straight = (fabs(l->eta - 1.0f) < SUN_SAME_IOR) | !l->refracts;
  mask seen = l->specular & (cosine_o > 0.0f);
  mask leaves = d.straight | (d.cosine_far > 0.0f);
  real thinning = d.straight ? (real)(1.0f) : l->inverse_eta * l->inverse_eta;
  d.reflected = select3(seen & l->delta_reflection, facet.reflected, splat3((real)(0.0f)));
  d.transmitted = select3(seen & l->delta_transmission & leaves, scale3(facet.transmitted, thinning), splat3((real)(0.0f)));
  return d;
}

SUN_FN BsdfEval bsdf_eval(const Bsdf *b, const SUN_GLOBAL float *tables, vec3 wo, vec3 wi) {
  Lobes l = bsdf_lobes(b, tables, wo);
  return lobes_eval(&l, tables, wo, wi);
}
SUN_FN BsdfSample bsdf_sample(const Bsdf *b, const SUN_GLOBAL float *tables, vec3 wo, real u_lobe, real u0, real u1) {
  Lobes l = bsdf_lobes(b, tables, wo);
  return lobes_sample(&l, tables, wo, u_lobe, u0, u1);
}

// Transmittance of the part that goes straight on: smooth thin transmission, or a solid of the surroundings' ior. bsdf_sample gives it too.
// The same from either side.
SUN_FN vec3 bsdf_straight(const Bsdf *b, vec3 wo) {
  real w = schlick_weight(fabs(wo.z));
  real clear = (1.0f - b->metallic) * b->transmission;
  vec3 thin = mul3(b->base, sub3(splat3((real)(1.0f)), lerp3(b->f0, splat3(b->f90), w)));
  mask same = fabs(b->eta - 1.0f) < SUN_SAME_IOR;
  mask passes = b->specular & (b->solid ? same : b->alpha < SUN_ALPHA_SMOOTH);
  return select3(passes, scale3(select3(b->solid, b->base, thin), clear), splat3((real)(0.0f)));
}

// Share of white light from all sides that leaves along wo: for the layer "albedo". Exact but for solid glass, whose Fresnel term is taken at wo.
SUN_FN vec3 bsdf_albedo(const Bsdf *b, const SUN_GLOBAL float *tables, vec3 wo) {
  const real one = (real)(1.0f);
  real cosine_o = clamp_real(wo.z, (real)(SUN_MIN_COSINE), one);
  real dielectric = 1.0f - b->metallic, clear = dielectric * b->transmission;
  vec3 sum = scale3(b->base, dielectric - clear);
  if (ANY(b->specular)) {
    real alpha_axis = table_axis(b->alpha);
    Split at_o = split_albedo(tables, alpha_axis, cosine_o);
    real mean_lost = split_mean(tables, alpha_axis).lost;
    vec3 coat = add3(scale3(b->f0, at_o.a), add3(splat3(b->f90 * at_o.b), scale3(returned_share3(b->f0, b->f90, mean_lost), at_o.lost)));
    vec3 metal = add3(scale3(b->base, at_o.a), add3(splat3(at_o.b), scale3(returned_share3(b->base, one, mean_lost), at_o.lost)));
    real s0 = max_of3(b->f0);
    real s = s0 * at_o.a + b->f90 * at_o.b + returned_share(s0, b->f90, mean_lost) * at_o.lost;
    vec3 full = add3(scale3(metal, b->metallic), add3(scale3(coat, dielectric - clear), scale3(b->base, (dielectric - clear) * (1.0f - s))));
    vec3 thin = add3(coat, sub3(b->base, mul3(b->base, coat)));
    real cosine_far = refracted_cosine(cosine_o, 1.0f / b->eta);
    real exact = fresnel_dielectric(cosine_o, b->eta, cosine_far);
    real scaled = cosine_far > 0.0f ? exact * b->f90 : one;
    vec3 glass = add3(splat3(scaled), scale3(b->base, 1.0f - scaled));
    sum = select3(b->specular, add3(full, scale3(select3(b->solid, glass, thin), clear)), sum);
  }
  return sum;
}

SUN_NAMESPACE_END
#endif
