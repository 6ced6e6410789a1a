// SPDX-License-Identifier: Apache-2.0
// The two questions of a ray for LANES rays at once. Shapes, where they are few, are asked one after the other, each for all the rays; triangles are found
// by the tree, a lane at a time. (Few shapes are those of a scene that is still: pipeline/stages.cpp.) A hit is the least key, so it does not matter which are asked first.
#ifndef SUN_SCENE_TRACE_LANES_H
#define SUN_SCENE_TRACE_LANES_H
#include "shared/queues.h"
#include "scene/surface.h"
#include "scene/traverse.h"

SUN_NAMESPACE_BEGIN

// As Ray.
typedef struct Rays {
  vec3 origin, direction;
  real t_max, passed_t;
  uint_n passed_instance, passed_primitive;
  real time;
} Rays;

// Rays that have passed nothing.
SUN_FN Rays fresh_rays(vec3 origin, vec3 direction, real t_max, real time) {
  Rays rays;
  rays.origin = origin;
  rays.direction = direction;
  rays.t_max = t_max;
  rays.time = time;
  rays.passed_t = (real)(0.0f);
  rays.passed_instance = rays.passed_primitive = (uint_n)(SUN_NONE);
  return rays;
}

// Is anything left for the tree?
#define SUN_BY_TREE (SUN_TRIANGLES || !SUN_FEW_SHAPES)

// The same in memory, for the tree.
typedef struct RayLanes {
  float origin[3][LANES], direction[3][LANES], t_max[LANES], passed_t[LANES], time[LANES];
  uint passed_instance[LANES], passed_primitive[LANES];
  int on[LANES];
} RayLanes;

SUN_INLINE Ray lane_ray(const RayLanes *rays, int lane) {
  Ray ray;
  for (int axis = 0; axis < 3; axis++) {
    ray.origin[axis] = rays->origin[axis][lane];
    ray.direction[axis] = rays->direction[axis][lane];
  }
  ray.t_max = rays->t_max[lane];
  ray.passed_t = rays->passed_t[lane];
  ray.passed_instance = rays->passed_instance[lane];
  ray.passed_primitive = rays->passed_primitive[lane];
  ray.time = SUN_MOTION ? rays->time[lane] : 0.0f;
  return ray;
}

SUN_INLINE void store_rays(RayLanes *lanes, const Rays *rays, mask on) {
  int_n flags = on ? (int_n)(1) : (int_n)(0);
  LANES_STORE(rays->origin.x, lanes->origin[0]);
  LANES_STORE(rays->origin.y, lanes->origin[1]);
  LANES_STORE(rays->origin.z, lanes->origin[2]);
  LANES_STORE(rays->direction.x, lanes->direction[0]);
  LANES_STORE(rays->direction.y, lanes->direction[1]);
  LANES_STORE(rays->direction.z, lanes->direction[2]);
  LANES_STORE(rays->t_max, lanes->t_max);
  LANES_STORE(rays->passed_t, lanes->passed_t);
  LANES_STORE(rays->passed_instance, lanes->passed_instance);
  LANES_STORE(rays->passed_primitive, lanes->passed_primitive);
  if (SUN_MOTION) LANES_STORE(rays->time, lanes->time);
  LANES_STORE(flags, lanes->on);
}

// Nearest hits among triangles (and shapes, where they are many), of lanes that are on; `hit` has the best so far where hit.hit.
SUN_BODY void closest_by_tree(const TraceScene *tree, const Rays *rays, mask on, uint want, HitLanes *hit) {
  RayLanes lanes;
  store_rays(&lanes, rays, on);
  int known[LANES];
  float t[LANES], u[LANES], v[LANES];
  uint instance[LANES], primitive[LANES];
  int_n flags = hit->hit ? (int_n)(1) : (int_n)(0);
  LANES_STORE(flags, known);
  LANES_STORE(hit->t, t);
  LANES_STORE(hit->u, u);
  LANES_STORE(hit->v, v);
  LANES_STORE(hit->instance, instance);
  LANES_STORE(hit->primitive, primitive);
  for (int lane = 0; lane < LANES; lane++) {
    if (!lanes.on[lane]) continue;
    const Ray ray = lane_ray(&lanes, lane);
    Search search = begin_search(&ray, want);
    if (known[lane]) {
      search.best_t = t[lane];
      search.best_instance = instance[lane];
      search.best_primitive = primitive[lane];
    }
    search_scene(tree, &ray, &search, 0, !SUN_FEW_SHAPES);
    if (search.found_instance == SUN_NONE) continue;
    const Hit found = hit_of_search(tree, &search);
    known[lane] = 1;
    t[lane] = found.t;
    u[lane] = found.u;
    v[lane] = found.v;
    instance[lane] = found.instance;
    primitive[lane] = found.primitive;
  }
  flags = LANES_LOAD(known);
  hit->hit = flags != (int_n)(0);
  hit->t = LANES_LOAD(t);
  hit->u = LANES_LOAD(u);
  hit->v = LANES_LOAD(v);
  hit->instance = LANES_LOAD(instance);
  hit->primitive = LANES_LOAD(primitive);
}

SUN_BODY mask blocked_by_tree(const TraceScene *tree, const Rays *rays, mask on, uint want) {
  RayLanes lanes;
  store_rays(&lanes, rays, on);
  int blocked[LANES];
  for (int lane = 0; lane < LANES; lane++) {
    blocked[lane] = 0;
    if (!lanes.on[lane]) continue;
    const Ray ray = lane_ray(&lanes, lane);
    Search search = begin_search(&ray, want);
    blocked[lane] = search_scene(tree, &ray, &search, 1, !SUN_FEW_SHAPES);
  }
  int_n some = LANES_LOAD(blocked);
  return some != (int_n)(0);
}

// At t == passed_t hits in this instance count from this number on; see place_in_world.
SUN_INLINE uint_n first_primitive_in(uint number, const Rays *rays) {
  const uint_n passed = rays->passed_primitive;
  const uint_n next = passed >= (uint_n)(SUN_ID_PRIMITIVE) ? (uint_n)(SUN_NONE) : passed + (uint_n)(1);
  return (uint_n)(number) > rays->passed_instance ? (uint_n)(0) : (uint_n)(number) < rays->passed_instance ? (uint_n)(SUN_NONE) : next;
}

SUN_INLINE ShapeRays shape_rays(const SUN_GLOBAL Frame *frame, const Rays *rays) {
  ShapeRays all;
  all.origin = rays->origin;
  all.direction = rays->direction;
  all.t_max = rays->t_max;
  all.lower = frame->lower;
  all.upper = frame->upper;
  all.ready = 0;
  return all;
}

// The same among shapes alone.
SUN_FN HitLanes closest_shapes(const SUN_GLOBAL Frame *frame, const TraceScene *tree, const Rays *rays, mask on, uint want) {
  HitLanes hit;
  hit.hit = on & !on;
  hit.instance = hit.primitive = (uint_n)(0);
  ShapeRays ray = shape_rays(frame, rays);
  ShapeSearch search;
  search.passed_t = max_real(rays->passed_t, (real)(0.0f));
  search.best_t = rays->t_max;
  search.end_primitive = (uint_n)(0);  // instances come in order, so of equals the first stays
  vec3 place = splat3((real)(0.0f));
  mask sphere = hit.hit;
  const uint end = frame->instance_count + frame->plane_count;
  for (uint number = frame->first_shape; number < end; number++) {
    const SUN_GLOBAL Instance *instance = &tree->instances[number];
    if (shape_unwanted(instance->flags, want)) continue;
    const uint primitive = tree->roots[number];
    search.first_primitive = first_primitive_in(number, rays);
    vec3 origin, direction;
    rays_in_shape(instance, &ray, &origin, &direction);
    const ShapeHit met = meet_shape(instance, primitive, origin, direction, &ray, &search, on, 0);
    if (!ANY(met.counts)) continue;
    search.best_t = met.counts ? met.t : search.best_t;
    place = select3(met.counts, met.place, place);
    hit.instance = met.counts ? (uint_n)(number) : hit.instance;
    hit.primitive = met.counts ? (uint_n)(primitive) : hit.primitive;
    hit.hit = hit.hit | met.counts;
    sphere = instance->flags & SUN_INSTANCE_SPHERE ? sphere | met.counts : sphere & !met.counts;
  }
  const vec2 code = place_code(sphere, place);
  hit.t = search.best_t;
  hit.u = code.x;
  hit.v = code.y;
  return hit;
}

SUN_FN mask blocked_by_shapes(const SUN_GLOBAL Frame *frame, const TraceScene *tree, const Rays *rays, mask on, uint want) {
  mask blocked = on & !on;
  ShapeRays ray = shape_rays(frame, rays);
  ShapeSearch search;
  search.passed_t = max_real(rays->passed_t, (real)(0.0f));
  search.best_t = rays->t_max;
  search.end_primitive = (uint_n)(0);
  const uint end = frame->instance_count + frame->plane_count;
  for (uint number = frame->first_shape; number < end && ANY(on); number++) {
    const SUN_GLOBAL Instance *instance = &tree->instances[number];
    if (shape_unwanted(instance->flags, want)) continue;
    search.first_primitive = first_primitive_in(number, rays);
    vec3 origin, direction;
    rays_in_shape(instance, &ray, &origin, &direction);
    const ShapeHit met = meet_shape(instance, tree->roots[number], origin, direction, &ray, &search, on, 0);
    blocked = blocked | met.counts;
    on = on & !met.counts;
  }
  return blocked;
}

// The nearest hits of the lanes that are on. Those without one carry instance 0 and primitive 0.
SUN_FN HitLanes closest_lanes(const SUN_GLOBAL Frame *frame, const TraceScene *tree, const Rays *rays, mask on, uint want) {
  HitLanes hit;
  if (SUN_FEW_SHAPES) {
    hit = closest_shapes(frame, tree, rays, on, want);
  } else {
    hit.hit = on & !on;
    hit.t = rays->t_max;
    hit.u = hit.v = (real)(0.0f);
    hit.instance = hit.primitive = (uint_n)(0);
  }
  if (SUN_BY_TREE) closest_by_tree(tree, rays, on, want, &hit);
  return hit;
}

// Lanes that are on and whose ray something meets.
SUN_FN mask blocked_lanes(const SUN_GLOBAL Frame *frame, const TraceScene *tree, const Rays *rays, mask on, uint want) {
  mask blocked = on & !on;
  if (SUN_FEW_SHAPES) blocked = blocked_by_shapes(frame, tree, rays, on, want);
  if (SUN_BY_TREE) blocked = blocked | blocked_by_tree(tree, rays, on & !blocked, want);
  return blocked;
}

SUN_NAMESPACE_END
#endif
