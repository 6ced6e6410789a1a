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
#define SUN_STATUS_ENDED_SHIFT 20          // why the path ended, below
#define SUN_ENDED_LIGHT 0
#define SUN_ENDED_DEPTH 1
#define SUN_ENDED_ESCAPED 2
#define SUN_ENDED_ABSORBED 3
#define SUN_ENDED_COUNT 4

// Lengths, in one buffer of uints.
#define SUN_COUNT_LIVE 0       // entries of the ray queue that are alive; the dead slots stand behind them
#define SUN_COUNT_SHADOW 1     // entries of the shadow queue
#define SUN_COUNT_NEXT_PATH 2  // paths of this launch begun so far
#define SUN_COUNT_ENDED 3      // 4 words
#define SUN_COUNT_CLAMPED 7    // contributions beyond the film's range
#define SUN_COUNT_NAN 8        // contributions that were NaN or infinite, dropped
#define SUN_COUNT_RAYS 9       // 3 words: camera, bounce, shadow rays traced
#define SUN_COUNT_BY_DEPTH 12  // 64 words: paths alive after this many scatterings (the last: and more)
#define SUN_COUNT_WORDS 80

// One hit, as intersect leaves it for shade.
typedef struct Hit {
  float t;         // along the ray; beyond every hit where instance is SUN_NONE
  float u, v;      // barycentric: point = (1 - u - v) * corner 0 + u * corner 1 + v * corner 2
  uint instance;   // SUN_NONE: nothing was hit
  uint primitive;  // without SUN_ID_ bits
  uint pad[3];
} Hit;
SUN_STATIC_ASSERT(sizeof(Hit) == 32, hit_is_32_bytes);

// One shadow ray, as shade leaves it for occlude.
typedef struct ShadowRay {
  float origin[3];
  float t_max;            // hits at t < t_max block
  float direction[3];     // not normalised where the target is a point: t_max is then 1 - a little
  uint pixel;
  float contribution[3];  // to the film where nothing blocks
  uint sample;
  uint depth;             // the layer it belongs to
  uint vertex;            // keys the random numbers of alpha along the ray
  uint pad[2];
} ShadowRay;
SUN_STATIC_ASSERT(sizeof(ShadowRay) == 64, shadow_ray_is_64_bytes);

SUN_NAMESPACE_END
#endif
