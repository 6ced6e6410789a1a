// SPDX-License-Identifier: Apache-2.0
// What traversals know of the scene: the tree, with nodes of the layout that SUN_LAYOUT names, and what its leaves lead to.
#ifndef SUN_SCENE_TRACE_SCENE_H
#define SUN_SCENE_TRACE_SCENE_H
#include "scene/triangle.h"
#include "shared/motion.h"

SUN_NAMESPACE_BEGIN

#if SUN_LAYOUT == SUN_LAYOUT_BINARY
typedef BinaryNode TraceNode;
#elif SUN_LAYOUT == SUN_LAYOUT_WIDE16
typedef Wide16Node TraceNode;
#else
typedef Wide8Node TraceNode;
#endif

typedef struct TraceScene {
  const SUN_GLOBAL TraceNode *nodes;
  const SUN_GLOBAL TraceLeaf *leaves;
  const SUN_GLOBAL uint *instance_list;
  const SUN_GLOBAL uint *roots;
  const SUN_GLOBAL Fragment *fragments;
  const SUN_GLOBAL Instance *instances;
  const SUN_GLOBAL Motion *motion;
  uint top_root;
  uint instance_count;
  uint plane_count;  // instances behind those
} TraceScene;

// A node that waits: its box's near t in the upper half (t >= 0, so integers sort like floats), its number or reference in the lower one. A stack's size stands apart
// from its entries, so that it stays in a register.
SUN_INLINE ulong waiting(float t, uint node) { return ((ulong)as_uint(t) << 32) | node; }

// The next that waits and is not beyond `limit`, or SUN_NONE.
SUN_INLINE uint pop_node(const ulong *stack, int *size, float limit) {
  while (*size > 0) {
    const ulong entry = stack[--*size];
    if (as_float((uint)(entry >> 32)) <= limit) return (uint)entry;
  }
  return SUN_NONE;
}

SUN_NAMESPACE_END
#endif
