// SPDX-License-Identifier: Apache-2.0
// Our own elementary functions, made of + - * / fma sqrt floor alone, so that every device and the host give the same bits.
// Polynomials are minimax fits of ours for a weight that makes the error relative, their coefficients rounded to float one after the other from
// the lowest, the rest fitted anew each time. Reductions are after [Cody80]; where x - k * c has to be exact, the leading part of c is short or
// fma keeps it.
// The errors stated are the largest seen against long double by tests/kernels/math/elementary_test.cpp, in units in the last place of the result
// (of 2^-149 where that is subnormal). Subnormal arguments and results are right where the device has subnormals, as the self-test asks.
// A NaN that goes in comes out; nothing else gives NaN or infinity.
#ifndef SUN_MATH_ELEMENTARY_H
#define SUN_MATH_ELEMENTARY_H
#include "math/real.h"

SUN_NAMESPACE_BEGIN

#define SUN_PI 3.14159274f
#define SUN_TWO_PI 6.28318548f
#define SUN_HALF_PI 1.57079637f
#define SUN_QUARTER_PI 0.785398185f
#define SUN_INV_PI 0.318309873f
#define SUN_INV_TWO_PI 0.159154937f
#define SUN_FLOAT_MAX 3.40282347e38f

SUN_FN real horner(real p, real z, float c) { return fma(p, z, (real)(c)); }

// Sine and cosine together. |x| <= 1e4: at most 1.6 ULP each; up to 1e6 the absolute error stays below 1e-7; beyond that, as for x = 0.
SUN_FN void sin_cos(real x, real *sine, real *cosine) {
  x = fabs(x) > 1.0e6f ? (real)(0.0f) : x;
  real k = floor(fma(x, (real)(0.636619747f), (real)(0.5f)));
  // Quarter turns: pi/2 in three parts. The first difference is exact: a multiple of 2^-24 below 1.
  real r = fma(k, (real)(-1.57079637f), x);
  r = fma(k, (real)(4.37113883e-8f), r);
  r = fma(k, (real)(1.71512451e-15f), r);
  int_n quarter = int_of_real(x == x ? k : (real)(0.0f));
  real z = r * r;
  real p = horner((real)(2.80372501e-6f), z, -0.000198506401f);
  p = horner(p, z, 0.00833337475f);
  p = horner(p, z, -0.166666672f);
  real s = fma(r, z * p, r);
  real q = horner((real)(-2.84932099e-7f), z, 2.48183824e-5f);
  q = horner(q, z, -0.00138889719f);
  q = horner(q, z, 0.0416666679f);
  real c = fma(q, z * z, fma((real)(-0.5f), z, (real)(1.0f)));
  mask odd = (quarter & 1) != 0;
  mask sine_negative = (quarter & 2) != 0;
  mask cosine_negative = ((quarter + 1) & 2) != 0;
  real sine_size = odd ? c : s;
  real cosine_size = odd ? s : c;
  *sine = sine_negative ? -sine_size : sine_size;
  *cosine = cosine_negative ? -cosine_size : cosine_size;
}

// exp(r) * 2^k for |r| <= ln2 / 2 and -152 <= k <= 128; the power of two in two factors, so that only the second product may round.
SUN_FN real exp_reduced(real r, int_n k) {
  real p = horner((real)(0.000199496659f), r, 0.00139354821f);
  p = horner(p, r, 0.00833320152f);
  p = horner(p, r, 0.0416664593f);
  p = horner(p, r, 0.166666672f);
  p = horner(p, r, 0.5f);
  p = fma(p, r * r, r) + 1.0f;
  int_n lower_half = k >> 1;
  real first = real_of_bits(uint_of_int(lower_half + 127) << 23);
  real second = real_of_bits(uint_of_int(k - lower_half + 127) << 23);
  return p * first * second;
}

// At most 1.0 ULP. Above log(SUN_FLOAT_MAX): SUN_FLOAT_MAX; far below: 0.
SUN_FN real exp_real(real x) {
  real y = x > 89.0f ? (real)(89.0f) : x;
  y = y < -105.0f ? (real)(-105.0f) : y;
  y = y == y ? y : (real)(0.0f);
  real k = floor(fma(y, (real)(1.44269502f), (real)(0.5f)));
  real r = fma(k, (real)(-0.693359375f), y);
  r = fma(k, (real)(0.000212194442f), r);
  real result = exp_reduced(r, int_of_real(k));
  result = x > 88.7228317f ? (real)(SUN_FLOAT_MAX) : result;
  return x == x ? result : x;
}

// x = (1 + f) * 2^e for positive finite x, f in [sqrt(1/2) - 1, sqrt(2) - 1) and exact.
SUN_FN real split_power_of_two(real x, real *e) {
  mask subnormal = x < 1.17549435e-38f;
  real scaled = subnormal ? x * 8388608.0f : x;
  uint_n above = bits_of_real(scaled) - 0x3f3504f3u;  // the bits of sqrt(1/2)
  *e = real_of_int(int_of_uint(above) >> 23) - (subnormal ? (real)(23.0f) : (real)(0.0f));
  return real_of_bits((above & 0x007fffffu) + 0x3f3504f3u) - 1.0f;
}

// Natural logarithm, at most 0.8 ULP. 0 and negative numbers: -SUN_FLOAT_MAX; infinity: as for 2^128.
SUN_FN real log_real(real x) {
  real e;
  real f = split_power_of_two(x > 0.0f ? x : (real)(1.0f), &e);
  real z = f * f;
  real p = horner((real)(0.0674917251f), f, -0.116700187f);
  p = horner(p, f, 0.118835397f);
  p = horner(p, f, -0.124062404f);
  p = horner(p, f, 0.142203599f);
  p = horner(p, f, -0.166679889f);
  p = horner(p, f, 0.200020716f);
  p = horner(p, f, -0.250000089f);
  p = horner(p, f, 0.333333135f);
  real y = p * f * z;
  y = fma(e, (real)(-0.000212194442f), y);
  y = fma((real)(-0.5f), z, y);
  real result = fma(e, (real)(0.693359375f), f + y);
  result = x <= 0.0f ? (real)(-SUN_FLOAT_MAX) : result;
  return x == x ? result : x;
}

// The logarithm of positive finite x as high + low, right to about 2^-40: what pow needs, where an exponent makes the error large.
SUN_FN real log_in_two(real x, real *low) {
  real e;
  real f = split_power_of_two(x, &e);
  // log(1 + f) = 2 atanh(s), s = f / (2 + f), carried with its remainder.
  real d = 2.0f + f;
  real d_low = f - (d - 2.0f);
  real s = f / d;
  real s_low = (fma(-s, d, f) - s * d_low) / d;
  real z = s * s;
  real z_low = fma(s, s, -z) + 2.0f * s * s_low;
  // 2 atanh(s) = 2 s + s z (2/3 + z Q(z))
  real q = horner((real)(0.195564225f), z, 0.221797287f);
  q = horner(q, z, 0.285719723f);
  q = horner(q, z, 0.399999976f) * z;
  real w = 0.666666687f + q;
  real w_low = (q - (w - 0.666666687f)) - 1.98682155e-8f;
  real sz = s * z;
  real sz_low = fma(s, z, -sz) + (s * z_low + s_low * z);
  real t = sz * w;
  real t_low = fma(sz, w, -t) + (sz * w_low + sz_low * w);
  real two_s = 2.0f * s;
  real h = two_s + t;
  real h_low = (t - (h - two_s)) + (t_low + 2.0f * s_low);
  real whole = e * 0.693359375f;  // exact: nine bits times eight
  real sum = whole + h;
  real rest = (h - (sum - whole)) + fma(e, (real)(-0.000212194442f), h_low);
  real high = sum + rest;
  *low = rest - (high - sum);
  return high;
}

// base^exponent for base >= 0 (negative bases count as 0), at most 1.0 ULP. 0^0 = 1; 0 to a negative exponent and all that is too large:
// SUN_FLOAT_MAX. Infinite arguments count as the largest finite number.
SUN_FN real pow_real(real base, real exponent) {
  mask zero = base <= 0.0f;
  real b = base > 0.0f ? base : (real)(1.0f);
  b = b > SUN_FLOAT_MAX ? (real)(SUN_FLOAT_MAX) : b;
  real y = exponent > SUN_FLOAT_MAX ? (real)(SUN_FLOAT_MAX) : exponent;
  y = y < -SUN_FLOAT_MAX ? (real)(-SUN_FLOAT_MAX) : y;
  y = y == y ? y : (real)(0.0f);
  real low;
  real high = log_in_two(b, &low);
  real p = y * high;
  real p_low = fma(y, high, -p) + y * low;
  mask over = p > 89.0f;
  mask under = p < -105.0f;
  p = over ? (real)(89.0f) : under ? (real)(-105.0f) : p;
  p_low = over | under ? (real)(0.0f) : p_low;
  real k = floor(fma(p, (real)(1.44269502f), (real)(0.5f)));
  real r = fma(k, (real)(-0.693359375f), p);
  r = r + fma(k, (real)(0.000212194442f), p_low);
  real result = exp_reduced(r, int_of_real(k));
  result = result > SUN_FLOAT_MAX ? (real)(SUN_FLOAT_MAX) : result;
  real at_zero = y > 0.0f ? (real)(0.0f) : y < 0.0f ? (real)(SUN_FLOAT_MAX) : (real)(1.0f);
  result = zero ? at_zero : result;
  result = base == base ? result : base;
  return exponent == exponent ? result : exponent;
}

// asin(s) - s for 0 <= s <= 1/2, z = s * s.
SUN_FN real asin_excess(real s, real z) {
  real p = horner((real)(0.0376964621f), z, 0.0143149635f);
  p = horner(p, z, 0.0318390839f);
  p = horner(p, z, 0.0445133746f);
  p = horner(p, z, 0.0750052184f);
  p = horner(p, z, 0.166666597f);
  return s * (z * p);
}

// The argument is clamped to [-1, 1]; at most 1.5 ULP.
SUN_FN real asin_real(real x) {
  real a = fabs(x);
  a = a > 1.0f ? (real)(1.0f) : a;
  mask outer = a > 0.5f;
  // asin(a) = pi/2 - 2 asin(sqrt((1 - a) / 2)); 1 - a is exact there.
  real z = outer ? (1.0f - a) * 0.5f : a * a;
  real s = outer ? sqrt(z) : a;
  real excess = asin_excess(s, z);
  // What the root lost, since the difference from pi/2 may be smaller than 2 s.
  real s_low = outer ? fma(-s, s, z) / (s > 0.0f ? 2.0f * s : (real)(1.0f)) : (real)(0.0f);
  real twice_low = fma((real)(2.0f), s_low, (real)(4.37113883e-8f));
  real result = outer ? (1.57079637f - 2.0f * s) - fma((real)(2.0f), excess, twice_low) : s + excess;
  return copysign(result, x);
}

// The argument is clamped to [-1, 1]; at most 1.5 ULP.
SUN_FN real acos_real(real x) {
  real a = fabs(x);
  a = a > 1.0f ? (real)(1.0f) : a;
  mask outer = a > 0.5f;
  real z = outer ? (1.0f - a) * 0.5f : a * a;
  real s = outer ? sqrt(z) : a;
  real r = s + asin_excess(s, z);
  real twice = 2.0f * r;
  mask negative = x < 0.0f;
  real far_side = negative ? 3.14159274f - (twice + 8.74227766e-8f) : twice;
  real near_side = 1.57079637f - ((negative ? -r : r) + 4.37113883e-8f);
  return outer ? far_side : near_side;
}

// The angle of (x, y) from +x, in [-pi, pi], at most 1.5 ULP. Finite arguments; (0, 0) and (-0, 0) give 0, with y's sign.
SUN_FN real atan2_real(real y, real x) {
  real ax = fabs(x), ay = fabs(y);
  mask steep = ay > ax;
  real large = steep ? ay : ax;
  real small = steep ? ax : ay;
  real t = small / (large == 0.0f ? (real)(1.0f) : large);
  real z = t * t;
  real p = horner((real)(0.00113452214f), z, -0.00742536318f);
  p = horner(p, z, 0.022777617f);
  p = horner(p, z, -0.0449832566f);
  p = horner(p, z, 0.0676364899f);
  p = horner(p, z, -0.0882146209f);
  p = horner(p, z, 0.110612333f);
  p = horner(p, z, -0.142803431f);
  p = horner(p, z, 0.199997157f);
  p = horner(p, z, -0.333333284f);
  real r = fma(t, z * p, t);
  // r, pi/2 - r, pi/2 + r, pi - r, each with one rounding that counts.
  mask behind = x < 0.0f;
  real quarter = 1.57079637f + ((behind ? r : -r) - 4.37113883e-8f);
  real turned = 3.14159274f - (r + 8.74227766e-8f);
  return copysign(steep ? quarter : behind ? turned : r, y);
}

SUN_NAMESPACE_END
#endif
