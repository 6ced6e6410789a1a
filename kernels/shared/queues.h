// SPDX-License-Identifier: Apache-2.0
// Names of queues, counters and status bits. A queue is an array of slot numbers; its length stays on the device.
#ifndef SUN_SHARED_QUEUES_H
#define SUN_SHARED_QUEUES_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

// A slot's status word. Low 16 bits: depth (scatterings so far).
#define SUN_STATUS_DEPTH 0x0000ffffu
#define SUN_STATUS_ALIVE 0x00010000u
#define SUN_STATUS_SHADOW 0x00020000u      // a shadow ray waits in this slot
#define SUN_STATUS_FIRST_HIT 0x00040000u   // the layers of the first hit have been written
#define SUN_STATUS_ENDED 0x00080000u       // the path has just ended and is not counted yet
#define SUN_STATUS_ENDED_SHIFT 20          // why it ended, below
#define SUN_STATUS_PHASE 0x00300000u       // of a path that is alive, where there are photons: SUN_PHASE_, in the same bits
#define SUN_STATUS_PHASE_SHIFT 20
#define SUN_PHASE_SHARP 0                  // nothing but mirrors and glass since the eye
#define SUN_PHASE_FINAL 1                  // past the surface that looks at caustics
#define SUN_PHASE_LAST 2                   // past the surface that looks at all photons: it sees what lights send there, and ends
#define SUN_STATUS_AGAIN 0x00400000u       // the hit is that of a vertex taken up again, for its next child: no ray is traced
#define SUN_STATUS_TURN 0x00800000u        // the light subpath has ended: emit begins the eye subpath of the same sample
#define SUN_STATUS_LIGHT 0x80000000u       // walks the light subpath
#define SUN_STATUS_SHADOWS 0x7f000000u     // how many shadow rays wait
#define SUN_STATUS_SHADOWS_SHIFT 24
#define SUN_ENDED_LIGHT 0
#define SUN_ENDED_DEPTH 1
#define SUN_ENDED_ESCAPED 2
#define SUN_ENDED_ABSORBED 3
#define SUN_ENDED_COUNT 4

// Lengths and counters, in one buffer of uints.
#define SUN_COUNT_LIVE 0         // entries of the ray queue that stages work on: alive ones, then those that generate fills
#define SUN_COUNT_SHADOW 1       // entries of the shadow queue
#define SUN_COUNT_REFILL_FIRST 2 // queue position of the first slot to fill ...
#define SUN_COUNT_REFILL 3       // ... how many ...
#define SUN_COUNT_REFILL_PATH 4  // ... and the number of the first path there
#define SUN_COUNT_NEXT_PATH 5    // paths of this launch begun so far
#define SUN_COUNT_PATHS 80       // paths of this launch: the host lowers it to end early, after a whole sample
#define SUN_COUNT_CLAMPED 6      // contributions beyond the film's range
#define SUN_COUNT_NAN 7          // contributions that were NaN or infinite, dropped
#define SUN_COUNT_ENDED 8        // 4 words: paths ended, by reason
#define SUN_COUNT_RAYS 12        // 3 words: camera rays that went on straight, bounce rays, shadow rays
#define SUN_COUNT_BY_DEPTH 16    // 64 words: paths ended after so many scatterings (the last: or more)
#define SUN_COUNT_DEPTHS 64
#define SUN_COUNT_BRANCHED 96    // 64 words: branches begun beside the first, at vertices after so many scatterings (the last: or more)
#define SUN_COUNT_WORDS 160

// Records of 16 words that a slot needs to walk a tree of rays (transport/branch.h): its state, and two for each vertex that may wait.
#define SUN_BRANCH_RECORDS(max_depth) (1u + 2u * (max_depth))

// One hit, as intersect leaves it for shade.
typedef struct Hit {
  float t;         // along the ray; beyond every hit where instance is SUN_NONE
  float u, v;      // barycentric: point = (1 - u - v) * corner 0 + u * corner 1 + v * corner 2; of a shape: scene/shape.h
  uint instance;   // SUN_NONE: nothing was hit
  uint primitive;  // without SUN_ID_ bits
  uint pad[3];
} Hit;
SUN_STATIC_ASSERT(sizeof(Hit) == 32, hit_is_32_bytes);

// One shadow ray, as shade leaves it for occlude.
typedef struct ShadowRay {
  float origin[3];
  float t_max;            // hits at t < t_max block; negative: no ray, in a slot where others wait
  float direction[3];     // not normalised where the target is a point: t_max is then 1 - a little
  uint pixel;
  float contribution[3];  // to the film where nothing blocks
  uint sample;
  uint depth;             // the layer it belongs to
  uint vertex;            // keys the random numbers of alpha along the ray
  uint number;            // among the shadow rays of this vertex
  float time;             // of its path, within the shutter's
} ShadowRay;
SUN_STATIC_ASSERT(sizeof(ShadowRay) == 64, shadow_ray_is_64_bytes);

SUN_NAMESPACE_END
#endif
