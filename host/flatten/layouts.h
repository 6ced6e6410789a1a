// SPDX-License-Identifier: Apache-2.0
// A binary tree with its boxes -> nodes and leaves as a layout's kernels read them.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "flatten/flatten.h"

namespace sunstone {

// Children stand behind their parents; a subtree's items stand together. The root is node 0.
struct BinaryTree {
  struct Node {
    float lower[3], upper[3];  // exactly the bounds of its items
    kernel::uint first_child;  // the other one is first_child + 1; 0: a leaf
    kernel::uint first_item, item_count;
  };
  std::vector<Node> nodes;
  std::vector<kernel::uint> items;
  std::size_t depth = 0;  // nodes on the longest way from the root to a leaf
};

// One tree in its layout, nodes and leaves numbered from 0.
struct TreePart {
  std::vector<std::byte> nodes, leaves;
  std::vector<kernel::uint> instance_list;
  kernel::uint root = 0;
  std::size_t node_count = 0, leaf_count = 0, depth = 0;
  std::size_t stack = 0;  // entries that wait at most in a traversal
};

// Triangles that one leaf takes (the top tree's leaves take one instance each).
unsigned leaf_triangles(Layout layout);
std::size_t node_bytes(Layout layout);
std::size_t leaf_bytes(Layout layout);
// Entries of the kernels' stack, shared/bvh.h.
std::size_t stack_entries(Layout layout);

// As often as a leaf of this mesh stands there: once, or for each key of the shutter's time.
std::size_t mesh_keys(const FlatScene &scene, const MeshRange &mesh);

// Items are numbers of triangles of `scene`, or of fragments with SUN_ID_FRAGMENT.
TreePart lay_out_mesh(const BinaryTree &tree, Layout layout, const FlatScene &scene, std::size_t keys = 1);
// Items are numbers of instances.
TreePart lay_out_instances(const BinaryTree &tree, Layout layout);

// Puts `part` behind what `tree` holds, its numbers moved accordingly; returns its root's.
kernel::uint append_part(Tree &tree, TreePart &&part);

}  // namespace sunstone
