// SPDX-License-Identifier: Apache-2.0
// branch: a slot whose ray's way has ended goes back to the last vertex that has children to come; runs only where vertices branch.
//   reads    status; the slot's stack (transport/branch.h)
//   writes   every column of the path; hits; status; counts what ended
//   queues   rays
//   holds    afterwards a slot that has ended has an empty stack; one that goes back carries its vertex's hit, which shade reads anew for the next child
//   source   the tree of rays of [Whitted80], walked depth first
#include "path/film.h"
#include "path/queue.h"
#include "transport/branch.h"

SUN_BODY void branch_bundle(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status, SUN_GLOBAL Hit *hits,
                            const SUN_GLOBAL uint *branches, const SUN_GLOBAL uint *rays, FilmCounts counts, uint first) {
  uint_n word;
  QueueLanes lanes = queue_lanes_with(rays, first, counts[SUN_COUNT_LIVE], status, SUN_STATUS_ENDED, SUN_STATUS_ENDED, &word);
  if (!ANY(lanes.active)) return;
  BranchState state = load_branch_state(frame, branches, lanes.slot);
  mask back = lanes.active & (state.height > (uint_n)(0));
  if (!ANY(back)) return;
  BranchVertex v = load_branch_vertex(frame, branches, lanes.slot, back, state.height - (uint_n)(1));
  Paths paths = open_paths(frame, path_words);
  path_store(&paths, lanes.slot, back, &v.path);
  uint slot[LANES], instance[LANES], primitive[LANES], words[LANES], depth[LANES];
  int on[LANES];
  float t[LANES], u[LANES], w[LANES];
  LANES_STORE(lanes.slot, slot);
  LANES_STORE(back, on);
  LANES_STORE(v.hit.t, t);
  LANES_STORE(v.hit.u, u);
  LANES_STORE(v.hit.v, w);
  LANES_STORE(v.hit.instance, instance);
  LANES_STORE(v.hit.primitive, primitive);
  LANES_STORE(word, words);
  LANES_STORE(v.word, depth);
  for (int lane = 0; lane < LANES; lane++) {
    if (!on[lane]) continue;
    SUN_GLOBAL Hit *hit = hits + slot[lane];
    hit->t = t[lane];
    hit->u = u[lane];
    hit->v = w[lane];
    hit->instance = instance[lane];
    hit->primitive = primitive[lane];
    // What compact counts of paths that are not taken up again.
    uint end = words[lane] & SUN_STATUS_DEPTH, begin = depth[lane];
    film_count(counts, SUN_COUNT_ENDED + ((words[lane] >> SUN_STATUS_ENDED_SHIFT) & 3));
    film_count(counts, SUN_COUNT_BY_DEPTH + (end < SUN_COUNT_DEPTHS - 1 ? end : SUN_COUNT_DEPTHS - 1));
    film_count(counts, SUN_COUNT_BRANCHED + (begin < SUN_COUNT_DEPTHS - 1 ? begin : SUN_COUNT_DEPTHS - 1));
  }
  uint_n again = (uint_n)(SUN_STATUS_ALIVE | SUN_STATUS_AGAIN) | v.word | (word & (uint_n)(SUN_STATUS_FIRST_HIT));
  store_uint(status, lanes.slot, back, again);
}

SUN_KERNEL void branch(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status, SUN_GLOBAL Hit *hits,
                       const SUN_GLOBAL uint *branches, const SUN_GLOBAL uint *rays, FilmCounts counts) {
  branch_bundle(frame, path_words, status, hits, branches, rays, counts, (uint)get_global_id(0) * LANES);
}
