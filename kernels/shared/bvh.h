// SPDX-License-Identifier: Apache-2.0
// The nodes of each layout. A tree only ever culls: no layout, no order of visiting and no builder can change a hit (docs/decisions/0002-hits.md).
// Trees of two levels share one array of nodes: the top tree's leaves name instances, each mesh's tree has leaves of triangles.
#ifndef SUN_SHARED_BVH_H
#define SUN_SHARED_BVH_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

// Set in a triangle's id inside leaves. The rest of the id is the primitive number, below 2^29.
#define SUN_ID_SINGLE_SIDED 0x80000000u  // seen from behind it is passed by every ray
#define SUN_ID_PASSABLE 0x40000000u      // alpha or smooth thin transmission: does not simply block shadow rays
#define SUN_ID_FRAGMENT 0x20000000u      // in pieces: stands in leaves once for each of them
#define SUN_ID_PRIMITIVE 0x1fffffffu

// A piece of a long triangle. Trees hold the pieces' boxes instead of the triangle's. The pieces of one triangle stand together, triangles in order;
// before the first and behind the last of all there is one more, of no triangle (SUN_NONE).
typedef struct Fragment {
  float lower[3];
  uint primitive;
  float upper[3];  // wider than the piece by SUN_FRAGMENT_MARGIN of the triangle's longest extent, within the triangle's own box
  uint count;      // in the first of all: the number of pieces; else 0
} Fragment;
SUN_STATIC_ASSERT(sizeof(Fragment) == 32, fragment_is_32_bytes);
#define SUN_FRAGMENT_MARGIN 0.0009765625f  // 2^-10
// A ray that sees less than this of a triangle in pieces needs its t found with more care: twice the area across the ray's third axis, over the square
// of the longest extent.
#define SUN_FRAGMENT_AREA 0.00390625f  // 2^-8

// One node of the binary layout. A leaf has count > 0.
typedef struct BinaryNode {
  float lower[3];
  uint first;  // leaf: its first LeafTriangle (mesh tree) or entry of the instance list (top tree); inner: left child, the right one is first + 1
  float upper[3];
  uint count;
} BinaryNode;
SUN_STATIC_ASSERT(sizeof(BinaryNode) == 32, binary_node_is_32_bytes);

// A triangle of the binary layout's leaves.
typedef struct LeafTriangle {
  float v[9];  // three corners, xyz each
  uint id;     // primitive number and SUN_ID_ bits
} LeafTriangle;
SUN_STATIC_ASSERT(sizeof(LeafTriangle) == 40, leaf_triangle_is_40_bytes);

// Wide layouts: W children as SoA. Empty slots have lower = +inf and upper = -inf.
// child: bit 31 set = leaf: index of a pack (mesh tree) or an instance number (top tree); otherwise index of a node.
#define SUN_WIDE_LEAF 0x80000000u
#define SUN_PACK 8  // triangles of a pack
typedef struct Wide8Node {
  float plane[6][8];  // lower x, upper x, lower y, upper y, lower z, upper z
  uint child[8];
} Wide8Node;
typedef struct Wide16Node {
  float plane[6][16];
  uint child[16];
} Wide16Node;
typedef struct WidePack {
  float v[9][SUN_PACK];  // corners 0, 1, 2, xyz each; empty lanes hold NaN, so that every comparison fails
  uint id[SUN_PACK];     // primitive number and SUN_ID_ bits
} WidePack;
SUN_STATIC_ASSERT(sizeof(Wide8Node) == 224, wide8_node_is_224_bytes);
SUN_STATIC_ASSERT(sizeof(Wide16Node) == 448, wide16_node_is_448_bytes);
SUN_STATIC_ASSERT(sizeof(WidePack) == 320, wide_pack_is_320_bytes);

// Entries of the traversal's private stacks. The build gives no tree that needs more (host/flatten/bvh.cpp).
#define SUN_BINARY_STACK 64
#define SUN_WIDE_STACK 512

SUN_NAMESPACE_END
#endif
