// SPDX-License-Identifier: Apache-2.0
// The wide layouts collapse the binary tree by dynamic programming [Ylitie17]: of all ways to cut it into nodes of up to W children and packs of up
// to SUN_PACK triangles, the one of least surface-area cost. Recursion is as deep as the tree, which its builder bounds.
#include "flatten/layouts.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "base/error.h"

namespace sunstone {
namespace {

using kernel::uint;
using Node = BinaryTree::Node;

float area(const Node &node) {
  const float x = node.upper[0] - node.lower[0], y = node.upper[1] - node.lower[1], z = node.upper[2] - node.lower[2];
  return x * y + y * z + z * x;
}

uint triangle_of(const FlatScene &scene, uint item) { return item & SUN_ID_FRAGMENT ? scene.fragments[item & SUN_ID_PRIMITIVE].primitive : item; }

std::array<float, 9> corners(const FlatScene &scene, uint item, std::size_t key) {
  const uint triangle = triangle_of(scene, item);
  std::array<float, 9> v;
  for (int corner = 0; corner < 3; corner++)
    std::copy_n(scene.vertices[scene.triangles[triangle].vertex[corner] + key * scene.deforming].position, 3, v.begin() + 3 * corner);
  return v;
}

// As leaves have it.
uint id_of(const FlatScene &scene, uint item) { return scene.triangle_ids[triangle_of(scene, item)] | (item & SUN_ID_FRAGMENT); }

template <class T>
std::vector<std::byte> bytes_of(const std::vector<T> &values) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

TreePart lay_out_binary(const BinaryTree &tree, std::size_t keys) {
  TreePart part;
  std::vector<kernel::BinaryNode> nodes(tree.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); i++) {
    const Node &from = tree.nodes[i];
    kernel::BinaryNode &to = nodes[i];
    std::copy_n(from.lower, 3, to.lower);
    std::copy_n(from.upper, 3, to.upper);
    to.first = from.first_child ? from.first_child : uint(from.first_item * keys);
    to.count = from.first_child ? 0 : from.item_count;
  }
  part.nodes = bytes_of(nodes);
  part.node_count = nodes.size();
  part.depth = tree.depth;
  part.stack = tree.depth;  // one a level
  return part;
}

template <class WideNode>
class Collapse {
 public:
  static constexpr int width = int(std::size(WideNode{}.child));
  Collapse(const BinaryTree &tree, unsigned leaf_items) : tree_(tree), leaf_items_(leaf_items), plans_(tree.nodes.size()) {}

  // `leaf(node)` writes a leaf and returns its number.
  template <class Leaf>
  TreePart run(Leaf &&leaf) {
    solve(0);
    TreePart part;
    if (plans_[0].how[0] == as_leaf) {
      part.root = SUN_WIDE_LEAF | leaf(tree_.nodes[0]);
      part.depth = 1;
      part.stack = 1;
      return part;
    }
    // Depth first, so that a subtree's nodes stand together.
    struct Open {
      uint node;
      uint binary;
      std::size_t depth, waiting;
    };
    std::vector<WideNode> nodes(1);
    std::vector<Open> open{{0, 0, 1, 0}};
    std::vector<uint> children;
    while (!open.empty()) {
      const Open at = open.back();
      open.pop_back();
      children.clear();
      show_children(at.binary, children);
      std::stable_sort(children.begin(), children.end(), [&](uint a, uint b) { return area(tree_.nodes[a]) > area(tree_.nodes[b]); });
      const std::size_t waiting = at.waiting + children.size();
      part.depth = std::max(part.depth, at.depth + 1);
      part.stack = std::max(part.stack, waiting);
      WideNode node;
      for (int slot = 0; slot < width; slot++) {
        const bool used = slot < int(children.size());
        for (int axis = 0; axis < 3; axis++) {
          node.plane[2 * axis][slot] = used ? tree_.nodes[children[slot]].lower[axis] : std::numeric_limits<float>::infinity();
          node.plane[2 * axis + 1][slot] = used ? tree_.nodes[children[slot]].upper[axis] : -std::numeric_limits<float>::infinity();
        }
        node.child[slot] = 0;
        if (!used) continue;
        if (plans_[children[slot]].how[0] == as_leaf) {
          node.child[slot] = SUN_WIDE_LEAF | leaf(tree_.nodes[children[slot]]);
        } else {
          node.child[slot] = uint(nodes.size());
          open.push_back({uint(nodes.size()), children[slot], at.depth + 1, waiting - 1});
          nodes.emplace_back();
        }
      }
      nodes[at.node] = node;
    }
    part.nodes = bytes_of(nodes);
    part.node_count = nodes.size();
    return part;
  }

 private:
  // The cheapest way to show a subtree as at most i + 1 children of a wide node above it, and how: as one child (a leaf, a wide node), as for i
  // children less, or with so many (plus one) of them for its left half.
  struct Plan {
    std::array<float, width> cost;
    std::array<unsigned char, width> how;
  };
  static constexpr unsigned char as_leaf = 255, as_node = 254, as_fewer = 253;

  // The share of `slots` (at least 2) children that is best for the left half, less one.
  int best_share(uint binary, int slots, float &cost) const {
    const Plan &left = plans_[tree_.nodes[binary].first_child], &right = plans_[tree_.nodes[binary].first_child + 1];
    int best = 0;
    cost = std::numeric_limits<float>::infinity();
    for (int k = 0; k + 1 < slots; k++) {
      const float c = left.cost[k] + right.cost[slots - 2 - k];
      if (c < cost) {
        cost = c;
        best = k;
      }
    }
    return best;
  }

  void solve(uint binary) {
    const Node &node = tree_.nodes[binary];
    Plan &plan = plans_[binary];
    const float one = area(node);  // a node costs as much as a pack
    if (!node.first_child) {
      plan.cost.fill(one);
      plan.how.fill(as_fewer);
      plan.how[0] = as_leaf;
      return;
    }
    const uint left = node.first_child, right = left + 1;
    if (node.item_count > 4096) {
      tbb::parallel_invoke([&] { solve(left); }, [&] { solve(right); });
    } else {
      solve(left);
      solve(right);
    }
    float below;
    best_share(binary, width, below);
    const bool leaf = node.item_count <= leaf_items_ && one <= one + below;
    plan.cost[0] = leaf ? one : one + below;
    plan.how[0] = leaf ? as_leaf : as_node;
    for (int i = 1; i < width; i++) {
      float cost;
      const int share = best_share(binary, i + 1, cost);
      const bool better = cost < plan.cost[i - 1];
      plan.cost[i] = better ? cost : plan.cost[i - 1];
      plan.how[i] = better ? static_cast<unsigned char>(share) : as_fewer;
    }
  }

  void show_children(uint binary, std::vector<uint> &children) const {
    float cost;
    const int share = best_share(binary, width, cost);
    show(tree_.nodes[binary].first_child, share, children);
    show(tree_.nodes[binary].first_child + 1, width - 2 - share, children);
  }

  // The roots that stand for a subtree given i + 1 slots.
  void show(uint binary, int i, std::vector<uint> &children) const {
    const Plan &plan = plans_[binary];
    while (plan.how[i] == as_fewer) i--;
    if (plan.how[i] == as_leaf || plan.how[i] == as_node) {
      children.push_back(binary);
      return;
    }
    const int share = plan.how[i];
    show(tree_.nodes[binary].first_child, share, children);
    show(tree_.nodes[binary].first_child + 1, i - 1 - share, children);
  }

  const BinaryTree &tree_;
  const unsigned leaf_items_;
  std::vector<Plan> plans_;
};

template <class WideNode>
TreePart lay_out_wide_mesh(const BinaryTree &tree, const FlatScene &scene, std::size_t keys) {
  std::vector<kernel::WidePack> packs;
  TreePart part = Collapse<WideNode>(tree, SUN_PACK).run([&](const Node &node) {
    for (std::size_t key = 0; key < keys; key++) {
      kernel::WidePack &pack = packs.emplace_back();
      for (auto &row : pack.v) std::fill(std::begin(row), std::end(row), std::numeric_limits<float>::quiet_NaN());
      std::fill(std::begin(pack.id), std::end(pack.id), 0u);
      for (uint lane = 0; lane < node.item_count; lane++) {
        const uint item = tree.items[node.first_item + lane];
        const auto v = corners(scene, item, key);
        for (int k = 0; k < 9; k++) pack.v[k][lane] = v[k];
        pack.id[lane] = id_of(scene, item);
      }
    }
    return uint(packs.size() - keys);
  });
  part.leaves = bytes_of(packs);
  part.leaf_count = packs.size();
  return part;
}

template <class WideNode>
void move_children(std::byte *bytes, std::size_t count, uint nodes, uint leaves) {
  for (std::size_t i = 0; i < count; i++) {
    WideNode node;
    std::memcpy(&node, bytes + i * sizeof node, sizeof node);
    for (std::size_t slot = 0; slot < std::size(node.child); slot++) {
      if (node.plane[0][slot] > node.plane[1][slot]) continue;  // an empty slot
      node.child[slot] += node.child[slot] & SUN_WIDE_LEAF ? leaves : nodes;
    }
    std::memcpy(bytes + i * sizeof node, &node, sizeof node);
  }
}

void move_binary(std::byte *bytes, std::size_t count, uint nodes, uint leaves) {
  for (std::size_t i = 0; i < count; i++) {
    kernel::BinaryNode node;
    std::memcpy(&node, bytes + i * sizeof node, sizeof node);
    node.first += node.count ? leaves : nodes;
    std::memcpy(bytes + i * sizeof node, &node, sizeof node);
  }
}

template <class T>
void append(std::vector<T> &to, std::vector<T> &&from) {
  if (to.empty())
    to = std::move(from);
  else
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

unsigned leaf_triangles(Layout layout) { return layout == Layout::binary ? 4 : SUN_PACK; }

std::size_t node_bytes(Layout layout) {
  return layout == Layout::binary ? sizeof(kernel::BinaryNode) : layout == Layout::wide8 ? sizeof(kernel::Wide8Node) : sizeof(kernel::Wide16Node);
}

std::size_t leaf_bytes(Layout layout) { return layout == Layout::binary ? sizeof(kernel::LeafTriangle) : sizeof(kernel::WidePack); }

std::size_t stack_entries(Layout layout) { return layout == Layout::binary ? SUN_BINARY_STACK : SUN_WIDE_STACK; }

std::size_t mesh_keys(const FlatScene &scene, const MeshRange &mesh) { return mesh.deforms ? scene.motion_steps + 1 : 1; }

TreePart lay_out_mesh(const BinaryTree &tree, Layout layout, const FlatScene &scene, std::size_t keys) {
  if (layout == Layout::wide8) return lay_out_wide_mesh<kernel::Wide8Node>(tree, scene, keys);
  if (layout == Layout::wide16) return lay_out_wide_mesh<kernel::Wide16Node>(tree, scene, keys);
  if (tree.items.size() > SUN_NONE / keys) throw Error{"tree", "more than 2^32 leaves"};
  TreePart part = lay_out_binary(tree, keys);
  std::vector<kernel::LeafTriangle> leaves(tree.items.size() * keys);
  for (std::size_t i = 0; i < leaves.size(); i++) {
    const uint item = tree.items[i / keys];
    const auto v = corners(scene, item, i % keys);
    std::copy(v.begin(), v.end(), leaves[i].v);
    leaves[i].id = id_of(scene, item);
  }
  part.leaves = bytes_of(leaves);
  part.leaf_count = leaves.size();
  return part;
}

TreePart lay_out_instances(const BinaryTree &tree, Layout layout) {
  const auto instance_of = [&](const Node &node) { return tree.items[node.first_item]; };
  if (layout == Layout::wide8) return Collapse<kernel::Wide8Node>(tree, 1).run(instance_of);
  if (layout == Layout::wide16) return Collapse<kernel::Wide16Node>(tree, 1).run(instance_of);
  TreePart part = lay_out_binary(tree, 1);
  part.instance_list = tree.items;
  return part;
}

uint append_part(Tree &tree, TreePart &&part) {
  const std::size_t first_node = tree.node_count, first_leaf = tree.leaf_count;
  const bool wide = tree.layout != Layout::binary;
  const bool instances = part.leaf_count == 0;  // the top tree: its leaves are numbers already
  tree.node_count += part.node_count;
  tree.leaf_count += part.leaf_count;
  if (tree.node_count >= SUN_WIDE_LEAF || tree.leaf_count >= SUN_WIDE_LEAF - 1) throw Error{"tree", "more than 2^31 nodes or leaves"};
  const uint move_nodes = uint(first_node), move_leaves = instances ? 0 : uint(first_leaf);
  if (tree.layout == Layout::binary) move_binary(part.nodes.data(), part.node_count, move_nodes, move_leaves);
  if (tree.layout == Layout::wide8) move_children<kernel::Wide8Node>(part.nodes.data(), part.node_count, move_nodes, move_leaves);
  if (tree.layout == Layout::wide16) move_children<kernel::Wide16Node>(part.nodes.data(), part.node_count, move_nodes, move_leaves);
  append(tree.nodes, std::move(part.nodes));
  append(tree.leaves, std::move(part.leaves));
  append(tree.instance_list, std::move(part.instance_list));
  tree.depth = std::max(tree.depth, part.depth);
  return part.root + (wide && part.root & SUN_WIDE_LEAF ? move_leaves : move_nodes);
}

}  // namespace sunstone
