// SPDX-License-Identifier: Apache-2.0
// Linear light -> bytes of a display, by the curve of sRGB [IEC61966].
#ifndef SUN_MATH_SRGB_H
#define SUN_MATH_SRGB_H
#include "math/real.h"

SUN_NAMESPACE_BEGIN

// Clamped to 0 and 1, NaN to 0. The power of 1/2.4 as a polynomial of the root, within 0.1 of a byte's step (a minimax fit); in steps, and half of one for rounding.
SUN_FN uint_n srgb_byte(real linear) {
  real x = linear > 0.0f ? linear : (real)(0.0f);
  x = x < 1.0f ? x : (real)(1.0f);
  real root = sqrt(x);
  real curve = fma((real)(131.912693f), root, (real)(-414.033705f));
  curve = fma(curve, root, (real)(518.05173f));
  curve = fma(curve, root, (real)(-357.697563f));
  curve = fma(curve, root, (real)(387.077357f));
  curve = fma(curve, root, (real)(-9.72794201f));
  return uint_of_int(int_of_real(x > 0.0031308f ? curve : fma((real)(3294.6f), x, (real)(0.5f))));
}

SUN_NAMESPACE_END
#endif
