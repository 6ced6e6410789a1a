// SPDX-License-Identifier: Apache-2.0
// sort: the vertices of a light map by bucket, stably: a radix sort of keys and numbers, each pass a histogram, a scan and a scatter in which every work-item owns a chunk.
//   reads    the map's vertices
//   writes   keys and order, twice; the grid's entries, and the table of where each bucket begins
//   holds    afterwards vertices of one bucket stand in the order of their numbers
#include "transport/light_map.h"

// Where a vertex belongs; those without the flags that are wanted go behind all buckets.
__kernel void map_keys(const SUN_GLOBAL uint *map_vertices, uint records, uint count, float radius, uint table_mask, uint wanted, SUN_GLOBAL uint *keys,
                       SUN_GLOBAL uint *order) {
  uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const SUN_GLOBAL uint *word = map_vertices + (size_t)i * records * 16;
  int cell[3];
  for (int axis = 0; axis < 3; axis++) cell[axis] = map_cell(as_float(word[axis]), radius);
  keys[i] = (word[SUN_LIGHT_VERTEX_FLAGS] & wanted) == wanted ? map_bucket(cell, table_mask) : table_mask + 1;
  order[i] = i;
}

__kernel void histogram_chunks(const SUN_GLOBAL uint *keys, uint count, uint chunk, uint shift, SUN_GLOBAL uint *histogram) {
  uint at = (uint)get_global_id(0), chunks = (count + chunk - 1) / chunk;
  if (at >= chunks) return;
  uint found[SUN_SORT_DIGITS];
  for (uint digit = 0; digit < SUN_SORT_DIGITS; digit++) found[digit] = 0;
  uint end = at + 1 < chunks ? (at + 1) * chunk : count;
  for (uint i = at * chunk; i < end; i++) found[(keys[i] >> shift) & (SUN_SORT_DIGITS - 1u)]++;
  for (uint digit = 0; digit < SUN_SORT_DIGITS; digit++) histogram[digit * chunks + at] = found[digit];
}

__kernel void reorder_chunks(const SUN_GLOBAL uint *keys, const SUN_GLOBAL uint *order, uint count, uint chunk, uint shift, const SUN_GLOBAL uint *histogram,
                             SUN_GLOBAL uint *keys_out, SUN_GLOBAL uint *order_out) {
  uint at = (uint)get_global_id(0), chunks = (count + chunk - 1) / chunk;
  if (at >= chunks) return;
  uint next[SUN_SORT_DIGITS];
  for (uint digit = 0; digit < SUN_SORT_DIGITS; digit++) next[digit] = histogram[digit * chunks + at];
  uint end = at + 1 < chunks ? (at + 1) * chunk : count;
  for (uint i = at * chunk; i < end; i++) {
    uint to = next[(keys[i] >> shift) & (SUN_SORT_DIGITS - 1u)]++;
    keys_out[to] = keys[i];
    order_out[to] = order[i];
  }
}

__kernel void map_entries(const SUN_GLOBAL uint *map_vertices, uint records, uint count, const SUN_GLOBAL uint *order, SUN_GLOBAL uint *entries) {
  uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const SUN_GLOBAL uint *word = map_vertices + (size_t)order[i] * records * 16;
  SUN_GLOBAL uint *entry = entries + (size_t)i * SUN_MAP_ENTRY_WORDS;
  for (int axis = 0; axis < 3; axis++) entry[axis] = word[axis];
  entry[3] = order[i];
}

// `starts` has an entry more than there are buckets. Each work-item fills those of the buckets behind its predecessor's, up to its own.
__kernel void map_table(const SUN_GLOBAL uint *keys, uint count, uint table_mask, SUN_GLOBAL uint *starts) {
  uint i = (uint)get_global_id(0);
  if (i > count) return;
  uint last = i < count ? keys[i] : table_mask + 1;
  for (uint bucket = i > 0 ? keys[i - 1] + 1 : 0; bucket <= last; bucket++) starts[bucket] = i;
}

// Exclusive sums of values[at ...], `count` of them, in place, in three launches; sums[blocks] is the sum of all.
__kernel void scan_blocks(const SUN_GLOBAL uint *values, uint at, uint count, SUN_GLOBAL uint *sums) {
  uint block = (uint)get_global_id(0), begin = block * SUN_SCAN_BLOCK;
  if (begin >= count) return;
  uint end = begin + SUN_SCAN_BLOCK < count ? begin + SUN_SCAN_BLOCK : count, sum = 0;
  for (uint i = begin; i < end; i++) sum += values[at + i];
  sums[block] = sum;
}

__kernel void scan_sums(uint count, uint base, SUN_GLOBAL uint *sums) {
  if (get_global_id(0) != 0) return;
  uint blocks = (count + SUN_SCAN_BLOCK - 1) / SUN_SCAN_BLOCK, sum = base;
  for (uint block = 0; block < blocks; block++) {
    uint of_block = sums[block];
    sums[block] = sum;
    sum += of_block;
  }
  sums[blocks] = sum;
}

__kernel void scan_values(SUN_GLOBAL uint *values, uint at, uint count, const SUN_GLOBAL uint *sums) {
  uint block = (uint)get_global_id(0), begin = block * SUN_SCAN_BLOCK;
  if (begin >= count) return;
  uint end = begin + SUN_SCAN_BLOCK < count ? begin + SUN_SCAN_BLOCK : count, sum = sums[block];
  for (uint i = begin; i < end; i++) {
    uint value = values[at + i];
    values[at + i] = sum;
    sum += value;
  }
}
