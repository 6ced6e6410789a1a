// SPDX-License-Identifier: Apache-2.0
// The GGX microsurface [Walter07] with Smith's height-correlated masking [Heitz14], its visible normals, and Schlick's Fresnel term [Schlick94].
// Everything is in the shading frame; cosines are positive, alpha is at least SUN_ALPHA_SMOOTH.
#ifndef SUN_BSDF_MICROFACET_H
#define SUN_BSDF_MICROFACET_H
#include "math/elementary.h"
#include "math/vector.h"

SUN_NAMESPACE_BEGIN

// Below this a surface counts as perfectly smooth: its microfacet lobes are delta functions.
#define SUN_ALPHA_SMOOTH 1e-3f
// Cosines to the normal are held above this, so that no quotient below overflows.
#define SUN_MIN_COSINE 1e-6f

// F = F0 + (F90 - F0) * w with w = (1 - cos)^5: linear in (F0, F90), so that mixed materials are one lobe and tables need no Fresnel axis.
SUN_FN real schlick_weight(real cosine) {
  real m = clamp_real(1.0f - cosine, (real)(0.0f), (real)(1.0f));
  real squared = m * m;
  return squared * squared * m;
}
#define SUN_SCHLICK_MEAN (1.0f / 21.0f)  // cosine-weighted mean of (1 - cos)^5

// Density of microfacet normals per unit of projected area, by solid angle. x and y, not 1 - z^2: the peak of a smooth lobe needs their digits.
SUN_FN real ggx_density(vec3 h, real alpha) {
  real squared = alpha * alpha;
  real t = (h.x * h.x + h.y * h.y) / squared + h.z * h.z;
  return 1.0f / (SUN_PI * squared * t * t);
}

// cos * sqrt(1 + alpha^2 tan^2): Smith's Lambda is (this / cos - 1) / 2.
SUN_FN real smith_root(real cosine, real alpha) {
  real squared = alpha * alpha;
  return sqrt(squared + (1.0f - squared) * (cosine * cosine));
}

// G1(o) / (4 cos o): times ggx_density, the density of the direction that a visible normal mirrors o into [Heitz14].
SUN_FN real smith_masking(real cosine_o, real root_o) { return 0.5f / (cosine_o + root_o); }

// G2(o, i) / (4 cos o cos i), height-correlated [Heitz14 eq. 99].
SUN_FN real smith_visibility(real cosine_o, real root_o, real cosine_i, real root_i) { return 0.5f / (cosine_i * root_o + cosine_o * root_i); }

// A normal with density G1(o) ggx_density(h) max(0, o.h) / cos o, as a spherical cap [Dupuy23]: of the same law as [Heitz18].
SUN_FN vec3 sample_visible_normal(vec3 wo, real alpha, real u0, real u1) {
  vec3 o = normalize3(make_vec3(wo.x * alpha, wo.y * alpha, wo.z));
  real sine, cosine;
  sin_cos(SUN_TWO_PI * u0, &sine, &cosine);
  real z = (1.0f - u1) * (1.0f + o.z) - o.z;
  real radius = sqrt_or_zero((1.0f - z) * (1.0f + z));
  return normalize3(make_vec3((radius * cosine + o.x) * alpha, (radius * sine + o.y) * alpha, max_real(z + o.z, (real)(0.0f))));
}

SUN_FN vec3 mirror_about(vec3 wo, vec3 h) { return sub3(scale3(h, 2.0f * dot3(wo, h)), wo); }

SUN_NAMESPACE_END
#endif
