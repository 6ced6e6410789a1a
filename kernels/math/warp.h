// SPDX-License-Identifier: Apache-2.0
// From the unit square to where points are wanted, each beside its density: per solid angle (of directions, unit length) or per area (disk,
// triangle).
// Up is +z. All keep strata together; those over disk and hemisphere are concentric [Shirley97].
#ifndef SUN_MATH_WARP_H
#define SUN_MATH_WARP_H
#include "math/elementary.h"
#include "math/vector.h"

SUN_NAMESPACE_BEGIN

#define SUN_INV_FOUR_PI 0.0795774683f

// The unit circle's point of the concentric map; *radius is signed, |radius| <= 1, so the disk's point is the product.
SUN_FN vec2 concentric(vec2 u, real *radius) {
  real a = 2.0f * u.x - 1.0f;
  real b = 2.0f * u.y - 1.0f;
  mask wide = fabs(a) > fabs(b);
  real large = wide ? a : b;
  real small = wide ? b : a;
  real angle = SUN_QUARTER_PI * (small / (large == 0.0f ? (real)(1.0f) : large));
  real sine, cosine;
  sin_cos(angle, &sine, &cosine);
  *radius = large;
  return make_vec2(wide ? cosine : sine, wide ? sine : cosine);
}

// Uniform in the unit disk.
SUN_FN vec2 square_to_disk(vec2 u) {
  real radius;
  vec2 p = concentric(u, &radius);
  return make_vec2(p.x * radius, p.y * radius);
}
SUN_FN real square_to_disk_pdf(vec2 p) { return p.x * p.x + p.y * p.y <= 1.0f ? (real)(SUN_INV_PI) : (real)(0.0f); }

// Directions by the cosine to +z; [Malley88]: the disk, projected upwards.
SUN_FN vec3 square_to_cosine_hemisphere(vec2 u) {
  real radius;
  vec2 p = concentric(u, &radius);
  return make_vec3(p.x * radius, p.y * radius, sqrt((1.0f - radius) * (1.0f + radius)));
}
SUN_FN real square_to_cosine_hemisphere_pdf(vec3 v) { return v.z > 0.0f ? v.z * SUN_INV_PI : (real)(0.0f); }

SUN_FN vec3 square_to_uniform_hemisphere(vec2 u) {
  real radius;
  vec2 p = concentric(u, &radius);
  real z = (1.0f - radius) * (1.0f + radius);
  real scale = radius * sqrt(1.0f + z);  // sin = sqrt((1 - z) (1 + z)), 1 - z = radius^2
  return make_vec3(p.x * scale, p.y * scale, z);
}
SUN_FN real square_to_uniform_hemisphere_pdf(vec3 v) { return v.z >= 0.0f ? (real)(SUN_INV_TWO_PI) : (real)(0.0f); }

SUN_FN vec3 square_to_uniform_sphere(vec2 u) {
  real z = 1.0f - 2.0f * u.x;
  real r = 2.0f * sqrt(u.x * (1.0f - u.x));
  real sine, cosine;
  sin_cos(SUN_TWO_PI * u.y, &sine, &cosine);
  return make_vec3(r * cosine, r * sine, z);
}
SUN_FN real square_to_uniform_sphere_pdf(void) { return (real)(SUN_INV_FOUR_PI); }

// Uniform in the cap about +z of height one_minus_cos = 1 - cos(half angle), which keeps its digits for narrow cones.
SUN_FN vec3 square_to_cone(vec2 u, real one_minus_cos) {
  real height = u.x * one_minus_cos;
  real r = sqrt_or_zero(height * (2.0f - height));
  real sine, cosine;
  sin_cos(SUN_TWO_PI * u.y, &sine, &cosine);
  return make_vec3(r * cosine, r * sine, 1.0f - height);
}
// 0 for a cone of no width, which only a delta can fill.
SUN_FN real square_to_cone_pdf(real one_minus_cos) {
  mask open = one_minus_cos > 0.0f;
  return open ? SUN_INV_TWO_PI / (open ? one_minus_cos : (real)(1.0f)) : (real)(0.0f);
}

// Barycentric coordinates (u, v) of a Hit, uniform over the triangle: point = (1 - x - y) corner 0 + x corner 1 + y corner 2.
// Less distortion than a square root, and exact [Heitz19].
SUN_FN vec2 square_to_triangle(vec2 u) {
  mask upper = u.y > u.x;
  real small = 0.5f * (upper ? u.x : u.y);
  real rest = (upper ? u.y : u.x) - small;
  return make_vec2(upper ? small : rest, upper ? rest : small);
}
// Per area, for a triangle of this area.
SUN_FN real square_to_triangle_pdf(real area) {
  mask some = area > 0.0f;
  return some ? 1.0f / (some ? area : (real)(1.0f)) : (real)(0.0f);
}

SUN_NAMESPACE_END
#endif
