// SPDX-License-Identifier: Apache-2.0
// The binary layout: scalar, one box test a child. For GPUs and narrow machines, for the host (compiled as C++), and as the reference of the others.
#ifndef SUN_SCENE_TRAVERSE_BINARY_H
#define SUN_SCENE_TRAVERSE_BINARY_H
#include "scene/trace_scene.h"

SUN_NAMESPACE_BEGIN

#define SUN_TRACE_STACK SUN_BINARY_STACK

// Tests the two children of an inner node: the nearer that is hit, or SUN_NONE; the other one, if hit too, waits on the stack.
SUN_INLINE uint open_node(const TraceScene *scene, uint first, const PreparedRay *ray, float from, float limit, ulong *stack, int *size) {
  const BinaryNode a = scene->nodes[first], b = scene->nodes[first + 1];
  const Interval ta = box_interval(ray, a.lower[0], a.lower[1], a.lower[2], a.upper[0], a.upper[1], a.upper[2], from);
  const Interval tb = box_interval(ray, b.lower[0], b.lower[1], b.lower[2], b.upper[0], b.upper[1], b.upper[2], from);
  const int hit_a = ta.near <= ta.far && ta.near <= limit, hit_b = tb.near <= tb.far && tb.near <= limit;
  if (hit_a && hit_b) {
    const int swap = tb.near < ta.near;
    stack[(*size)++] = swap ? waiting(ta.near, first) : waiting(tb.near, first + 1);
    return swap ? first + 1 : first;
  }
  return hit_a ? first : hit_b ? first + 1 : SUN_NONE;
}

// The mesh below `root`: takes the nearest hit that counts. With `any` the first that counts; true if there is one.
SUN_INLINE int search_mesh(const TraceScene *scene, uint root, const PreparedRay *ray, const Place *place, Search *search, int any) {
  ulong stack[SUN_TRACE_STACK];
  int size = 0;
  uint current = root;
  while (current != SUN_NONE) {
    const uint first = scene->nodes[current].first, count = scene->nodes[current].count;
    if (count == 0) {
      current = open_node(scene, first, ray, place->from, box_limit(place, search), stack, &size);
      if (current != SUN_NONE) continue;
    }
    for (uint i = 0; i < count; i++) {
      const LeafAt leaf = leaf_at(scene->leaves, first, i, place);
      Pierced p;
      float t, u, v;
      uint primitive;
      if (!pierce(leaf, ray, &p)) continue;
      if (!counts(leaf, scene->fragments, ray, place, search, &p, 1, &t, &u, &v, &primitive)) continue;
      if (any) return 1;
      take_hit(search, place, t, u, v, primitive);
    }
    current = pop_node(stack, &size, box_limit(place, search));
  }
  return 0;
}

// The walk over the top tree; its leaves hold runs of the instance list. Its stack is a parameter of its own.
typedef struct InstanceWalk {
  int size;
  uint next, end;  // what is left of the current leaf
} InstanceWalk;

SUN_INLINE InstanceWalk begin_instances(const TraceScene *scene, int alone, ulong *stack) {
  InstanceWalk walk;
  walk.size = alone ? 0 : 1;
  walk.next = walk.end = 0;
  if (!alone) stack[0] = waiting(0.0f, scene->top_root);
  return walk;
}

SUN_INLINE uint next_instance(const TraceScene *scene, const PreparedRay *ray, float from, float limit, ulong *stack, InstanceWalk *walk) {
  while (walk->next == walk->end) {
    uint current = pop_node(stack, &walk->size, limit);
    while (current != SUN_NONE && scene->nodes[current].count == 0)
      current = open_node(scene, scene->nodes[current].first, ray, from, limit, stack, &walk->size);
    if (current == SUN_NONE) {
      if (walk->size == 0) return SUN_NONE;
      continue;
    }
    walk->next = scene->nodes[current].first;
    walk->end = walk->next + scene->nodes[current].count;
  }
  return scene->instance_list[walk->next++];
}

// The box around all instances, where there are several.
SUN_INLINE void top_bounds(const TraceScene *scene, float *lower, float *upper) {
  const BinaryNode root = scene->nodes[scene->top_root];
  SUN_UNROLL
  for (int axis = 0; axis < 3; axis++) {
    lower[axis] = root.lower[axis];
    upper[axis] = root.upper[axis];
  }
}

SUN_NAMESPACE_END
#endif
