// SPDX-License-Identifier: Apache-2.0
// Walks from both ends. A slot first walks the light subpath of its sample, stores its vertices, then walks the eye subpath and joins each of its vertices with
// them. A path of s vertices from the light's side and t from the eye's scatters s + t - 2 times.
#ifndef SUN_SHARED_BIDIRECTIONAL_H
#define SUN_SHARED_BIDIRECTIONAL_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

// Light subpaths number their vertices from here on (the emitter has this number, its first hit the next), eye subpaths from 0: so random numbers, coins and
// the film's keys are their own.
#define SUN_LIGHT_VERTEX 0x20000000u

// The most scatterings: an eye vertex sends a shadow ray to an emitter and to each light vertex, and a slot keeps as many.
#define SUN_MOST_BIDIRECTIONAL_DEPTH 64

// The words of a walk: what it needs beside its path, a record of 16 words (one cache line) a slot.
#define SUN_WALK_dVCM 0          // [Georgiev12 eq. 31-33, 35-36], of the walk's last vertex or, before it arrives there, of the segment
#define SUN_WALK_dVC 1
#define SUN_WALK_VERTICES 2      // light vertices stored so far
#define SUN_WALK_FAR 3           // 1: the segment comes from infinitely far (sky, directional light, orthographic camera)
#define SUN_WALK_EMITTED 4       // 3 words: what the light subpath's throughput is a fraction of
#define SUN_WALK_ROUGH 7         // scatterings so far that were no deltas
#define SUN_WALK_ABSORPTION 8    // 3 words, 1/metre: of what the light subpath's segment goes through
#define SUN_WALK_PATH 11         // number of the light subpath within its launch, and one: 0 is none
#define SUN_WALK_HOLDS 12        // 1: a light vertex is stored of the depth at hand
#define SUN_WALK_UNSEEN 13       // 1: from a light without extent, and nothing but deltas since
#define SUN_WALK_dVM 14          // where walks merge, too
#define SUN_WALK_WORDS 16

// The words of a light vertex: two records. Who looks at light that arrives, and not at what the surface there does with it, needs the first alone.
#define SUN_LIGHT_VERTEX_RECORDS 2

// Light vertices that a subpath may store of each depth: more than one where it can go straight on through what also scatters (thin glass).
#define SUN_LIGHT_VERTICES_A_DEPTH(passable) ((passable) ? 2u : 1u)

SUN_NAMESPACE_END
#endif
