// SPDX-License-Identifier: Apache-2.0
// first_hit: layers of what the camera sees first; runs only where they are asked for.
//   reads    hits; every column of the path; status
//   writes   film; the first-hit bit of the status
//   queues   rays
//   holds    each path adds to these layers once at most: at the first surface that its alpha coin finds there
#include "path/queue.h"
#include "transport/layers.h"

SUN_BODY void first_hit_bundle(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status,
                               const SUN_GLOBAL Hit *hits, const SUN_GLOBAL uint *rays, FilmCounts counts, FilmWords film_words, uint first) {
  uint_n word;
  QueueLanes lanes = queue_lanes_with(rays, first, counts[SUN_COUNT_LIVE], status, SUN_STATUS_ALIVE | SUN_STATUS_DEPTH | SUN_STATUS_FIRST_HIT | SUN_STATUS_LIGHT, SUN_STATUS_ALIVE, &word);
  if (!ANY(lanes.active)) return;
  Scene opened = open_scene(frame, SCENE_ARGUMENTS);
  const Scene *scene = &opened;
  FilmView film = open_film(frame, film_words, counts);
  Paths paths = open_paths(frame, path_words);
  Path path = path_load(&paths, lanes.slot);
  HitLanes hit = load_hits(hits, lanes.slot, lanes.active);
  if (!ANY(hit.hit)) return;
  SamplerKey key = path_key(frame, &path);
  at_moment(&opened, &key);
  vec3 wo = negate3(path_direction(&path));
  mask present = first_hit_layers(scene, &film, &path, &hit, wo, path.throughput_r);
  store_uint(status, lanes.slot, present, word | (uint_n)(SUN_STATUS_FIRST_HIT));
}

SUN_KERNEL void first_hit(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status,
                          const SUN_GLOBAL Hit *hits, const SUN_GLOBAL uint *rays, FilmCounts counts, FilmWords film_words) {
  first_hit_bundle(frame, SCENE_ARGUMENTS, path_words, status, hits, rays, counts, film_words, (uint)get_global_id(0) * LANES);
}
