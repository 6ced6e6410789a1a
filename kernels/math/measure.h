// SPDX-License-Identifier: Apache-2.0
// Densities from one measure to another, and the heuristics that weigh one strategy against another [Veach97].
#ifndef SUN_MATH_MEASURE_H
#define SUN_MATH_MEASURE_H
#include "math/real.h"

SUN_NAMESPACE_BEGIN

// Cosines of unit vectors, which rounding may leave a little outside.
SUN_FN real clamp_cosine(real cosine) { return clamp_real(cosine, (real)(-1.0f), (real)(1.0f)); }
SUN_FN real positive_cosine(real cosine) { return clamp_real(cosine, (real)(0.0f), (real)(1.0f)); }
SUN_FN real abs_cosine(real cosine) { return min_real(fabs(cosine), (real)(1.0f)); }

// Per area at a point that is seen under `cosine` to its normal (either sign) from the square root of distance_squared away -> per solid angle there.
// 0 at grazing incidence, where nothing can be seen.
SUN_FN real pdf_area_to_solid_angle(real pdf_area, real distance_squared, real cosine) {
  real facing = fabs(cosine);
  mask seen = facing > 0.0f;
  return seen ? pdf_area * distance_squared / (seen ? facing : (real)(1.0f)) : (real)(0.0f);
}
SUN_FN real pdf_solid_angle_to_area(real pdf_solid_angle, real distance_squared, real cosine) {
  mask apart = distance_squared > 0.0f;
  return apart ? pdf_solid_angle * fabs(cosine) / (apart ? distance_squared : (real)(1.0f)) : (real)(0.0f);
}

// The smaller density over the larger, so that no square of a huge or tiny density is ever taken; 1 where they are equal, infinity included.
SUN_FN real density_ratio(real a, real b) {
  mask equal = a == b;
  real large = a > b ? a : b;
  real small = a > b ? b : a;
  return equal ? (real)(1.0f) : small / (equal ? (real)(1.0f) : large);
}

// Weight of a sample that its own strategy drew with density pdf and another might have drawn with pdf_other: a / (a + b). 0 where pdf is 0.
SUN_FN real balance_heuristic(real pdf, real pdf_other) {
  real ratio = density_ratio(pdf, pdf_other);
  real weight = (pdf >= pdf_other ? (real)(1.0f) : ratio) / (1.0f + ratio);
  return pdf > 0.0f ? weight : (real)(0.0f);
}

// a^2 / (a^2 + b^2). 0 where pdf is 0.
SUN_FN real power_heuristic(real pdf, real pdf_other) {
  real ratio = density_ratio(pdf, pdf_other);
  ratio = ratio * ratio;
  real weight = (pdf >= pdf_other ? (real)(1.0f) : ratio) / (1.0f + ratio);
  return pdf > 0.0f ? weight : (real)(0.0f);
}

SUN_NAMESPACE_END
#endif
