// SPDX-License-Identifier: Apache-2.0
// What moves while the shutter is open (docs/decisions/0009-motion.md). The shutter's time, 0 to 1, is cut into `steps` equal steps, a power of two; at their ends
// stand keys, and between two keys everything is linear. A ray has one time.
// An instance that moves has steps + 1 matrices. Vertices that deform stand together, `deforming` of them, steps + 1 times one behind the other in Vertex[] (and in
// VertexExtra[]): those of key k stand k * deforming behind those of key 0, which triangles name.
#ifndef SUN_SHARED_MOTION_H
#define SUN_SHARED_MOTION_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

// Behind the last of the instances, in their buffer, stand a Motion and the keys of all instances that move.
typedef struct Motion {
  uint steps;      // 0: all is still
  uint deforming;
  uint pad[2];
} Motion;
SUN_STATIC_ASSERT(sizeof(Motion) == 16, motion_is_16_bytes);

typedef struct InstanceKey {
  float to_world[12];  // as Instance has it
} InstanceKey;
SUN_STATIC_ASSERT(sizeof(InstanceKey) == 48, instance_key_is_48_bytes);

#define SUN_MOST_MOTION_STEPS 64  // so that a step and the way through it are exact parts of a 24-bit time

SUN_NAMESPACE_END
#endif
