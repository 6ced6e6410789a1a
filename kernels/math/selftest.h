// SPDX-License-Identifier: Apache-2.0
// The operations that must give the same bits on a device as on the host: sections of them, each a pure function of the inputs that a number
// stands for.
// stages/selftest.cl runs them on the device, host/device/selftest.cpp compiles them as C++. A section's sum over all inputs is a sum of hashes, so
// neither the order nor LANES shows in it.
#ifndef SUN_MATH_SELFTEST_H
#define SUN_MATH_SELFTEST_H
#include "math/elementary.h"
#include "math/measure.h"
#include "math/quantum.h"
#include "math/sampler.h"
#include "math/warp.h"

SUN_NAMESPACE_BEGIN

#define SUN_SELFTEST_INPUTS 8192  // of each section

// Inputs. Any float but NaN and infinity; a third of them with a special exponent or mantissa: zeros, subnormals, their neighbours, powers of two.
SUN_FN real test_real(uint_n i, uint stream) {
  uint_n h = hash2(i, (uint_n)(stream));
  uint_n mantissa = h & 0x007fffffu;
  uint_n pick = hash2(h, (uint_n)(stream + 1u));
  uint_n exponent = ((pick >> 16) * 255u) >> 16;
  exponent = (pick & 15u) == 0u ? (uint_n)(0u) : exponent;
  exponent = (pick & 15u) == 1u ? (uint_n)(1u) : exponent;
  exponent = (pick & 15u) == 2u ? (uint_n)(127u) : exponent;
  exponent = (pick & 15u) == 3u ? (uint_n)(254u) : exponent;
  mantissa = (pick & 0xf0u) == 0x00u ? (uint_n)(0u) : mantissa;
  mantissa = (pick & 0xf0u) == 0x10u ? (uint_n)(1u) : mantissa;
  mantissa = (pick & 0xf0u) == 0x20u ? (uint_n)(0x7fffffu) : mantissa;
  return real_of_bits((h & 0x80000000u) | (exponent << 23) | mantissa);
}
// Between 2^-20 and 2^21, either sign.
SUN_FN real test_moderate(uint_n i, uint stream) {
  uint_n h = hash2(i, (uint_n)(stream));
  uint_n exponent = 107u + (((hash2(h, (uint_n)(stream)) >> 16) * 41u) >> 16);
  return real_of_bits((h & 0x807fffffu) | (exponent << 23));
}
SUN_FN real test_subnormal(uint_n i, uint stream) { return real_of_bits(hash2(i, (uint_n)(stream)) & 0x807fffffu); }
SUN_FN real test_unit(uint_n i, uint stream) { return unit_of_hash(hash2(i, (uint_n)(stream))); }

// What sections work on, made once for each input number.
typedef struct TestInputs {
  uint_n i, h;
  real a, b, c;  // any
  real p, q, r;  // moderate
  real s, t;     // subnormal or zero
  real u, v, w;  // in [0, 1)
} TestInputs;
SUN_FN TestInputs test_inputs(uint_n i) {
  TestInputs in;
  in.i = i;
  in.h = hash2(i, (uint_n)(12u));
  in.a = test_real(i, 1u);
  in.b = test_real(i, 2u);
  in.c = test_real(i, 3u);
  in.p = test_moderate(i, 4u);
  in.q = test_moderate(i, 5u);
  in.r = test_moderate(i, 6u);
  in.s = test_subnormal(i, 7u);
  in.t = test_subnormal(i, 8u);
  in.u = test_unit(i, 9u);
  in.v = test_unit(i, 10u);
  in.w = test_unit(i, 11u);
  return in;
}

// Outputs: the bits, every NaN the same (which one comes out, no standard says).
SUN_FN uint_n test_bits(real x) { return x == x ? bits_of_real(x) : (uint_n)(0x7fc00000u); }
SUN_FN uint_n test_bits2(real x, real y) { return test_bits(x) + 3u * mix_bits(test_bits(y)); }

SUN_FN uint_n test_of_add(const TestInputs *in) { return test_bits2(in->a + in->b, in->p + in->q); }
SUN_FN uint_n test_of_subtract(const TestInputs *in) { return test_bits2(in->a - in->c, in->p - in->r); }
SUN_FN uint_n test_of_multiply(const TestInputs *in) { return test_bits2(in->a * in->b, in->p * in->q); }
SUN_FN uint_n test_of_divide(const TestInputs *in) { return test_bits2(in->a / in->b, in->p / in->q); }
SUN_FN uint_n test_of_reciprocal(const TestInputs *in) { return test_bits2(1.0f / in->c, 1.0f / in->r); }
SUN_FN uint_n test_of_sqrt(const TestInputs *in) { return test_bits2(sqrt(fabs(in->a)), sqrt(fabs(in->p))); }
SUN_FN uint_n test_of_inverse_sqrt(const TestInputs *in) { return test_bits2(1.0f / sqrt(fabs(in->b)), 1.0f / sqrt(fabs(in->q))); }
SUN_FN uint_n test_of_fma(const TestInputs *in) { return test_bits(fma(in->p, in->q, in->r)); }
// The exact remainder of a product, and the sign of a b - c d that watertight edges hang on.
SUN_FN uint_n test_of_fma_remainder(const TestInputs *in) {
  real a = in->p, b = in->q, c = in->q, d = (in->i & 1u) == 0u ? in->p : real_of_bits(bits_of_real(in->p) ^ 1u);
  real p = a * b, q = c * d;
  return test_bits2(fma(a, b, -p) - fma(c, d, -q), p - q);
}
// Two roundings, not one: no fusing behind our back.
SUN_FN uint_n test_of_unfused(const TestInputs *in) { return test_bits2(in->p * in->q + in->r, in->p * in->q - in->r * in->p); }
SUN_FN uint_n test_of_subnormal_add(const TestInputs *in) { return test_bits2(in->s + in->t, in->s - 1.17549435e-38f); }
SUN_FN uint_n test_of_subnormal_multiply(const TestInputs *in) { return test_bits2(in->s * in->p, (in->p * 1.0e-30f) * (in->q * 1.0e-12f)); }
SUN_FN uint_n test_of_subnormal_divide(const TestInputs *in) { return test_bits2(in->s / in->p, (in->p * 1.0e-30f) / (in->q * 1.0e10f)); }
SUN_FN uint_n test_of_subnormal_sqrt(const TestInputs *in) { return test_bits(sqrt(fabs(in->s))); }
// Where the compiler has an fma in software (Mesa 22.3), this is what it gets wrong.
SUN_FN uint_n test_of_subnormal_fma(const TestInputs *in) { return test_bits2(fma(in->s, in->u, in->t), fma(in->a, in->b, in->c)); }
SUN_FN uint_n test_of_floor(const TestInputs *in) { return test_bits2(floor(in->a), floor(in->p)); }
SUN_FN uint_n test_of_compare(const TestInputs *in) {
  real a = in->a, b = (in->i & 3u) == 0u ? -in->a : in->b;
  mask less = a < b, equal = a == b, least = (a <= b) & !(a >= b);
  uint_n bits = (less ? (uint_n)(1u) : (uint_n)(0u)) | (equal ? (uint_n)(2u) : (uint_n)(0u)) | (least ? (uint_n)(4u) : (uint_n)(0u));
  return bits ^ test_bits2(clamp_real(a, (real)(-1.0f), (real)(1.0f)), less ? a : b);
}
SUN_FN uint_n test_of_sign(const TestInputs *in) { return test_bits2(copysign(in->a, in->b), fabs(in->c)); }
SUN_FN uint_n test_of_float_to_int(const TestInputs *in) { return uint_of_int(int_of_real(in->p * 1000.0f)); }
SUN_FN uint_n test_of_int_to_float(const TestInputs *in) { return test_bits2(real_of_int(int_of_uint(in->h)), real_of_uint(in->h >> (in->h & 15u))); }
SUN_FN uint_n test_of_integers(const TestInputs *in) {
  uint_n a = in->h, b = bits_of_real(in->c);
  return (a * b) ^ (a >> (b & 31u)) ^ (a << (b & 31u)) ^ (a % (b | 1u)) ^ uint_of_int(int_of_uint(a) >> 7) ^ reverse_bits(b);
}
// Small differences grow at every step.
SUN_FN uint_n test_of_chain(const TestInputs *in) {
  real x = in->u, y = in->v;
  for (int step = 0; step < 24; step++) {
    real t = x * 1.7f - y * y;
    y = x * y * 2.0f + 0.3f;
    x = t * 0.5f + (x - 0.25f) * (y - 0.125f);
    x = x - floor(x);
    y = y - floor(y);
  }
  return test_bits2(x, y);
}
SUN_FN uint_n test_of_sin_cos(const TestInputs *in) {
  real sine, cosine;
  sin_cos((in->u - 0.5f) * ((in->i & 1u) == 0u ? (real)(20.0f) : (real)(20000.0f)), &sine, &cosine);
  return test_bits2(sine, cosine);
}
SUN_FN uint_n test_of_exp(const TestInputs *in) { return test_bits(exp_real((in->i & 3u) == 0u ? in->a : in->u * 200.0f - 108.0f)); }
SUN_FN uint_n test_of_log(const TestInputs *in) { return test_bits(log_real((in->i & 3u) == 0u ? 0.5f + in->u : fabs(in->a))); }
SUN_FN uint_n test_of_pow(const TestInputs *in) {
  mask wild = (in->i & 1u) == 0u;
  return test_bits(pow_real(wild ? fabs(in->a) : in->v, wild ? in->u * 4.0f - 2.0f : in->p));
}
SUN_FN uint_n test_of_acos(const TestInputs *in) { return test_bits(acos_real(in->u * 2.0f - 1.0f)); }
SUN_FN uint_n test_of_asin(const TestInputs *in) { return test_bits(asin_real(in->u * 2.0f - 1.0f)); }
SUN_FN uint_n test_of_atan2(const TestInputs *in) {
  mask wild = (in->i & 1u) == 0u;
  return test_bits(atan2_real(wild ? in->a : in->p, wild ? in->b : in->q));
}
SUN_FN uint_n test_of_sobol(const TestInputs *in) {
  SamplerKey key = sampler_key(7u, in->i & 127u, in->i >> 7, in->h & 0xffffu, SUN_SAMPLER_SOBOL);
  vec2 u = sample_2d(&key, in->i & 63u);
  return test_bits2(u.x, u.y);
}
SUN_FN uint_n test_of_independent(const TestInputs *in) {
  SamplerKey key = sampler_key(7u, in->i & 127u, in->i >> 7, in->h & 0xffffu, SUN_SAMPLER_INDEPENDENT);
  vec2 u = sample_2d(&key, in->i & 63u);
  return test_bits2(u.x, u.y) ^ mix_bits(test_bits(hash_coin(&key, in->h & 7u, in->i, in->i >> 3, 1u)));
}
SUN_FN uint_n test_of_warp(const TestInputs *in) {
  vec2 u = make_vec2(in->u, in->v);
  vec3 cosine = square_to_cosine_hemisphere(u), cone = square_to_cone(u, in->w);
  vec2 triangle = square_to_triangle(u);
  uint_n bits = test_bits2(cosine.x + cosine.y, cosine.z) ^ mix_bits(test_bits2(cone.x + cone.y, cone.z));
  return bits ^ mix_bits(test_bits2(triangle.x, triangle.y) + test_bits(power_heuristic(in->u, in->w)));
}
SUN_FN uint_n test_of_vector(const TestInputs *in) {
  vec3 a = make_vec3(in->p, in->q, in->r);
  vec3 n = normalize3(a);
  Frame3 frame = frame_of_normal(n);
  vec3 w = to_world(&frame, make_vec3(n.z, n.x, n.y));
  vec3 c = cross3(a, w);
  return test_bits2(dot3(n, w), w.x) ^ mix_bits(test_bits2(c.x, c.y) + test_bits(luminance(c)));
}
SUN_FN uint_n test_of_film_round(const TestInputs *in) {
  real x = (in->i & 1u) == 0u ? in->a : in->p;
  float xs[LANES], dithers[LANES];
  uint words[LANES];
  LANES_STORE(x, xs);
  LANES_STORE(in->u, dithers);
  for (int lane = 0; lane < LANES; lane++) {
    uint bin, verdict;
    ulong value = (ulong)film_round(xs[lane], dithers[lane], &bin, &verdict);
    words[lane] = (uint)(value & 0xffffffffu) ^ mix_bits_1((uint)(value >> 32)) ^ (bin << 5) ^ (verdict << 9);
  }
  return LANES_LOAD(words);
}

#define SUN_SELFTEST_SECTIONS(SECTION)                                                                                                     \
  SECTION(add) SECTION(subtract) SECTION(multiply) SECTION(divide) SECTION(reciprocal) SECTION(sqrt) SECTION(inverse_sqrt) SECTION(fma)    \
  SECTION(fma_remainder) SECTION(unfused) SECTION(subnormal_add) SECTION(subnormal_multiply) SECTION(subnormal_divide)                     \
  SECTION(subnormal_sqrt) SECTION(subnormal_fma) SECTION(floor) SECTION(compare) SECTION(sign) SECTION(float_to_int)                       \
  SECTION(int_to_float) SECTION(integers) SECTION(chain) SECTION(sin_cos) SECTION(exp) SECTION(log) SECTION(pow) SECTION(acos)             \
  SECTION(asin) SECTION(atan2) SECTION(sobol) SECTION(independent) SECTION(warp) SECTION(vector) SECTION(film_round)

// What input i adds to its section's sum.
SUN_FN uint_n test_term(uint_n i, uint_n result) { return mix_bits(result ^ mix_bits(i + 1u)); }

SUN_NAMESPACE_END
#endif
