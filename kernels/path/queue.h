// SPDX-License-Identifier: Apache-2.0
// Queues: arrays of slot numbers in a stable order, their lengths in the buffer of counts.
// The ray queue holds every slot of the pool: first those that are alive, then the dead ones, which generate refills.
#ifndef SUN_PATH_QUEUE_H
#define SUN_PATH_QUEUE_H
#include "math/real.h"
#include "shared/queues.h"

SUN_NAMESPACE_BEGIN

// LANES consecutive entries of a queue.
typedef struct QueueLanes {
  uint_n slot;
  mask active;  // false beyond the end of the queue; such lanes name entry 0
} QueueLanes;

SUN_FN QueueLanes queue_lanes(const SUN_GLOBAL uint *queue, uint first, uint length) {
  QueueLanes lanes;
  uint_n position = (uint_n)(first) + uint_of_int((int_n)(LANE_NUMBERS));
  lanes.active = position < (uint_n)(length);
  lanes.slot = gather_uint(queue, lanes.active ? position : (uint_n)(0));
  return lanes;
}

// Those of them whose slot's status has, of the bits `asked`, the ones that are `wanted` and no other. `word`: all of it.
SUN_FN QueueLanes queue_lanes_with(const SUN_GLOBAL uint *queue, uint first, uint length, const SUN_GLOBAL uint *status, uint asked, uint wanted, uint_n *word) {
  QueueLanes lanes;
  *word = lanes.slot = (uint_n)(0);
  lanes.active = lanes.slot != (uint_n)(0);
  if (first >= length) return lanes;
  lanes = queue_lanes(queue, first, length);
  *word = gather_uint(status, lanes.slot);
  lanes.active = lanes.active & ((*word & (uint_n)(asked)) == (uint_n)(wanted));
  return lanes;
}

SUN_NAMESPACE_END
#endif
