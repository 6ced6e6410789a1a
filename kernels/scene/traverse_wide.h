// SPDX-License-Identifier: Apache-2.0
// The wide layouts for CPUs: explicit vectors over the 8 or 16 children of a node and the 8 triangles of a pack, one ray per work-item.
#ifndef SUN_SCENE_TRAVERSE_WIDE_H
#define SUN_SCENE_TRAVERSE_WIDE_H
#include "scene/trace_scene.h"

#if SUN_LAYOUT == SUN_LAYOUT_WIDE16
#define SUN_WIDTH 16
typedef float16 node_float;
typedef int16 node_int;
#define NODE_PLANE(node, k) vload16(0, (node)->plane[k])
#define NODE_STORE(v, array) vstore16((v), 0, (array))
#else
#define SUN_WIDTH 8
typedef float8 node_float;
typedef int8 node_int;
#define NODE_PLANE(node, k) vload8(0, (node)->plane[k])
#define NODE_STORE(v, array) vstore8((v), 0, (array))
#endif

typedef struct LaneSet {
  ulong low, high;
} LaneSet;
SUN_INLINE float least_of8(float8 b) {
  const float4 c = SUN_LESSER(b.lo, b.hi);
  const float2 d = SUN_LESSER(c.lo, c.hi);
  return SUN_LESSER(d.x, d.y);
}
#if SUN_WIDTH == 16
SUN_INLINE LaneSet lanes_of(int16 m) {
  const ulong2 words = as_ulong2(convert_char16(m)) & LANE_BYTES;
  LaneSet set;
  set.low = words.s0;
  set.high = words.s1;
  return set;
}
SUN_INLINE float least_of(float16 a) { return least_of8(SUN_LESSER(a.lo, a.hi)); }
#else
SUN_INLINE LaneSet lanes_of(int8 m) {
  LaneSet set;
  set.low = bytes_of8(m);
  set.high = 0;
  return set;
}
SUN_INLINE float least_of(float8 a) { return least_of8(a); }
#endif
SUN_INLINE float greatest_of(node_float a) { return -least_of(-a); }
SUN_INLINE uint least_id8(uint8 a) {
  const uint4 b = min(a.lo, a.hi);
  const uint2 c = min(b.lo, b.hi);
  return min(c.x, c.y);
}

// Takes the lowest lane out of a set that is not empty, into `lane`. (A macro, and not a function of &set: that one went through memory.)
#define TAKE_LANE(set, lane)              \
  if ((set).low) {                        \
    (lane) = lowest_byte((set).low);      \
    (set).low &= (set).low - 1;           \
  } else {                                \
    (lane) = 8 + lowest_byte((set).high); \
    (set).high &= (set).high - 1;         \
  }
// The highest lane.
SUN_INLINE int highest_byte(ulong bytes) { return (int)((63ul - clz(bytes)) >> 3); }
#define TAKE_LAST_LANE(set, lane)                    \
  if ((set).high) {                                  \
    (lane) = highest_byte((set).high);               \
    (set).high ^= 1ul << (8 * (lane));               \
    (lane) += 8;                                     \
  } else {                                           \
    (lane) = highest_byte((set).low);                \
    (set).low ^= 1ul << (8 * (lane));                \
  }
#define SOME_LANE(set) ((set).low | (set).high)

#define SUN_TRACE_STACK SUN_WIDE_STACK

// Children whose boxes the ray meets between `from` and `limit`.
SUN_INLINE LaneSet children_hit(const SUN_GLOBAL TraceNode *node, const PreparedRay *ray, float from, float limit, node_float *near) {
  const int x = ray->negative[0], y = ray->negative[1], z = ray->negative[2];
  const node_float rx = (node_float)(ray->reciprocal[0]), ry = (node_float)(ray->reciprocal[1]), rz = (node_float)(ray->reciprocal[2]);
  const node_float nx = fma(NODE_PLANE(node, x), rx, (node_float)(ray->near_offset[0]));
  const node_float ny = fma(NODE_PLANE(node, 2 + y), ry, (node_float)(ray->near_offset[1]));
  const node_float nz = fma(NODE_PLANE(node, 4 + z), rz, (node_float)(ray->near_offset[2]));
  const node_float fx = fma(NODE_PLANE(node, 1 - x), rx, (node_float)(ray->far_offset[0]));
  const node_float fy = fma(NODE_PLANE(node, 3 - y), ry, (node_float)(ray->far_offset[1]));
  const node_float fz = fma(NODE_PLANE(node, 5 - z), rz, (node_float)(ray->far_offset[2]));
  const node_float first = (node_float)(from), last = (node_float)(limit);
  const node_float nxy = SUN_GREATER(nx, ny), nz1 = SUN_GREATER(nz, first), fxy = SUN_LESSER(fx, fy), fz1 = SUN_LESSER(fz, last);
  *near = SUN_GREATER(nxy, nz1);
  const node_float far = SUN_LESSER(fxy, fz1);
  const node_int hit = *near <= far;
  return lanes_of(hit);
}

// The nearest child that is hit, or SUN_NONE; the others wait on the stack, the farthest deepest.
SUN_INLINE uint open_node(const SUN_GLOBAL TraceNode *node, const PreparedRay *ray, float from, float limit, ulong *stack, int *size) {
  node_float near;
  LaneSet hit = children_hit(node, ray, from, limit, &near);
  if (!SOME_LANE(hit)) return SUN_NONE;
  float t[SUN_WIDTH];
  NODE_STORE(near, t);
  const int base = *size;
  int lane;
  TAKE_LANE(hit, lane)
  ulong nearest = waiting(t[lane], node->child[lane]);
  while (SOME_LANE(hit)) {
    TAKE_LANE(hit, lane)
    const ulong entry = waiting(t[lane], node->child[lane]);
    const ulong farther_one = max(entry, nearest);
    nearest = min(entry, nearest);
    int at = (*size)++;
    while (at > base && stack[at - 1] < farther_one) {
      stack[at] = stack[at - 1];
      at--;
    }
    stack[at] = farther_one;
  }
  return (uint)nearest;
}

// The same where any hit will do: children in their order, which is by area, as the largest is the likeliest to block [Nah14].
SUN_INLINE uint open_node_unsorted(const SUN_GLOBAL TraceNode *node, const PreparedRay *ray, float from, float limit, ulong *stack, int *size) {
  node_float near;
  LaneSet hit = children_hit(node, ray, from, limit, &near);
  if (!SOME_LANE(hit)) return SUN_NONE;
  int lane;
  TAKE_LAST_LANE(hit, lane)
  uint first = node->child[lane];
  while (SOME_LANE(hit)) {
    stack[(*size)++] = first;
    TAKE_LAST_LANE(hit, lane)
    first = node->child[lane];
  }
  return first;
}

// The mesh below `root`: takes the nearest hit that counts. With `any_one` the first that counts; true if there is one.
SUN_INLINE int search_mesh(const TraceScene *scene, uint root, const PreparedRay *ray, const Place *place, Search *search, int any_one) {
  ulong stack[SUN_TRACE_STACK];
  int size = 0;
  uint current = root;
  float limit = box_limit(place, search);
  while (current != SUN_NONE) {
    if (size > 0) {  // what comes next, most likely
      const uint next = (uint)stack[size - 1];
      const SUN_GLOBAL uchar *at = next & SUN_WIDE_LEAF ? (const SUN_GLOBAL uchar *)(scene->leaves + (next & ~SUN_WIDE_LEAF))
                                                        : (const SUN_GLOBAL uchar *)(scene->nodes + next);
      SUN_SOON(at);
      SUN_SOON(at + 64);
    }
    if (!(current & SUN_WIDE_LEAF)) {
      const SUN_GLOBAL TraceNode *node = &scene->nodes[current];
      current = any_one ? open_node_unsorted(node, ray, place->from, limit, stack, &size) : open_node(node, ray, place->from, limit, stack, &size);
      if (current != SUN_NONE) continue;
    } else {
      const LeafAt pack = leaf_at(scene->leaves, current & ~SUN_WIDE_LEAF, 0, place);
      Pierced p;
      const int8 pierced = pierce(pack, ray, &p);
      if (TRI_ANY(pierced)) {
        float8 t, u, v;
        uint8 primitives;
        const int8 ok = counts(pack, scene->fragments, ray, place, search, &p, pierced, &t, &u, &v, &primitives);
        if (TRI_ANY(ok)) {
          if (any_one) return 1;
          t = ok ? t : (float8)(SUN_INFINITY);
          const float best = least_of8(t);
          const int8 nearest = ok & (t == best);
          const uint8 number = nearest ? primitives : (uint8)(SUN_NONE);
          const uint primitive = least_id8(number);
          const int lane = lowest_byte(bytes_of8(number == primitive));
          float us[8], vs[8];
          vstore8(u, 0, us);
          vstore8(v, 0, vs);
          take_hit(search, place, best, us[lane], vs[lane], primitive);
          limit = box_limit(place, search);
        }
      }
    }
    current = pop_node(stack, &size, limit);
  }
  return 0;
}

// The walk over the top tree; its leaves name instances. Its stack is a parameter of its own.
typedef struct InstanceWalk {
  int size;
} InstanceWalk;

SUN_INLINE InstanceWalk begin_instances(const TraceScene *scene, int alone, ulong *stack) {
  InstanceWalk walk;
  walk.size = alone ? 0 : 1;
  if (!alone) stack[0] = scene->top_root;
  return walk;
}

SUN_INLINE uint next_instance(const TraceScene *scene, const PreparedRay *ray, float from, float limit, ulong *stack, InstanceWalk *walk) {
  uint current = pop_node(stack, &walk->size, limit);
  while (!(current & SUN_WIDE_LEAF)) {
    current = open_node(&scene->nodes[current], ray, from, limit, stack, &walk->size);
    if (current == SUN_NONE) current = pop_node(stack, &walk->size, limit);
  }
  return current == SUN_NONE ? SUN_NONE : current & ~SUN_WIDE_LEAF;
}

// The box around all instances, where there are several.
SUN_INLINE void top_bounds(const TraceScene *scene, float *lower, float *upper) {
  const SUN_GLOBAL TraceNode *root = &scene->nodes[scene->top_root];
  SUN_UNROLL
  for (int axis = 0; axis < 3; axis++) {
    lower[axis] = least_of(NODE_PLANE(root, 2 * axis));
    upper[axis] = greatest_of(NODE_PLANE(root, 2 * axis + 1));
  }
}

#endif
