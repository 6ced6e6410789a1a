// SPDX-License-Identifier: Apache-2.0
// One source for every width. Only this file and record.h know what LANES means.
//   real    LANES floats           mask    what comparing them gives: vector true is -1, scalar true is 1; test it with ?: , ANY, &, |, ! only
//   int_n   LANES ints             uint_n  LANES uints
// m ? a : b, comparisons and arithmetic read the same for every width; both arms of ?: need the same type, so literals are written (real)(0.5f).
// Only + - * / fma sqrt floor fabs copysign are used on reals, each correctly rounded: see docs/kernels.md.
#ifndef SUN_MATH_REAL_H
#define SUN_MATH_REAL_H
#include "shared/options.h"
#include "shared/types.h"

#ifdef __cplusplus
#include <bit>
#if LANES != 1
#error "kernels compiled as C++ have LANES 1"
#endif
#endif

// Not any(): PoCL makes a chain of branches of it. Where clang can tell, one instruction; where the CPU has masks, their own.
#define SUN_ANY(m) any(m)
#define SUN_ALL(m) all(m)
#if !defined(__cplusplus) && defined(__has_builtin)
#if LANES == 16 && defined(__AVX512DQ__) && __has_builtin(__builtin_ia32_cvtd2mask512)
#undef SUN_ANY
#undef SUN_ALL
#define SUN_MASK_BITS(m) ((uint)(ushort)__builtin_ia32_cvtd2mask512(m))
#define SUN_ANY(m) (SUN_MASK_BITS(m) != 0u)
#define SUN_ALL(m) (SUN_MASK_BITS(m) == 0xffffu)
#elif __has_builtin(__builtin_reduce_or)
#undef SUN_ANY
#undef SUN_ALL
#define SUN_ANY(m) (__builtin_reduce_or((m) < 0) != 0)
#define SUN_ALL(m) (__builtin_reduce_and((m) < 0) != 0)
#endif
#endif

SUN_NAMESPACE_BEGIN

#if LANES == 1
typedef float real;
typedef int int_n;
typedef uint uint_n;
typedef int mask;
#define ANY(m) ((m) != 0)
#define ALL(m) ((m) != 0)
#define LANES_STORE(v, array) ((array)[0] = (v))
#define LANES_LOAD(array) ((array)[0])
#define LANE_NUMBERS 0
#define FIRST_LANE(v) (v)
#elif LANES == 8
typedef float8 real;
typedef int8 int_n;
typedef uint8 uint_n;
typedef int8 mask;
#define ANY(m) SUN_ANY(m)
#define ALL(m) SUN_ALL(m)
#define FIRST_LANE(v) ((v).s0)
#define LANES_STORE(v, array) vstore8((v), 0, (array))
#define LANES_LOAD(array) vload8(0, (array))
#define LANE_NUMBERS (int8)(0, 1, 2, 3, 4, 5, 6, 7)
#elif LANES == 16
typedef float16 real;
typedef int16 int_n;
typedef uint16 uint_n;
typedef int16 mask;
#define ANY(m) SUN_ANY(m)
#define ALL(m) SUN_ALL(m)
#define FIRST_LANE(v) ((v).s0)
#define LANES_STORE(v, array) vstore16((v), 0, (array))
#define LANES_LOAD(array) vload16(0, (array))
#define LANE_NUMBERS (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
#else
#error "LANES is 1, 8 or 16"
#endif

#ifdef __cplusplus
SUN_FN real fma(real a, real b, real c) { return __builtin_fmaf(a, b, c); }
SUN_FN real sqrt(real x) { return __builtin_sqrtf(x); }
SUN_FN real floor(real x) { return __builtin_floorf(x); }
SUN_FN real fabs(real x) { return __builtin_fabsf(x); }
SUN_FN real copysign(real magnitude, real sign) { return __builtin_copysignf(magnitude, sign); }
SUN_FN uint as_uint(float x) { return std::bit_cast<uint>(x); }
SUN_FN float as_float(uint x) { return std::bit_cast<float>(x); }
#define bits_of_real(x) as_uint(x)
#define real_of_bits(x) as_float(x)
#define real_of_int(x) ((real)(x))
#define real_of_uint(x) ((real)(x))
#define int_of_real(x) ((int_n)(x))
#define uint_of_int(x) ((uint_n)(x))
#define int_of_uint(x) ((int_n)(x))
#elif LANES == 1
#define bits_of_real(x) as_uint(x)
#define real_of_bits(x) as_float(x)
#define real_of_int(x) ((real)(x))
#define real_of_uint(x) ((real)(x))
#define int_of_real(x) ((int_n)(x))   // towards zero; in range only
#define uint_of_int(x) ((uint_n)(x))
#define int_of_uint(x) ((int_n)(x))
#elif LANES == 8
#define bits_of_real(x) as_uint8(x)
#define real_of_bits(x) as_float8(x)
#define real_of_int(x) convert_float8(x)
#define real_of_uint(x) convert_float8(x)
#define int_of_real(x) convert_int8(x)
#define uint_of_int(x) as_uint8(x)
#define int_of_uint(x) as_int8(x)
#else
#define bits_of_real(x) as_uint16(x)
#define real_of_bits(x) as_float16(x)
#define real_of_int(x) convert_float16(x)
#define real_of_uint(x) convert_float16(x)
#define int_of_real(x) convert_int16(x)
#define uint_of_int(x) as_uint16(x)
#define int_of_uint(x) as_int16(x)
#endif

// Not fmin and fmax: their rules for NaN cost a fifth of a traversal. NaN in either place gives b.
SUN_FN real min_real(real a, real b) { return a < b ? a : b; }
SUN_FN real max_real(real a, real b) { return a > b ? a : b; }
SUN_FN real clamp_real(real x, real lower, real upper) { return min_real(max_real(x, lower), upper); }
SUN_FN real sqrt_or_zero(real x) { return sqrt(max_real(x, (real)(0.0f))); }
SUN_FN real lerp_real(real a, real b, real t) { return a + (b - a) * t; }

// Table look-ups, a lane at a time. Every index has to be in range, in lanes that are switched off too.
// Where there are lanes the loads are volatile: compilers make hardware gathers of them otherwise, which take several times as long (38 cycles for
// eight words on Zen 4).
#if LANES == 1
#define LANE_WORD(type, place) (place)
#else
#define LANE_WORD(type, place) (*(const volatile SUN_GLOBAL type *)&(place))
#endif
SUN_FN real gather_real(const SUN_GLOBAL float *table, uint_n index) {
  uint at[LANES];
  float value[LANES];
  LANES_STORE(index, at);
  for (int lane = 0; lane < LANES; lane++) value[lane] = LANE_WORD(float, table[at[lane]]);
  return LANES_LOAD(value);
}
SUN_FN uint_n gather_uint(const SUN_GLOBAL uint *table, uint_n index) {
  uint at[LANES], value[LANES];
  LANES_STORE(index, at);
  for (int lane = 0; lane < LANES; lane++) value[lane] = LANE_WORD(uint, table[at[lane]]);
  return LANES_LOAD(value);
}

// The least of the lanes.
#if LANES == 1
SUN_FN uint least_lane(uint_n v) { return v; }
#else
SUN_FN uint least_lane(uint_n v) {
#if LANES == 16
  const uint8 halves = min(v.lo, v.hi);
#else
  const uint8 halves = v;
#endif
  const uint4 quarters = min(halves.lo, halves.hi);
  const uint2 two = min(quarters.lo, quarters.hi);
  return min(two.x, two.y);
}
#endif

// Any one of the lanes that are on, of which there is one; which, only speed may depend on.
#if LANES == 16 && defined(SUN_MASK_BITS)
SUN_FN uint some_lane(mask on, uint_n v) {
  uint at[LANES];
  LANES_STORE(v, at);
  return at[31u - clz(SUN_MASK_BITS(on))];
}
#else
SUN_FN uint some_lane(mask on, uint_n v) { return least_lane(on ? v : (uint_n)(0xffffffffu)); }
#endif

SUN_NAMESPACE_END
#endif
