// SPDX-License-Identifier: Apache-2.0
// collect: light vertices of a batch of paths, which have all ended, go behind those of the batches before: ordered by the number of their path, then along it, whatever
// slots they were walked in.
//   reads    the walks; light vertices of the pool
//   writes   how many vertices each path has, then (sort's scan) where they begin; the map's vertices
//   holds    a path of the batch has been walked in one slot at most
#include "shared/bidirectional.h"
#include "shared/frame.h"
#include "shared/options.h"

// One slot a work-item: `path_slots` of the batch, `path_starts` of the whole pass and cleared before it.
__kernel void tally(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *walks, SUN_GLOBAL uint *path_starts, SUN_GLOBAL uint *path_slots, uint first, uint count) {
  uint slot = (uint)get_global_id(0);
  if (slot >= frame->pool) return;
  const SUN_GLOBAL uint *walk = walks + (size_t)slot * SUN_WALK_WORDS;
  uint number = walk[SUN_WALK_PATH];
  if (number == 0 || number - 1 < first || number - 1 - first >= count) return;
  path_starts[number - 1] = walk[SUN_WALK_VERTICES];
  path_slots[number - 1 - first] = slot;
}

// One path of the batch a work-item; `end` is where the last of them ends. `records`: how many of each vertex are kept.
__kernel void collect(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *light_vertices, const SUN_GLOBAL uint *path_starts, const SUN_GLOBAL uint *path_slots,
                      SUN_GLOBAL uint *map_vertices, uint first, uint count, uint end, uint records) {
  uint path = (uint)get_global_id(0);
  if (path >= count) return;
  uint at = path_starts[first + path], behind = path + 1 < count ? path_starts[first + path + 1] : end;
  if (at == behind) return;
  uint slot = path_slots[path];
  for (uint number = 0; at + number < behind; number++) {
    const SUN_GLOBAL uint *from = light_vertices + (size_t)(number * frame->pool + slot) * SUN_LIGHT_VERTEX_RECORDS * 16;
    SUN_GLOBAL uint *to = map_vertices + (size_t)(at + number) * records * 16;
    for (uint word = 0; word < records * 16; word++) to[word] = from[word];
  }
}

// Into a larger map.
__kernel void copy_words(const SUN_GLOBAL uint *from, SUN_GLOBAL uint *to, uint count) {
  uint i = (uint)get_global_id(0);
  if (i < count) to[i] = from[i];
}
