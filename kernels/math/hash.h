// SPDX-License-Identifier: Apache-2.0
// Integer hashes: all randomness of the program comes from these. Words are taken in one after the other; each step is a bijection of the word
// for a fixed state, so two inputs that differ in the last word alone never collide.
// Each function comes twice: on uint_n, and with _1 on a single uint, for code that goes a lane at a time (film, traversal).
#ifndef SUN_MATH_HASH_H
#define SUN_MATH_HASH_H
#include "math/real.h"

SUN_NAMESPACE_BEGIN

// The finaliser's shifts and factors are those found by search in [Wellons18]: bias 0.107 where 0 is ideal.
#define SUN_DEFINE_HASHES(word, suffix)                                                                                             \
  SUN_FN word mix_bits##suffix(word x) {                                                                                            \
    x ^= x >> 16;                                                                                                                   \
    x *= 0x21f0aaadu;                                                                                                               \
    x ^= x >> 15;                                                                                                                   \
    x *= 0xd35a2d97u;                                                                                                               \
    return x ^ (x >> 15);                                                                                                           \
  }                                                                                                                                 \
  SUN_FN word hash_step##suffix(word state, word value) { return mix_bits##suffix(state ^ (value + 0x9e3779b9u)); }                 \
  SUN_FN word hash2##suffix(word a, word b) { return hash_step##suffix(mix_bits##suffix(a + 0x85ebca6bu), b); }                     \
  SUN_FN word hash3##suffix(word a, word b, word c) { return hash_step##suffix(hash2##suffix(a, b), c); }                           \
  SUN_FN word hash4##suffix(word a, word b, word c, word d) { return hash_step##suffix(hash3##suffix(a, b, c), d); }

SUN_DEFINE_HASHES(uint_n, )
SUN_DEFINE_HASHES(uint, _1)
#undef SUN_DEFINE_HASHES

// The number in [0, 1) that a hash stands for: 24 bits, exact.
SUN_FN real unit_of_hash(uint_n u) { return real_of_uint(u >> 8) * 5.96046448e-8f; }
SUN_FN float unit_of_hash_1(uint u) { return (float)(u >> 8) * 5.96046448e-8f; }

SUN_NAMESPACE_END
#endif
