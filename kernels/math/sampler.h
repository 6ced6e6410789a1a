// SPDX-License-Identifier: Apache-2.0
// Random numbers as pure functions of (seed, pixel, sample, dimension), without state.
// Sobol': each dimension, a pair of numbers, is the (0,2)-sequence of Sobol' under hash-based Owen scrambling [Laine11] [Burley20], its index
// shuffled by another such scramble keyed by pixel and dimension ("padding": pairs are joined at random). Independent: a plain hash.
#ifndef SUN_MATH_SAMPLER_H
#define SUN_MATH_SAMPLER_H
#include "math/hash.h"
#include "math/vector.h"
#include "shared/frame.h"

SUN_NAMESPACE_BEGIN

// The table of dimensions. Each is a pair: sample_2d gives both numbers, sample_1d the first of them, so take one or the other.
#define SUN_DIM_FILTER 0u          // place in the pixel's filter
#define SUN_DIM_LENS 1u            // place on the lens
#define SUN_DIM_TIME 0xffffffffu    // within the shutter's
#define SUN_DIM_FIRST_VERTEX 2u
#define SUN_DIM_PER_VERTEX 4u
// Of path vertex v (0: the first hit); v is a uint_n or a uint.
#define SUN_DIM_VERTEX(v, which) (SUN_DIM_FIRST_VERTEX + SUN_DIM_PER_VERTEX * (v) + (which))
#define SUN_DIM_EMITTER(v) SUN_DIM_VERTEX(v, 0u)        // x: which emitter; y: roulette
#define SUN_DIM_EMITTER_POINT(v) SUN_DIM_VERTEX(v, 1u)  // the point on it
#define SUN_DIM_LOBE(v) SUN_DIM_VERTEX(v, 2u)           // x: which lobe; y: whether a lobe of glass reflects
#define SUN_DIM_DIRECTION(v) SUN_DIM_VERTEX(v, 3u)      // the direction within it

typedef struct SamplerKey {
  uint_n pixel_hash;
  uint_n sample;
  uint kind;  // SUN_SAMPLER_
} SamplerKey;

// Pixel coordinates are those of the whole picture, so tiles don't matter.
SUN_FN SamplerKey sampler_key(uint seed, uint_n pixel_x, uint_n pixel_y, uint_n sample, uint kind) {
  SamplerKey key;
  key.pixel_hash = hash3((uint_n)(seed), pixel_x, pixel_y);
  key.sample = sample;
  key.kind = kind;
  return key;
}

SUN_FN uint_n reverse_bits(uint_n x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// An Owen scramble of the number whose bits are x reversed: each bit is flipped by a hash of those below it alone.
// The form is [Laine11]'s, the constants those found in [Vegdahl21].
SUN_FN uint_n owen_reversed(uint_n x, uint_n seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// The second dimension of Sobol' at `index`, its bits reversed. Its matrix is Pascal's triangle modulo 2, that is [1 1; 0 1] as a Kronecker power,
// so each factor takes one shift [Ahmed24].
SUN_FN uint_n sobol_second_reversed(uint_n index) {
  index ^= (index >> 1) & 0x55555555u;
  index ^= (index >> 2) & 0x33333333u;
  index ^= (index >> 4) & 0x0f0f0f0fu;
  index ^= (index >> 8) & 0x00ff00ffu;
  return index ^ (index >> 16);
}

// What the sequence is at a shuffled place; scrambling keeps each block of 2^m samples that starts at a multiple of 2^m together.
SUN_FN uint_n shuffled_index(uint_n sample, uint_n seed) { return reverse_bits(owen_reversed(reverse_bits(sample), seed)); }

SUN_FN vec2 sample_2d(const SamplerKey *key, uint_n dimension) {
  uint_n seed = hash_step(key->pixel_hash, dimension);
  uint_n x, y;
  if (key->kind == SUN_SAMPLER_SOBOL) {
    // The first dimension is the index, bits reversed (van der Corput).
    uint_n index = shuffled_index(key->sample, seed);
    x = reverse_bits(owen_reversed(index, hash_step(seed, (uint_n)(1u))));
    y = reverse_bits(owen_reversed(sobol_second_reversed(index), hash_step(seed, (uint_n)(2u))));
  } else {
    uint_n here = hash_step(seed, key->sample);
    x = hash_step(here, (uint_n)(1u));
    y = hash_step(here, (uint_n)(2u));
  }
  return make_vec2(unit_of_hash(x), unit_of_hash(y));
}

// The first number of sample_2d.
SUN_FN real sample_1d(const SamplerKey *key, uint_n dimension) {
  uint_n seed = hash_step(key->pixel_hash, dimension);
  uint_n x = key->kind == SUN_SAMPLER_SOBOL
                 ? reverse_bits(owen_reversed(shuffled_index(key->sample, seed), hash_step(seed, (uint_n)(1u))))
                 : hash_step(hash_step(seed, key->sample), (uint_n)(1u));
  return unit_of_hash(x);
}

// The number that decides whether a ray passes a partly transparent triangle. It belongs to the triangle and not to the order in which the tree is
// visited. `vertex` counts the path's hits, `salt` tells path rays (0) from shadow rays (1).
SUN_FN uint_n coin_hash(uint_n pixel_hash, uint_n sample, uint_n vertex, uint_n instance, uint_n primitive, uint salt) {
  return hash_step(hash4(pixel_hash ^ 0xc01dc01du, sample, vertex * 2u + salt, instance), primitive);
}
SUN_FN real hash_coin(const SamplerKey *key, uint_n vertex, uint_n instance, uint_n primitive, uint salt) {
  return unit_of_hash(coin_hash(key->pixel_hash, key->sample, vertex, instance, primitive, salt));
}
// The same for one lane; pixel_hash is hash3_1(seed, pixel x, pixel y).
SUN_FN float hash_coin_1(uint pixel_hash, uint sample, uint vertex, uint instance, uint primitive, uint salt) {
  return unit_of_hash_1(hash_step_1(hash4_1(pixel_hash ^ 0xc01dc01du, sample, vertex * 2u + salt, instance), primitive));
}

SUN_NAMESPACE_END
#endif
