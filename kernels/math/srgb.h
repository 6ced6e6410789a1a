// SPDX-License-Identifier: Apache-2.0
// Linear light -> bytes of a display, by the curve of sRGB [IEC61966].
#ifndef SUN_MATH_SRGB_H
#define SUN_MATH_SRGB_H
#include "math/real.h"

SUN_NAMESPACE_BEGIN

// Clamped to 0 and 1, NaN to 0. The power of 1/2.4 as a polynomial of the root, within 0.1 of a byte's step (a minimax fit).
SUN_FN uint_n srgb_byte(real linear) {
  real x = linear > 0.0f ? linear : (real)(0.0f);
  x = x < 1.0f ? x : (real)(1.0f);
  real root = sqrt(x);
  real curve = fma((real)(0.517304678f), root, (real)(-1.62366159f));
  curve = fma(curve, root, (real)(2.03157541f));
  curve = fma(curve, root, (real)(-1.40273554f));
  curve = fma(curve, root, (real)(1.51795042f));
  curve = fma(curve, root, (real)(-0.0401095765f));
  real encoded = x > 0.0031308f ? curve : 12.92f * x;
  return uint_of_int(int_of_real(255.0f * encoded + 0.5f));
}

SUN_NAMESPACE_END
#endif
