// SPDX-License-Identifier: Apache-2.0
// first_hit: layers of what the camera sees first; runs only where they are asked for.
//   reads    hits; every column of the path; status
//   writes   film; the first-hit bit of the status
//   queues   rays
//   holds    each path adds to these layers once at most: at the first surface that its alpha coin finds there
#include "path/contribute.h"
#include "path/path.h"
#include "path/queue.h"
#include "scene/surface.h"
#include "math/sampler.h"

// LANES values of one layer.
SUN_FN void layer_add(const FilmView *film, uint layer, mask active, const Path *path, uint_n pixel_hash, vec3 value) {
  if (layer != SUN_NONE) film_add_lanes(film, active, (uint_n)(layer), path->pixel, pixel_hash, path->sample, (uint_n)(SUN_FILM_KEY_LAYER(layer)), value);
}

SUN_BODY void first_hit_bundle(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status,
                               const SUN_GLOBAL Hit *hits, const SUN_GLOBAL uint *rays, FilmCounts counts, FilmWords film_words, uint first) {
  uint length = counts[SUN_COUNT_LIVE];
  if (first >= length) return;
  QueueLanes lanes = queue_lanes(rays, first, length);
  uint_n word = gather_uint(status, lanes.slot);
  uint_n done = (uint_n)(SUN_STATUS_DEPTH | SUN_STATUS_FIRST_HIT | SUN_STATUS_LIGHT);
  mask active = lanes.active & ((word & (uint_n)(SUN_STATUS_ALIVE)) != (uint_n)(0)) & ((word & done) == (uint_n)(0));
  if (!ANY(active)) return;
  Scene opened = open_scene(frame, SCENE_ARGUMENTS);
  const Scene *scene = &opened;
  FilmView film = open_film(frame, film_words, counts);
  Paths paths;
  paths.words = path_words;
  paths.pool = frame->pool;
  Path path = path_load(&paths, lanes.slot);
  HitLanes hit = load_hits(hits, lanes.slot, active);
  if (!ANY(hit.hit)) return;
  vec3 wo = make_vec3(-path.direction_x, -path.direction_y, -path.direction_z);
  Surface surface = make_surface(scene, &hit, wo);
  uint_n y = path.pixel / (uint_n)(frame->tile_width);
  uint_n x = path.pixel - y * (uint_n)(frame->tile_width);
  SamplerKey key = sampler_key(frame->seed, x + (uint_n)(frame->tile_x0), y + (uint_n)(frame->tile_y0), path.sample, frame->sampler);
  real alpha = surface_alpha(scene, &surface, hit.hit);
  mask absent = (alpha < 1.0f) & (alpha <= hash_coin(&key, path.vertex, hit.instance, hit.primitive, 0));
  mask present = hit.hit & !absent;
  if (!ANY(present)) return;

  Bsdf bsdf = surface_bsdf(scene, &surface, present);
  vec3 wo_local = to_local(&surface.shading, wo);
  // The filter's weight belongs to every layer that is averaged.
  real weight = path.throughput_r;
  if (frame->layer_albedo != SUN_NONE) layer_add(&film, frame->layer_albedo, present, &path, key.pixel_hash, scale3(bsdf_albedo(&bsdf, scene->tables, wo_local), weight));
  layer_add(&film, frame->layer_normal, present, &path, key.pixel_hash, scale3(surface.shading.normal, weight));
  // Along the camera's axis, as compositors expect of Z.
  vec3 eye = make_vec3((real)(frame->camera.position[0]), (real)(frame->camera.position[1]), (real)(frame->camera.position[2]));
  vec3 forward = make_vec3((real)(frame->camera.forward[0]), (real)(frame->camera.forward[1]), (real)(frame->camera.forward[2]));
  layer_add(&film, frame->layer_depth, present, &path, key.pixel_hash, splat3(dot3(sub3(surface.position, eye), forward) * weight));
  layer_add(&film, frame->layer_position, present, &path, key.pixel_hash, scale3(surface.position, weight));
  layer_add(&film, frame->layer_alpha, present, &path, key.pixel_hash, splat3(weight));
  // Numbers cannot be averaged: they are those of sample 0, counted from 1, so that 0 is nothing. Objects are the scene's instances.
  mask leading = present & (path.sample == (uint_n)(0));
  if (frame->layer_object != SUN_NONE) {
    uint_n object = gather_uint(scene->instance_object, hit.instance) + gather_uint(scene->triangle_object, hit.primitive);
    layer_add(&film, frame->layer_object, leading, &path, key.pixel_hash, splat3(real_of_uint(object)));
  }
  layer_add(&film, frame->layer_material, leading, &path, key.pixel_hash, splat3(real_of_uint(surface.material + (uint_n)(1))));
  store_uint(status, lanes.slot, present, word | (uint_n)(SUN_STATUS_FIRST_HIT));
}

SUN_KERNEL void first_hit(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status,
                          const SUN_GLOBAL Hit *hits, const SUN_GLOBAL uint *rays, FilmCounts counts, FilmWords film_words) {
  first_hit_bundle(frame, SCENE_ARGUMENTS, path_words, status, hits, rays, counts, film_words, (uint)get_global_id(0) * LANES);
}
