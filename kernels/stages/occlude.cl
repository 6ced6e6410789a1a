// SPDX-License-Identifier: Apache-2.0
// occlude: shadow rays -> what of their contribution arrives -> film. One ray a work-item; LANES is 1 here.
//   reads    shadow rays, from the `first` on: a vertex that sends several has one in each part of the pool's size; the tree; materials of what a ray may pass
//   writes   film
//   queues   shadow_rays
//   holds    transmittance is multiplied nearest first, so its bits do not depend on the tree
#include "path/contribute.h"
#include "scene/traverse.h"
#include "transport/pass.h"

SUN_BODY void occlude_ray(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, SCENE_PARAMETERS, const SUN_GLOBAL ShadowRay *shadow_rays,
                          const SUN_GLOBAL uint *queue, FilmCounts counts, FilmWords film_words, uint first, uint position) {
  if (position >= counts[SUN_COUNT_SHADOW]) return;
  const SUN_GLOBAL ShadowRay *shadow = shadow_rays + first + queue[position];
  if (position + SUN_AHEAD < counts[SUN_COUNT_SHADOW]) SUN_SOON(shadow_rays + first + queue[position + SUN_AHEAD]);
  TraceScene tree = make_trace_scene(TREE_ARGUMENTS, instances, frame->instance_count, frame->plane_count);
  const float4 from = vload4(0, shadow->origin), along = vload4(0, shadow->direction);  // with the word behind: see intersect.cl
  Ray ray;
  ray.origin[0] = from.x;
  ray.origin[1] = from.y;
  ray.origin[2] = from.z;
  ray.direction[0] = along.x;
  ray.direction[1] = along.y;
  ray.direction[2] = along.z;
  ray.t_max = from.w;
  if (ray.t_max < 0.0f) return;
  ray.passed_t = 0.0f;
  ray.passed_instance = ray.passed_primitive = SUN_NONE;
  ray.time = shadow->time;
  if (any_hit(&tree, ray, SUN_WANT_OPAQUE)) return;
  vec3 worth = make_vec3(shadow->contribution[0], shadow->contribution[1], shadow->contribution[2]);
#if SUN_PASSABLE
  Scene scene = open_scene(frame, SCENE_ARGUMENTS);
  scene.moment = moment_of(frame, ray.time);
  vec3 wo = normalize3(make_vec3(-ray.direction[0], -ray.direction[1], -ray.direction[2]));
  for (;;) {
    Hit hit = closest_hit(&tree, ray, SUN_WANT_PASSABLE);
    if (hit.instance == SUN_NONE) break;
    HitLanes lane = {hit.t, hit.u, hit.v, hit.instance, hit.primitive, 1};
    worth = mul3(worth, passed_share(&scene, &lane, wo));
    if (max_of3(make_vec3(fabs(worth.x), fabs(worth.y), fabs(worth.z))) == 0.0f) return;
    ray.passed_t = hit.t;
    ray.passed_instance = hit.instance;
    ray.passed_primitive = hit.primitive;
  }
#endif
  FilmView film = open_film(frame, film_words, counts);
  film_contribute(frame, &film, shadow->pixel, shadow->sample, SUN_FILM_KEY_DIRECT(shadow->vertex, shadow->number), shadow->depth, worth.x, worth.y, worth.z);
}

SUN_TRACE_KERNEL void occlude(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, SCENE_PARAMETERS, const SUN_GLOBAL ShadowRay *shadow_rays,
                              const SUN_GLOBAL uint *queue, FilmCounts counts, FilmWords film_words, uint first) {
  occlude_ray(frame, TREE_ARGUMENTS, SCENE_ARGUMENTS, shadow_rays, queue, counts, film_words, first, (uint)get_global_id(0));
}
