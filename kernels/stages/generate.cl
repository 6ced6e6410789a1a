// SPDX-License-Identifier: Apache-2.0
// generate: dead slots become new paths (path regeneration).
//   reads    counts REFILL_*; the ray queue behind its live entries
//   writes   every column of the path; status
//   queues   the slots it fills stand in `rays` already: compact counted them in
//   holds    afterwards a slot of `rays` is alive, or stands for a pixel beyond the tile's edge and is dead
//   source   filter importance sampling [Ernst06]
#include "path/number.h"
#include "path/queue.h"
#include "transport/camera_path.h"

SUN_BODY void generate_bundle(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *records, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status,
                              const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts, uint first) {
  uint refill = counts[SUN_COUNT_REFILL];
  if (first >= refill) return;
  const SUN_GLOBAL float *tables = (const SUN_GLOBAL float *)(records + frame->at_tables);
  Paths paths = open_paths(frame, path_words);
  QueueLanes lanes = queue_lanes(rays + counts[SUN_COUNT_REFILL_FIRST], first, refill);

  PathNumber number = path_number(frame, (uint_n)(counts[SUN_COUNT_REFILL_PATH] + first) + uint_of_int((int_n)(LANE_NUMBERS)));
  mask inside = lanes.active & number.inside;
  Path path = camera_path(frame, tables, number.x, number.y, number.sample);
  path_store(&paths, lanes.slot, inside, &path);
  store_uint(status, lanes.slot, lanes.active, inside ? (uint_n)(SUN_STATUS_ALIVE) : (uint_n)(0));
}

SUN_KERNEL void generate(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *records, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status,
                         const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts) {
  generate_bundle(frame, records, path_words, status, rays, counts, (uint)get_global_id(0) * LANES);
}
