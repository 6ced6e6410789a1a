// SPDX-License-Identifier: Apache-2.0
// Records of several words, one for each lane: memory has them one after the other, registers hold a vector for each word. A row a lane is loaded or stored
// as a whole and transposed in registers: several times faster than word by word, and than hardware gathers.
#ifndef SUN_MATH_RECORD_H
#define SUN_MATH_RECORD_H
#include "math/real.h"

SUN_NAMESPACE_BEGIN

// Four words of LANES records.
typedef struct Quad {
  uint_n x, y, z, w;
} Quad;

#if LANES > 1
// rows: four words a lane.
SUN_INLINE Quad quad_of_rows(const uint *rows) {
  const uint_n a = LANES_LOAD(rows), b = LANES_LOAD(rows + LANES), c = LANES_LOAD(rows + 2 * LANES), d = LANES_LOAD(rows + 3 * LANES);
  Quad quad;
#if LANES == 16
  quad.x = (uint16)(a.s048c, b.s048c, c.s048c, d.s048c);
  quad.y = (uint16)(a.s159d, b.s159d, c.s159d, d.s159d);
  quad.z = (uint16)(a.s26ae, b.s26ae, c.s26ae, d.s26ae);
  quad.w = (uint16)(a.s37bf, b.s37bf, c.s37bf, d.s37bf);
#else
  quad.x = (uint8)(a.s04, b.s04, c.s04, d.s04);
  quad.y = (uint8)(a.s15, b.s15, c.s15, d.s15);
  quad.z = (uint8)(a.s26, b.s26, c.s26, d.s26);
  quad.w = (uint8)(a.s37, b.s37, c.s37, d.s37);
#endif
  return quad;
}

// Four words that begin at `field` of the records that `index` names. A record is a multiple of 16 bytes, and the field stands at one.
#define GATHER_QUAD(out, records, index, field)                                                                                              \
  do {                                                                                                                                       \
    uint quad_at[LANES], quad_rows[4 * LANES];                                                                                               \
    LANES_STORE(index, quad_at);                                                                                                             \
    for (int lane = 0; lane < LANES; lane++)                                                                                                 \
      vstore4(vload4(0, (const SUN_GLOBAL uint *)&(records)[quad_at[lane]].field), (size_t)lane, quad_rows);                                 \
    (out) = quad_of_rows(quad_rows);                                                                                                         \
  } while (0)
#else
#define GATHER_QUAD(out, records, index, field)                                         \
  do {                                                                                  \
    const SUN_GLOBAL uint *quad_row = (const SUN_GLOBAL uint *)&(records)[index].field; \
    (out).x = quad_row[0];                                                              \
    (out).y = quad_row[1];                                                              \
    (out).z = quad_row[2];                                                              \
    (out).w = quad_row[3];                                                              \
  } while (0)
#endif

// The same, read once where all lanes name the record `first`.
#define RECORD_QUAD(out, alike, first, records, index, field)                              \
  do {                                                                                     \
    if (alike) {                                                                           \
      const SUN_GLOBAL uint *quad_words = (const SUN_GLOBAL uint *)&(records)[first].field; \
      (out).x = (uint_n)(quad_words[0]);                                                   \
      (out).y = (uint_n)(quad_words[1]);                                                   \
      (out).z = (uint_n)(quad_words[2]);                                                   \
      (out).w = (uint_n)(quad_words[3]);                                                   \
    } else {                                                                               \
      GATHER_QUAD(out, records, index, field);                                             \
    }                                                                                      \
  } while (0)

#if LANES == 16
#define INTERLEAVE_LOW(a, b) (uint16)((a).s0, (b).s0, (a).s1, (b).s1, (a).s2, (b).s2, (a).s3, (b).s3, (a).s4, (b).s4, (a).s5, (b).s5, (a).s6, (b).s6, (a).s7, (b).s7)
#define INTERLEAVE_HIGH(a, b) (uint16)((a).s8, (b).s8, (a).s9, (b).s9, (a).sa, (b).sa, (a).sb, (b).sb, (a).sc, (b).sc, (a).sd, (b).sd, (a).se, (b).se, (a).sf, (b).sf)
#elif LANES == 8
#define INTERLEAVE_LOW(a, b) (uint8)((a).s0, (b).s0, (a).s1, (b).s1, (a).s2, (b).s2, (a).s3, (b).s3)
#define INTERLEAVE_HIGH(a, b) (uint8)((a).s4, (b).s4, (a).s5, (b).s5, (a).s6, (b).s6, (a).s7, (b).s7)
#endif

#if LANES > 1
// LANES rows of LANES words, in place. Each stage is a perfect shuffle, which turns the bits of (row, column) by one; log2(LANES) of them swap the two.
SUN_INLINE void transpose(uint_n *v) {
SUN_UNROLL
  for (int stage = 1; stage < LANES; stage *= 2) {
    uint_n t[LANES];
SUN_UNROLL
    for (int i = 0; i < LANES / 2; i++) {
      t[2 * i] = INTERLEAVE_LOW(v[i], v[i + LANES / 2]);
      t[2 * i + 1] = INTERLEAVE_HIGH(v[i], v[i + LANES / 2]);
    }
SUN_UNROLL
    for (int i = 0; i < LANES; i++) v[i] = t[i];
  }
}
#endif

// Records of 16 words, a cache line each: word k of all lanes <-> words[k]. Lanes that are off have to name a record too.
SUN_INLINE void load_records(const SUN_GLOBAL uint *records, uint_n index, uint_n *words) {
#if LANES == 1
  for (uint k = 0; k < 16; k++) words[k] = records[index * 16 + k];
#else
  uint at[LANES];
  LANES_STORE(index, at);
  for (int first = 0; first < 16; first += LANES) {
SUN_UNROLL
    for (int lane = 0; lane < LANES; lane++) words[first + lane] = LANES_LOAD(records + (size_t)at[lane] * 16 + first);
    transpose(words + first);
  }
#endif
}

// Stores records of the lanes that are on. `words` is overwritten.
SUN_INLINE void store_records(SUN_GLOBAL uint *records, uint_n index, mask on, uint_n *words) {
#if LANES == 1
  if (on)
    for (uint k = 0; k < 16; k++) records[index * 16 + k] = words[k];
#else
  uint at[LANES];
  int lane_on[LANES];
  LANES_STORE(index, at);
  LANES_STORE(on, lane_on);
  for (int first = 0; first < 16; first += LANES) transpose(words + first);
SUN_UNROLL
  for (int lane = 0; lane < LANES; lane++)
    if (lane_on[lane])
      for (int first = 0; first < 16; first += LANES) {
        SUN_GLOBAL uint *place = records + (size_t)at[lane] * 16 + first;
        LANES_STORE(words[first + lane], place);
      }
#endif
}

SUN_NAMESPACE_END
#endif
