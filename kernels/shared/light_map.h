// SPDX-License-Identifier: Apache-2.0
// Light vertices of a whole light pass, one after the other by the number of their path, then along it; and a grid over them.
#ifndef SUN_SHARED_LIGHT_MAP_H
#define SUN_SHARED_LIGHT_MAP_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

// Words of a light vertex' first record: 0 to 2 are its position, as for every look-up.
#define SUN_LIGHT_VERTEX_FLAGS 3
#define SUN_LIGHT_VERTEX_NORMAL 4          // 3 words
#define SUN_LIGHT_VERTEX_SOLID 1u
#define SUN_LIGHT_VERTEX_FRONT 4u
#define SUN_LIGHT_VERTEX_CAUSTIC 8u
#define SUN_LIGHT_VERTEX_UNSEEN 16u
#define SUN_LIGHT_VERTEX_DEPTH_SHIFT 8     // 8 bits
#define SUN_LIGHT_VERTEX_PRESENCE_SHIFT 16 // where walks merge: 16 bits, all of them 1

// Words of a grid's entry: the vertex' position, so that those out of reach need no look at the vertex, and its number.
#define SUN_MAP_ENTRY_WORDS 4

#define SUN_SCAN_BLOCK 256   // entries that a work-item sums up
#define SUN_SORT_BITS 8      // that a pass of the sort looks at
#define SUN_SORT_DIGITS 256

#define SUN_MOST_PHOTONS 268435456  // light paths of a map

// Vertices merge where their surfaces face the same way within this cosine, 60 degrees: facets of a coarse mesh do, walls of a room do not.
#define SUN_MERGE_COSINE 0.5f

// And where neither lies farther off the plane of the other than this share of the radius: what hangs close to a surface is another one.
#define SUN_MERGE_OFF 0.2f

SUN_NAMESPACE_END
#endif
