// SPDX-License-Identifier: Apache-2.0
// compact: dense queues in stable order, without an atomic a path: count, scan, scatter, each work-item owning a chunk of SUN_CHUNK entries.
//   reads    status; a queue
//   writes   the queue's successor; counts; clears the status of paths that have ended, after counting why
//   queues   rays -> rays (live slots first, dead ones behind, and the count of those to refill); rays -> shadow_rays
//   holds    afterwards every slot of the pool stands once in `rays`, and `shadow_rays` names each waiting shadow ray once
#include "shared/frame.h"
#include "shared/options.h"
#include "shared/queues.h"

SUN_FN uint queue_length(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *counts, uint bit) {
  return bit == SUN_STATUS_ALIVE ? frame->pool : counts[SUN_COUNT_LIVE];
}

__kernel void count_chunks(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *queue, SUN_GLOBAL uint *status, SUN_GLOBAL uint *counts,
                           SUN_GLOBAL uint *chunk_counts, uint bit) {
  uint chunk = (uint)get_global_id(0), length = queue_length(frame, counts, bit);
  uint begin = chunk * SUN_CHUNK;
  if (begin >= length) return;
  uint end = begin + SUN_CHUNK < length ? begin + SUN_CHUNK : length;
  uint found = 0, ended[SUN_ENDED_COUNT] = {0, 0, 0, 0}, straight = 0, bounces = 0, shadows = 0;
  for (uint i = begin; i < end; i++) {
    uint slot = queue[i], word = status[slot];
    found += (word & bit) != 0;
    if (bit == SUN_STATUS_SHADOW) shadows += (word & SUN_STATUS_SHADOWS) >> SUN_STATUS_SHADOWS_SHIFT;
    if (bit == SUN_STATUS_ALIVE) {
      uint alive = (word & (SUN_STATUS_ALIVE | SUN_STATUS_AGAIN)) == SUN_STATUS_ALIVE, deep = (word & (SUN_STATUS_DEPTH | SUN_STATUS_LIGHT)) != 0;
      bounces += alive & deep;
      straight += alive & !deep;
      if (word & SUN_STATUS_ENDED) {
        uint depth = word & SUN_STATUS_DEPTH;
        ended[(word >> SUN_STATUS_ENDED_SHIFT) & 3]++;
        atomic_inc(counts + SUN_COUNT_BY_DEPTH + (depth < SUN_COUNT_DEPTHS - 1 ? depth : SUN_COUNT_DEPTHS - 1));
        status[slot] = 0;
      }
    }
  }
  chunk_counts[chunk] = found;
  for (uint reason = 0; reason < SUN_ENDED_COUNT; reason++)
    if (ended[reason]) atomic_add(counts + SUN_COUNT_ENDED + reason, ended[reason]);
  if (straight) atomic_add(counts + SUN_COUNT_RAYS, straight);
  if (bounces) atomic_add(counts + SUN_COUNT_RAYS + 1, bounces);
  if (shadows) atomic_add(counts + SUN_COUNT_RAYS + 2, shadows);
}

// One work-item: chunk counts -> where each chunk's entries begin; then the lengths, and what generate shall fill.
__kernel void scan(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *counts, SUN_GLOBAL uint *chunk_counts, uint bit) {
  if (get_global_id(0) != 0) return;
  uint length = queue_length(frame, counts, bit), sum = 0;
  for (uint chunk = 0; chunk * SUN_CHUNK < length; chunk++) {
    uint found = chunk_counts[chunk];
    chunk_counts[chunk] = sum;
    sum += found;
  }
  if (bit == SUN_STATUS_SHADOW) {
    counts[SUN_COUNT_SHADOW] = sum;
    return;
  }
  uint next = counts[SUN_COUNT_NEXT_PATH], paths = counts[SUN_COUNT_PATHS], left = paths > next ? paths - next : 0, free_slots = frame->pool - sum;
  uint refill = free_slots < left ? free_slots : left;
  counts[SUN_COUNT_REFILL_FIRST] = sum;
  counts[SUN_COUNT_REFILL] = refill;
  counts[SUN_COUNT_REFILL_PATH] = next;
  counts[SUN_COUNT_NEXT_PATH] = next + refill;
  counts[SUN_COUNT_LIVE] = sum + refill;
}

__kernel void scatter_chunks(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *queue, const SUN_GLOBAL uint *status, const SUN_GLOBAL uint *counts,
                             const SUN_GLOBAL uint *chunk_counts, SUN_GLOBAL uint *out, uint bit) {
  uint chunk = (uint)get_global_id(0), length = queue_length(frame, counts, bit);
  uint begin = chunk * SUN_CHUNK;
  if (begin >= length) return;
  uint end = begin + SUN_CHUNK < length ? begin + SUN_CHUNK : length;
  uint keep = chunk_counts[chunk];
  uint rest = counts[SUN_COUNT_REFILL_FIRST] + (begin - keep);  // the dead, behind all that live
  for (uint i = begin; i < end; i++) {
    uint slot = queue[i];
    if (status[slot] & bit) out[keep++] = slot;
    else if (bit == SUN_STATUS_ALIVE) out[rest++] = slot;
  }
}
