// SPDX-License-Identifier: Apache-2.0
// Adds to the integer film (shared/film.h): a contribution is rounded once to its quantum (math/quantum.h) and added as an integer, so that the
// order of adding never shows.
// Scalar code, a contribution at a time: the adds are atomic anyway. film_add_lanes goes through the lanes.
#ifndef SUN_PATH_FILM_H
#define SUN_PATH_FILM_H
#include "math/hash.h"
#include "math/quantum.h"
#include "math/vector.h"
#include "shared/film.h"
#include "shared/queues.h"

#if SUN_ATOMICS_64 && !defined(__cplusplus)
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#endif

SUN_NAMESPACE_BEGIN

#ifdef __cplusplus
typedef long *FilmWords;
typedef uint *FilmCounts;
SUN_FN void film_count(FilmCounts counts, uint which) { counts[which]++; }
#else
typedef volatile __global long *FilmWords;
typedef volatile __global uint *FilmCounts;
SUN_FN void film_count(FilmCounts counts, uint which) { atomic_inc(counts + which); }
#endif

typedef struct FilmView {
  FilmWords words;    // index as in shared/film.h
  uint pixels;        // of the tile
  FilmCounts counts;  // SUN_COUNT_WORDS of them
} FilmView;

// Keys tell the contributions of one sample apart, for their dither. The same contribution added to two layers (beauty and its bounce) takes the same
// key, and so the same integer: that is why beauty is exactly the sum of its bounces. `vertex` counts the path's hits.
#define SUN_FILM_KEY_EMISSION(vertex) (4u * (vertex))
#define SUN_FILM_KEY_DIRECT(vertex, number) (4u * ((vertex) + ((number) << 20)) + 1u)
#define SUN_FILM_KEY_PHOTONS(vertex, depth) (4u * ((vertex) + ((depth) << 20)) + 3u)  // that had scattered so often
#define SUN_FILM_KEY_LAYER(layer) (4u * (layer) + 2u)  // first-hit layers: albedo, normal ...

// Adds one 64-bit integer.
SUN_FN void film_add_word(FilmWords word, long value) {
#ifdef __cplusplus
  *word = static_cast<long>(static_cast<ulong>(*word) + static_cast<ulong>(value));
#elif SUN_ATOMICS_64
  atom_add(word, value);
#else
  // Two halves modulo 2^32 (a negative value is 2^64 less its size). Each wrap of the low half is seen by exactly one adder, which carries it
  // over; so the
  // sum is right once all have added, whatever their order.
  volatile __global uint *halves = (volatile __global uint *)word;
#ifdef __ENDIAN_LITTLE__
  volatile __global uint *low_half = halves;
  volatile __global uint *high_half = halves + 1;
#else
  volatile __global uint *low_half = halves + 1;
  volatile __global uint *high_half = halves;
#endif
  uint low = (uint)((ulong)value & 0xffffffffu);
  uint high = (uint)((ulong)value >> 32);
  if (low != 0u) {
    uint before = atomic_add(low_half, low);
    high += before + low < before ? 1u : 0u;
  }
  if (high != 0u) atomic_add(high_half, high);
#endif
}

SUN_FN void film_add_channel(const FilmView *film, ulong index, float x, uint dither) {
  uint bin, verdict;
  long value = film_round(x, unit_of_hash_1(dither), &bin, &verdict);
  if (verdict == SUN_FILM_BAD) film_count(film->counts, SUN_COUNT_NAN);
  if (verdict == SUN_FILM_CLAMPED) film_count(film->counts, SUN_COUNT_CLAMPED);
  if (value != 0) film_add_word(film->words + (index * SUN_FILM_BINS + bin), value);
}

// One contribution of a sample. `pixel` is its place in the tile; `pixel_hash` is hash3_1(seed, x, y) of the whole picture, so that tiles don't
// matter.
SUN_FN void film_add(const FilmView *film, uint layer, uint pixel, uint pixel_hash, uint sample, uint key, float r, float g, float b) {
  if (r == 0.0f && g == 0.0f && b == 0.0f) return;
  uint dither = hash3_1(pixel_hash ^ 0xf117a11eu, sample, key);
  ulong first = ((ulong)layer * film->pixels + pixel) * SUN_FILM_CHANNELS;
  film_add_channel(film, first, r, dither);
  film_add_channel(film, first + 1, g, hash_step_1(dither, 1u));
  film_add_channel(film, first + 2, b, hash_step_1(dither, 2u));
}

// The same for the lanes in `on`, one after the other.
SUN_FN void film_add_lanes(const FilmView *film, mask on, uint_n layer, uint_n pixel, uint_n pixel_hash, uint_n sample, uint_n key, vec3 rgb) {
  if (!ANY(on)) return;
  uint ons[LANES], layers[LANES], pixels[LANES], hashes[LANES], samples[LANES], keys[LANES];
  float r[LANES], g[LANES], b[LANES];
  uint_n flags = on ? (uint_n)(1u) : (uint_n)(0u);
  LANES_STORE(flags, ons);
  LANES_STORE(layer, layers);
  LANES_STORE(pixel, pixels);
  LANES_STORE(pixel_hash, hashes);
  LANES_STORE(sample, samples);
  LANES_STORE(key, keys);
  LANES_STORE(rgb.x, r);
  LANES_STORE(rgb.y, g);
  LANES_STORE(rgb.z, b);
  for (int lane = 0; lane < LANES; lane++) {
    if (ons[lane]) film_add(film, layers[lane], pixels[lane], hashes[lane], samples[lane], keys[lane], r[lane], g[lane], b[lane]);
  }
}

SUN_NAMESPACE_END
#endif
