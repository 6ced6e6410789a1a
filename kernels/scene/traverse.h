// SPDX-License-Identifier: Apache-2.0
// The two questions of a ray, over the layout that SUN_LAYOUT names: the nearest hit, and whether there is any.
#ifndef SUN_SCENE_TRAVERSE_H
#define SUN_SCENE_TRAVERSE_H
#include "scene/trace_scene.h"  // here, not within a branch: the embedding puts each file in place once, where it is first asked for
#if SUN_LAYOUT == SUN_LAYOUT_BINARY
#include "scene/traverse_binary.h"
#else
#include "scene/traverse_wide.h"
#endif
#include "scene/shape.h"

// Kernels that trace: explicit vectors, from which a vectorizer has to keep its hands off (Intel's scalarizes them otherwise), or scalar code.
#if SUN_LAYOUT == SUN_LAYOUT_BINARY
#define SUN_TRACE_KERNEL SUN_KERNEL
#else
#define SUN_TRACE_KERNEL __kernel __attribute__((vec_type_hint(float16)))
#endif

SUN_NAMESPACE_BEGIN

// Buffers of a Tree, as every kernel that traces takes them.
#define TREE_PARAMETERS                                                                                                             \
  const SUN_GLOBAL uchar *nodes, const SUN_GLOBAL uchar *leaves, const SUN_GLOBAL uint *instance_list, const SUN_GLOBAL uint *roots, \
      uint top_root, const SUN_GLOBAL Fragment *fragments
#define TREE_ARGUMENTS nodes, leaves, instance_list, roots, top_root, fragments

SUN_INLINE TraceScene make_trace_scene(TREE_PARAMETERS, const SUN_GLOBAL Instance *instances, uint instance_count, uint plane_count) {
  TraceScene scene;
  scene.nodes = (const SUN_GLOBAL TraceNode *)nodes;
  scene.leaves = (const SUN_GLOBAL TraceLeaf *)leaves;
  scene.instance_list = instance_list;
  scene.roots = roots;
  scene.fragments = fragments;
  scene.instances = instances;
  scene.motion = (const SUN_GLOBAL Motion *)(instances + instance_count + plane_count);
  scene.top_root = top_root;
  scene.instance_count = instance_count;
  scene.plane_count = plane_count;
  return scene;
}

SUN_INLINE Search begin_search(const Ray *ray, uint want) {
  Search search;
  search.want = want;
  search.passed_t = ray->passed_t > 0.0f ? ray->passed_t : 0.0f;
  search.passed_instance = ray->passed_instance;
  search.passed_primitive = ray->passed_primitive;
  search.best_t = ray->t_max;
  search.best_instance = 0;
  search.best_primitive = 0;
  search.found_instance = SUN_NONE;
  search.u = 0.0f;
  search.v = 0.0f;
  return search;
}

SUN_INLINE int prepare_world_ray(PreparedRay *world, const TraceScene *scene, const Ray *ray) {
  float lower[3], upper[3], reach[3];
  if (scene->instance_count == 1) {
    SUN_UNROLL
    for (int axis = 0; axis < 3; axis++) {
      lower[axis] = scene->instances[0].lower[axis];
      upper[axis] = scene->instances[0].upper[axis];
    }
  } else {
    top_bounds(scene, lower, upper);
  }
  SUN_UNROLL
  for (int axis = 0; axis < 3; axis++) reach[axis] = FIRST_LANE(farther(lower[axis], upper[axis], (real)(ray->origin[axis])));
  return prepare_ray(world, ray->origin, ray->direction, reach);
}

// Carries the ray into an instance's space; t stays the same, so the direction is not normalised. False where the instance cannot be hit.
SUN_INLINE int enter_instance(const TraceScene *scene, uint number, const Ray *ray, const PreparedRay *world, const Search *search,
                              PreparedRay *inside, Place *place) {
  const SUN_GLOBAL Instance *instance = &scene->instances[number];
  *place = place_in_world(number, search);
  if (instance->flags & SUN_INSTANCE_IDENTITY) {
    *inside = *world;
    return 1;
  }
  place->world = box_interval(world, instance->lower[0], instance->lower[1], instance->lower[2], instance->upper[0], instance->upper[1],
                              instance->upper[2], 0.0f);
  // A triangle nearer than the world box is pulled back into it, perhaps to behind what the ray passed; one that is not pulled keeps its own t.
  place->from = search->passed_t > place->world.near ? search->passed_t : 0.0f;
  if (!(place->world.near <= place->world.far)) return 0;
  float origin[3], direction[3], linear[9], reach[3], world_reach[3];
  SUN_UNROLL
  for (int axis = 0; axis < 3; axis++) world_reach[axis] = FIRST_LANE(farther(instance->lower[axis], instance->upper[axis], (real)(ray->origin[axis])));
#if SUN_DEFORMING
  if (instance->flags & SUN_INSTANCE_DEFORMING) {
    place->keys = scene->motion->steps + 1u;
    place->moment = ray_moment(scene->motion, ray->time);
  }
#endif
  to_space(scene->motion, instance, ray, linear, origin, direction);
  SUN_UNROLL
  for (int row = 0; row < 3; row++) {
    const float a = linear[3 * row], b = linear[3 * row + 1], c = linear[3 * row + 2];
    // The mesh lies within its instance's world box, but for the rounding of both matrices.
    reach[row] = 1.0001f * fma(fabs(a), world_reach[0], fma(fabs(b), world_reach[1], fabs(c) * world_reach[2]));
  }
  return prepare_ray(inside, origin, direction, reach);
}

// Searches instance after instance, nearest first: only the first where there is one alone. True where `any` and something counted. `shapes`: 0 leaves them
// out.
SUN_INLINE int search_scene(const TraceScene *scene, const Ray *ray, Search *search, int any_one, int shapes) {
  if (scene->instance_count == 0) return 0;
  const int alone = scene->instance_count == 1, direct = alone && (scene->instances[0].flags & SUN_INSTANCE_IDENTITY);
  PreparedRay inside;  // where one instance is the world, made where it is read: reading a copy of what was just written waits for that
  if (!prepare_world_ray(&inside, scene, ray)) return 0;
  const PreparedRay world = inside;
  Place place = place_in_world(0, search);
  if (SUN_SHAPES && shapes)
    for (uint plane = scene->instance_count; plane < scene->instance_count + scene->plane_count; plane++)
      if (search_shape(scene, plane, ray, &world, search) && any_one) return 1;
  ulong stack[SUN_TRACE_STACK];
  InstanceWalk walk = begin_instances(scene, alone, stack);
  uint number = alone ? 0 : next_instance(scene, &world, search->passed_t, search->best_t, stack, &walk);
  while (number != SUN_NONE) {
    if (SUN_SHAPES && (scene->instances[number].flags & SUN_INSTANCE_SHAPE)) {
      if (shapes && search_shape(scene, number, ray, &world, search) && any_one) return 1;
    } else if (direct || enter_instance(scene, number, ray, &world, search, &inside, &place)) {
      if (search_mesh(scene, scene->roots[number], &inside, &place, search, any_one)) return 1;
    }
    number = alone ? SUN_NONE : next_instance(scene, &world, search->passed_t, search->best_t, stack, &walk);
  }
  return 0;
}

SUN_INLINE Hit hit_of_search(const TraceScene *scene, const Search *search) {
  Hit hit;
  hit.t = search->best_t;
  hit.instance = search->found_instance;
  hit.primitive = search->found_instance == SUN_NONE ? SUN_NONE : search->best_primitive;
  hit.pad[0] = hit.pad[1] = hit.pad[2] = 0;
  if (SUN_SHAPES && hit.instance != SUN_NONE && (scene->instances[hit.instance].flags & SUN_INSTANCE_SHAPE)) {
    hit.u = search->u;
    hit.v = search->v;
    return hit;
  }
  // Rounding may carry the barycentrics out of the triangle, and the sign of a zero is of no use.
  hit.u = search->u > 0.0f ? search->u < 1.0f ? search->u : 1.0f : 0.0f;
  const float rest = 1.0f - hit.u;
  hit.v = search->v > 0.0f ? search->v < rest ? search->v : rest : 0.0f;
  return hit;
}

// The nearest hit: the smallest (t, instance, primitive). Its instance is SUN_NONE, and its t the ray's t_max, where there is none.
SUN_INLINE Hit closest_hit(const TraceScene *scene, Ray ray, uint want) {
  Search search = begin_search(&ray, want);
  search_scene(scene, &ray, &search, 0, 1);
  return hit_of_search(scene, &search);
}

SUN_INLINE int any_hit(const TraceScene *scene, Ray ray, uint want) {
  Search search = begin_search(&ray, want);
  return search_scene(scene, &ray, &search, 1, 1);
}

SUN_NAMESPACE_END
#endif
