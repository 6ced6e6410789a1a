// SPDX-License-Identifier: Apache-2.0
// The smooth and the rough interface between two clear media [Walter07]. eta = ior of the far side / ior of the side of wo, throughout.
#ifndef SUN_BSDF_DIELECTRIC_H
#define SUN_BSDF_DIELECTRIC_H
#include "bsdf/energy.h"

SUN_NAMESPACE_BEGIN

// Media nearer than this pass light straight on: the half vector of a refraction would have no digits left.
#define SUN_SAME_IOR 1e-4f

// Snell's law: the cosine on the far side; 0 under total internal reflection.
SUN_FN real refracted_cosine(real cosine, real inverse_eta) { return sqrt_or_zero(1.0f - (1.0f - cosine * cosine) * (inverse_eta * inverse_eta)); }

// Unpolarised reflectance, 1 under total internal reflection. The mean of the squares of (eta c - f) / (eta c + f) and (c - eta f) / (c + eta f), in one quotient.
SUN_FN real fresnel_dielectric(real cosine, real eta, real cosine_far) {
  real near = eta * cosine, far = eta * cosine_far;
  real p = near + cosine_far, s = cosine + far;
  real parallel = (near - cosine_far) * s, perpendicular = (cosine - far) * p, both = p * s;
  mask passes = cosine_far > 0.0f;
  real mean = 0.5f * (parallel * parallel + perpendicular * perpendicular) / (passes ? both * both : (real)(1.0f));
  return passes ? mean : (real)(1.0f);
}

// wo refracted at a facet with normal h.
SUN_FN vec3 refract_about(vec3 wo, vec3 h, real inverse_eta, real cosine_o, real cosine_far) {
  return add3(scale3(wo, -inverse_eta), scale3(h, cosine_o * inverse_eta - cosine_far));
}

// The facet normal, on the side of wo, that refracts wo into wi. Not defined for eta = 1.
SUN_FN vec3 refraction_normal(vec3 wo, vec3 wi, real eta) {
  vec3 h = normalize3(add3(wo, scale3(wi, eta)));
  return select3(h.z < 0.0f, negate3(h), h);
}

// Mean reflectance under diffuse light, as a fit from the thin side [Kulla17]. From the dense side, etendue gives 1 - (1 - mean) / n^2 exactly.
SUN_FN real mean_transmittance(real eta) {
  real dense = max_real(eta, 1.0f / eta);
  real thin_side = 1.0f - (dense - 1.0f) / (4.08567f + 1.00071f * dense);
  return eta < 1.0f ? thin_side * eta * eta : thin_side;
}

// The albedo tables of glass, for reflection and refraction together. Side 0: the far side is the denser one, side 1: the thinner. The axis of eta
// runs over r = (n - 1) / (n + 1), the amplitude reflected at normal incidence: in [0, 1] for every n = max(eta, 1 / eta). Nodes: (k / (N - 1))^2.
SUN_FN real glass_axis(real eta) { return table_axis(fabs(eta - 1.0f) / (eta + 1.0f)); }
SUN_FN real glass_albedo(const SUN_GLOBAL float *tables, uint_n side, real eta_axis, real alpha_axis, real cosine) {
  TableCell e = table_cell(eta_axis, (float)SUN_GLASS_N), j = table_cell(alpha_axis, (float)SUN_GLASS_N);
  TableCell i = table_cell(table_axis(cosine), (float)SUN_GLASS_N);
  uint_n at = ((side * (uint)SUN_GLASS_N + e.node) * (uint)SUN_GLASS_N + j.node) * (uint)SUN_GLASS_N + i.node;
  const SUN_GLOBAL float *table = tables + SUN_TABLE_GLASS;
  return lerp_real(table_bilinear(table, at, SUN_GLASS_N, i.towards, j.towards),
                   table_bilinear(table + SUN_GLASS_N * SUN_GLASS_N, at, SUN_GLASS_N, i.towards, j.towards), e.towards);
}
SUN_FN real glass_mean(const SUN_GLOBAL float *tables, uint_n side, real eta_axis, real alpha_axis) {
  TableCell e = table_cell(eta_axis, (float)SUN_GLASS_N), j = table_cell(alpha_axis, (float)SUN_GLASS_N);
  uint_n at = (side * (uint)SUN_GLASS_N + e.node) * (uint)SUN_GLASS_N + j.node;
  return table_bilinear(tables + SUN_TABLE_GLASS_MEAN, at, SUN_GLASS_N, j.towards, e.towards);
}

SUN_NAMESPACE_END
#endif
