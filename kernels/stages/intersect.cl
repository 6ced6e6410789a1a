// SPDX-License-Identifier: Apache-2.0
// intersect: rays -> nearest hits. One ray a work-item; LANES is 1 here, the layout brings vectors of its own.
//   reads    origin, direction, passed_*; status; the tree
//   writes   hits, by slot
//   queues   rays
//   holds    afterwards, but where a vertex is taken up again with the hit it had, each live slot's hit is the smallest (t, instance, primitive) behind what its ray passed, or a miss
#include "path/path.h"
#include "scene/moment.h"
#include "scene/traverse.h"
#include "shared/frame.h"

// The ray of one path. Words that stand together are loaded together: piecemeal, compilers keep them in memory and reload them in
// pairs, which waits for the stores.
SUN_INLINE Ray path_ray(const SUN_GLOBAL Frame *frame, const Paths *paths, uint slot) {
  uint word[16];
#if SUN_COLUMNS
  for (uint field = 0; field < (SUN_MOTION ? 16 : 12); field++) word[field] = paths->words[path_word(paths, slot, field)];
#else
  const SUN_GLOBAL uint *record = paths->words + path_word(paths, slot, 0);
  vstore4(vload4(0, record), 0, word);
  vstore4(vload4(1, record), 1, word);
  vstore4(vload4(2, record), 2, word);
  if (SUN_MOTION) vstore4(vload4(3, record), 3, word);
#endif
  Ray ray;
  ray.origin[0] = as_float(word[SUN_PATH_origin_x]);
  ray.origin[1] = as_float(word[SUN_PATH_origin_y]);
  ray.origin[2] = as_float(word[SUN_PATH_origin_z]);
  ray.direction[0] = as_float(word[SUN_PATH_direction_x]);
  ray.direction[1] = as_float(word[SUN_PATH_direction_y]);
  ray.direction[2] = as_float(word[SUN_PATH_direction_z]);
  ray.t_max = SUN_INFINITY;
  ray.passed_t = as_float(word[SUN_PATH_passed_t]);
  ray.passed_instance = word[SUN_PATH_passed_instance];
  ray.passed_primitive = word[SUN_PATH_passed_primitive];
  ray.time = 0.0f;
#if SUN_MOTION
  const SamplerKey key = pixel_key(frame, word[SUN_PATH_pixel], word[SUN_PATH_sample]);
  ray.time = sample_moment(frame, &key).time;
#else
  (void)frame;
#endif
  return ray;
}

SUN_BODY void intersect_ray(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, const SUN_GLOBAL Instance *instances, const SUN_GLOBAL uint *path_words,
                            const SUN_GLOBAL uint *status, SUN_GLOBAL Hit *hits, const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts,
                            uint position) {
  if (position >= counts[SUN_COUNT_LIVE]) return;
  uint slot = rays[position];
  if (position + SUN_AHEAD < counts[SUN_COUNT_LIVE]) SUN_SOON(path_words + (size_t)rays[position + SUN_AHEAD] * SUN_PATH_WORDS);
  const uint word = status[slot];
  if ((word & (SUN_STATUS_ALIVE | SUN_STATUS_AGAIN)) != SUN_STATUS_ALIVE) return;
  TraceScene scene = make_trace_scene(TREE_ARGUMENTS, instances, frame->instance_count, frame->plane_count);
  Paths paths = open_paths(frame, (SUN_GLOBAL uint *)path_words);
  Ray ray = path_ray(frame, &paths, slot);
  hits[slot] = closest_hit(&scene, ray, SUN_BIDIRECTIONAL && (word & SUN_STATUS_LIGHT) ? SUN_WANT_BOTH_SIDES : SUN_WANT_ALL);
}

SUN_TRACE_KERNEL void intersect(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, const SUN_GLOBAL Instance *instances,
                                const SUN_GLOBAL uint *path_words, const SUN_GLOBAL uint *status, SUN_GLOBAL Hit *hits,
                                const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts) {
  intersect_ray(frame, TREE_ARGUMENTS, instances, path_words, status, hits, rays, counts, (uint)get_global_id(0));
}
