// SPDX-License-Identifier: Apache-2.0
// intersect: rays -> nearest hits. One ray a work-item; LANES is 1 here, the layout brings vectors of its own.
//   reads    origin, direction, passed_*; status; the tree
//   writes   hits, by slot
//   queues   rays
//   holds    afterwards each live slot's hit is the smallest (t, instance, primitive) behind what its ray passed, or a miss
#include "path/path.h"
#include "scene/traverse.h"
#include "shared/frame.h"

SUN_BODY void intersect_ray(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, const SUN_GLOBAL Instance *instances, const SUN_GLOBAL uint *path_words,
                            const SUN_GLOBAL uint *status, SUN_GLOBAL Hit *hits, const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts,
                            uint position) {
  if (position >= counts[SUN_COUNT_LIVE]) return;
  uint slot = rays[position];
  if (position + SUN_AHEAD < counts[SUN_COUNT_LIVE]) SUN_SOON(path_words + (size_t)rays[position + SUN_AHEAD] * SUN_PATH_WORDS);
  if (!(status[slot] & SUN_STATUS_ALIVE)) return;
  TraceScene scene = make_trace_scene(TREE_ARGUMENTS, instances, frame->instance_count);
  Paths paths;
  paths.words = (SUN_GLOBAL uint *)path_words;
  paths.pool = frame->pool;
  Ray ray;
  for (uint axis = 0; axis < 3; axis++) {
    ray.origin[axis] = as_float(path_words[path_word(&paths, slot, SUN_PATH_origin_x + axis)]);
    ray.direction[axis] = as_float(path_words[path_word(&paths, slot, SUN_PATH_direction_x + axis)]);
  }
  ray.t_max = SUN_INFINITY;
  ray.passed_t = as_float(path_words[path_word(&paths, slot, SUN_PATH_passed_t)]);
  ray.passed_instance = path_words[path_word(&paths, slot, SUN_PATH_passed_instance)];
  ray.passed_primitive = path_words[path_word(&paths, slot, SUN_PATH_passed_primitive)];
  hits[slot] = closest_hit(&scene, ray, SUN_WANT_ALL);
}

SUN_TRACE_KERNEL void intersect(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, const SUN_GLOBAL Instance *instances,
                                const SUN_GLOBAL uint *path_words, const SUN_GLOBAL uint *status, SUN_GLOBAL Hit *hits,
                                const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts) {
  intersect_ray(frame, TREE_ARGUMENTS, instances, path_words, status, hits, rays, counts, (uint)get_global_id(0));
}
