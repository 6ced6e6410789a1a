// SPDX-License-Identifier: Apache-2.0
// Both children of a node stand side by side, a pair. Taking a node out frees its pair: its sibling moves up into their parent's place. Putting it
// back fills that pair again: with the node and what stood at the new place, whose slot becomes their parent.
#include "flatten/reinsertion.h"

#include <algorithm>
#include <numeric>

namespace sunstone {
namespace {

using kernel::uint;
using Node = BinaryTree::Node;

struct Box {
  float lower[3], upper[3];
};

Box box_of(const Node &node) {
  Box box;
  std::copy_n(node.lower, 3, box.lower);
  std::copy_n(node.upper, 3, box.upper);
  return box;
}
void include(Box &box, const Node &node) {
  for (int axis = 0; axis < 3; axis++) {
    box.lower[axis] = std::min(box.lower[axis], node.lower[axis]);
    box.upper[axis] = std::max(box.upper[axis], node.upper[axis]);
  }
}
template <class B>
float area(const B &box) {
  const float x = box.upper[0] - box.lower[0], y = box.upper[1] - box.lower[1], z = box.upper[2] - box.lower[2];
  return x * y + y * z + z * x;
}

class Reinsertion {
 public:
  explicit Reinsertion(BinaryTree &tree) : nodes_(tree.nodes), parent_(nodes_.size(), 0) {
    for (uint i = 0; i < nodes_.size(); i++) adopt(i);
  }

  // The nodes of largest area, largest first.
  void pass(std::size_t count) {
    std::vector<uint> order(nodes_.size() - 1);
    std::iota(order.begin(), order.end(), 1u);
    count = std::min(count, order.size());
    const auto larger = [&](uint a, uint b) {
      const float x = area(nodes_[a]), y = area(nodes_[b]);
      return x != y ? x > y : a < b;
    };
    std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(count), order.end(), larger);
    for (std::size_t i = 0; i < count; i++) reinsert(order[i]);
  }

 private:
  static uint sibling(uint node) { return ((node - 1) ^ 1) + 1; }  // pairs begin at odd numbers

  void adopt(uint node) {
    if (nodes_[node].first_child) parent_[nodes_[node].first_child] = parent_[nodes_[node].first_child + 1] = node;
  }

  void refit(uint node) {
    for (;; node = parent_[node]) {
      Box box = box_of(nodes_[nodes_[node].first_child]);
      include(box, nodes_[nodes_[node].first_child + 1]);
      if (std::equal(box.lower, box.lower + 3, nodes_[node].lower) && std::equal(box.upper, box.upper + 3, nodes_[node].upper)) return;
      std::copy_n(box.lower, 3, nodes_[node].lower);
      std::copy_n(box.upper, 3, nodes_[node].upper);
      if (node == 0) return;
    }
  }

  // Where the sum of areas falls most when the subtree `node` stands beside what is there; 0 where it is best left alone. Branch and bound: up the
  // ancestors, and at each down into the other half.
  uint best_place(uint node) {
    const Node &moved = nodes_[node];
    const float own = area(moved);
    uint pivot = parent_[node], other = sibling(node), best = 0;
    float gain = area(nodes_[pivot]), best_gain = 0.0f;
    Box rest = box_of(nodes_[other]);  // the box of `pivot`, once the node has left it
    const float least = 1e-4f * area(nodes_[0]) / float(nodes_.size());
    for (bool first = true;; first = false) {
      open_.assign(1, {gain, other});
      while (!open_.empty()) {
        const auto [before, at] = open_.back();
        open_.pop_back();
        if (before - own <= best_gain + least) continue;
        Box both = box_of(nodes_[at]);
        include(both, moved);
        const float after = before - area(both);
        if (after > best_gain + least && at != sibling(node)) {
          best_gain = after;
          best = at;
        }
        if (nodes_[at].first_child) {
          const float below = after + area(nodes_[at]);
          open_.push_back({below, nodes_[at].first_child});
          open_.push_back({below, nodes_[at].first_child + 1});
        }
      }
      if (!first) {
        include(rest, nodes_[other]);
        gain += area(nodes_[pivot]) - area(rest);
      }
      if (pivot == 0) return best;
      other = sibling(pivot);
      pivot = parent_[pivot];
    }
  }

  void reinsert(uint node) {
    if (parent_[node] == 0) return;  // beside the root's other child there is nowhere to go
    const uint place = best_place(node);
    if (!place) return;
    const uint left_behind = sibling(node), old_parent = parent_[node], pair = std::min(node, left_behind);
    const Node moved = nodes_[node];
    nodes_[old_parent] = nodes_[left_behind];
    adopt(old_parent);
    nodes_[pair] = nodes_[place];
    nodes_[pair + 1] = moved;
    adopt(pair);
    adopt(pair + 1);
    nodes_[place].first_child = pair;
    nodes_[place].item_count = 0;
    adopt(place);
    // Both ancestries, each until a box stays the same; the place's box is not yet that of its children.
    Box box = box_of(nodes_[pair]);
    include(box, nodes_[pair + 1]);
    std::copy_n(box.lower, 3, nodes_[place].lower);
    std::copy_n(box.upper, 3, nodes_[place].upper);
    if (place != 0) refit(parent_[place]);
    if (old_parent != 0) refit(parent_[old_parent]);
  }

  struct Open {
    float gain;
    uint node;
  };
  std::vector<Node> &nodes_;
  std::vector<uint> parent_;
  std::vector<Open> open_;
};

// Depth first again, children behind their parents, items of a subtree together.
BinaryTree in_order(const BinaryTree &from) {
  BinaryTree tree;
  tree.nodes.reserve(from.nodes.size());
  tree.items.reserve(from.items.size());
  struct Open {
    uint from, to;
    std::size_t depth;
  };
  std::vector<Open> open{{0, 0, 1}};
  tree.nodes.emplace_back();
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    const Node &node = from.nodes[at.from];
    Node &to = tree.nodes[at.to];
    to = node;
    to.first_item = uint(tree.items.size());
    tree.depth = std::max(tree.depth, at.depth);
    if (node.first_child) {
      const uint first = uint(tree.nodes.size());
      to.first_child = first;
      tree.nodes.resize(first + 2);
      open.push_back({node.first_child + 1, first + 1, at.depth + 1});
      open.push_back({node.first_child, first, at.depth + 1});
    } else {
      tree.items.insert(tree.items.end(), from.items.begin() + node.first_item, from.items.begin() + node.first_item + node.item_count);
    }
  }
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    Node &node = tree.nodes[i];
    if (node.first_child) node.item_count = tree.nodes[node.first_child].item_count + tree.nodes[node.first_child + 1].item_count;
  }
  return tree;
}

}  // namespace

void optimize_by_reinsertion(BinaryTree &tree, int passes) {
  if (tree.nodes.size() < 7) return;
  Reinsertion reinsertion(tree);
  // Large nodes are met by most rays; beyond so many the time would grow with nothing to show for it.
  const std::size_t count = std::min(tree.nodes.size() / 4, std::size_t(200000));
  for (int i = 0; i < passes; i++) reinsertion.pass(count);
  tree = in_order(tree);
}

}  // namespace sunstone
