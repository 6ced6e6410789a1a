// SPDX-License-Identifier: Apache-2.0
// roulette: ends dim paths without bias.
//   reads    throughput, pixel, sample, vertex; status
//   writes   throughput; status
//   queues   rays -> rays (by the alive bit of the status)
//   holds    the expected throughput of a path is what it was
//   source   [Arvo90]; a fixed chance, as the lecture has it, where absorption is not negative
#include "path/path.h"
#include "path/queue.h"
#include "shared/frame.h"
#if SUN_BRANCHING
#include "transport/branch.h"
#endif

#define SUN_ROULETTE_LEAST 0.05f  // chance to survive, at the dimmest

SUN_BODY void roulette_bundle(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status, const SUN_GLOBAL uint *branches,
                              const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts, uint first) {
  uint_n word;
  QueueLanes lanes = queue_lanes_with(rays, first, counts[SUN_COUNT_LIVE], status, SUN_STATUS_ALIVE, SUN_STATUS_ALIVE, &word);
  uint_n depth = word & (uint_n)(SUN_STATUS_DEPTH);
  mask fixed = frame->absorption >= 0.0f ? lanes.active : lanes.active & !lanes.active;
  uint first_depth = frame->absorption >= 0.0f ? 1u : frame->roulette_depth;
  mask active = lanes.active & (depth >= (uint_n)(first_depth));
  if (!ANY(active)) return;
  Paths paths = open_paths(frame, path_words);
  Path path = path_load(&paths, lanes.slot);
  real brightest = max_real(max_real(fabs(path.throughput_r), fabs(path.throughput_g)), fabs(path.throughput_b));
  // A fixed chance is taken once a scattering: not where the ray went straight on.
  active = active & (fixed ? path.passed_instance == (uint_n)(SUN_NONE) : brightest < 1.0f);
  if (!ANY(active)) return;
  real survival = fixed ? (real)(1.0f - frame->absorption) : max_real(brightest, (real)(SUN_ROULETTE_LEAST));
  SamplerKey key = path_key(frame, &path);
#if SUN_BRANCHING
  key = branch_key(key, load_branch_state(frame, branches, lanes.slot).branch);
#else
  (void)branches;
#endif
  // Of the vertex that shade has just left.
  real u = sample_2d(&key, SUN_DIM_EMITTER(path.vertex - (uint_n)(1))).y;
  mask dies = active & (u >= survival);
  mask lives = active & !dies;
  path.throughput_r = path.throughput_r / survival;
  path.throughput_g = path.throughput_g / survival;
  path.throughput_b = path.throughput_b / survival;
  path_store(&paths, lanes.slot, lives, &path);
  uint_n ended = (word & (uint_n)(SUN_STATUS_DEPTH | SUN_STATUS_SHADOW | SUN_STATUS_SHADOWS | SUN_STATUS_FIRST_HIT)) |
                 (uint_n)(SUN_STATUS_ENDED | (SUN_ENDED_ABSORBED << SUN_STATUS_ENDED_SHIFT));
  // A light subpath that ends here leaves the sample its eye subpath, where there is one.
  mask light = (word & (uint_n)(SUN_STATUS_LIGHT)) != (uint_n)(0);
  ended = light ? (uint_n)((frame->flags & SUN_FRAME_LIGHT_PASS) ? 0u : SUN_STATUS_ALIVE | SUN_STATUS_TURN) : ended;
  store_uint(status, lanes.slot, dies, ended);
}

SUN_KERNEL void roulette(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status, const SUN_GLOBAL uint *branches,
                         const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts) {
  roulette_bundle(frame, path_words, status, branches, rays, counts, (uint)get_global_id(0) * LANES);
}
