// SPDX-License-Identifier: Apache-2.0
// A film contribution in whole quanta (shared/film.h). Scalar code, exact but for the one rounding.
#ifndef SUN_MATH_QUANTUM_H
#define SUN_MATH_QUANTUM_H
#include "math/real.h"
#include "shared/film.h"

SUN_NAMESPACE_BEGIN

#ifdef __cplusplus
static_assert(sizeof(long) == 8);
#endif

#define SUN_FILM_GOOD 0u
#define SUN_FILM_CLAMPED 1u
#define SUN_FILM_BAD 2u  // NaN or infinite

// x in quanta of the bin that |x| names, rounded up or down: up where the fraction is above `dither`, a multiple of 2^-24 in [0, 1).
// Scaling and floor are exact, so over all dithers the mean is x; where the fraction needs more than 24 bits (|x| < 2^-36), to 2^-24 of a quantum.
SUN_FN long film_round(float x, float dither, uint *bin, uint *verdict) {
  uint bits = as_uint(x);
  uint size_bits = bits & 0x7fffffffu;
  *bin = 0u;
  *verdict = SUN_FILM_GOOD;
  if (size_bits >= 0x7f800000u) {
    *verdict = SUN_FILM_BAD;
    return 0;
  }
  float size = as_float(size_bits);
  if (size > SUN_FILM_LIMIT) {
    *verdict = SUN_FILM_CLAMPED;
    size = SUN_FILM_LIMIT;
  }
  float quanta;
  if (size < 1.0f) {
    quanta = size * 68719476736.0f;  // 2^SUN_FILM_FINE_BITS
  } else {
    quanta = size * 4096.0f;  // 2^SUN_FILM_COARSE_BITS
    *bin = 1u;
  }
  float whole = floor(quanta);
  long rounded = (long)whole + (quanta - whole > dither ? 1 : 0);
  return bits >> 31 ? -rounded : rounded;
}

SUN_NAMESPACE_END
#endif
