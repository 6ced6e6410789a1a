// SPDX-License-Identifier: Apache-2.0
// Adds to a film of few pixels from very many work-items at once.
#include "path/film.h"

// Contribution number n; the host's test makes the same.
SUN_FN float probe_value(uint n, uint channel) {
  uint h = hash3_1(n, channel, 99u);
  return as_float((h & 0x807fffffu) | ((n % 1009u == 7u ? 255u : 90u + hash2_1(h, 3u) % 65u) << 23));
}

SUN_KERNEL void film_contributions(__global long *words, __global uint *counts, const uint pixels, const uint total) {
  const uint first = get_global_id(0) * LANES;
  if (first >= total) return;
  const FilmView film = {(FilmWords)words, pixels, (FilmCounts)counts};
  const uint_n n = first + uint_of_int(LANE_NUMBERS);
  float r[LANES], g[LANES], b[LANES];
  for (int lane = 0; lane < LANES; lane++) {
    r[lane] = probe_value(first + lane, 0u);
    g[lane] = probe_value(first + lane, 1u);
    b[lane] = probe_value(first + lane, 2u);
  }
  // Every fifth is switched off.
  film_add_lanes(&film, (n % 5u) != 0u, n & 1u, n % pixels, hash2(n, (uint_n)(4u)), n >> 3, SUN_FILM_KEY_EMISSION(n & 3u),
                 make_vec3(LANES_LOAD(r), LANES_LOAD(g), LANES_LOAD(b)));
}

// Whole 64-bit words, both signs, so that carries and borrows run through the low half all the time.
__kernel void film_words(__global long *words, const uint total) {
  const uint n = get_global_id(0);
  if (n >= total) return;
  const ulong size = ((ulong)hash2_1(n, 1u) << 16) | (hash2_1(n, 2u) & 0xffffu);
  film_add_word((FilmWords)words + n % 3u, n & 1u ? (long)size : -(long)size);
  // And the worst of it: one up, one down, over the edge of the low half.
  film_add_word((FilmWords)words + 3, n & 1u ? 1l : -1l);
}
