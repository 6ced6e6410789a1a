// SPDX-License-Identifier: Apache-2.0
// The trees: boxes contain what is below them exactly, every triangle and every piece of one is there exactly once, and no input makes them too deep.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <span>

#include "base/error.h"
#include "flatten/bvh.h"
#include "flatten/reinsertion.h"
#include "kernels/hits/cases.h"

namespace sunstone::hits {
namespace {

using glm::vec3;
using kernel::uint;

struct Box {
  vec3 lower{INFINITY}, upper{-INFINITY};
  void include(const Box &b) {
    lower = glm::min(lower, b.lower);
    upper = glm::max(upper, b.upper);
  }
  bool operator==(const Box &b) const { return lower == b.lower && upper == b.upper; }
};

template <class T>
T read(const std::vector<std::byte> &bytes, std::size_t i) {
  T value;
  EXPECT_LE((i + 1) * sizeof(T), bytes.size());
  std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
  return value;
}

Box box_of(const kernel::Fragment &f) { return {vec3(f.lower[0], f.lower[1], f.lower[2]), vec3(f.upper[0], f.upper[1], f.upper[2])}; }
bool contains(const Box &outer, const Box &inner) {
  return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) && glm::all(glm::greaterThanEqual(outer.upper, inner.upper));
}

// Walks a tree as the kernels do, checks every box against what is below it, and collects its leaves' ids (of triangles, or numbers of instances).
class Walk {
 public:
  Walk(const FlatScene &scene, const Tree &tree, bool top) : scene_(scene), tree_(tree), top_(top) {}
  std::vector<uint> ids;
  std::set<uint> held;  // fragments within the box of a leaf that has their triangle
  std::size_t deepest = 0, stack = 0;

  Box visit(uint reference) {
    if (tree_.layout == Layout::binary) return visit_binary(reference, 1);
    if (tree_.layout == Layout::wide8) return visit_wide<kernel::Wide8Node>(reference, 1, 0);
    return visit_wide<kernel::Wide16Node>(reference, 1, 0);
  }

 private:
  Box instance(uint number) {
    ids.push_back(number);
    const kernel::Instance &i = scene_.instances.at(number);
    return {vec3(i.lower[0], i.lower[1], i.lower[2]), vec3(i.upper[0], i.upper[1], i.upper[2])};
  }
  // The items of a leaf, whose box is `own`: its union is exact where all are whole triangles. A piece's number is not in the leaf: each lane in pieces has
  // to have some piece of its triangle within the box, and check() asks that each piece is within the box of some leaf with its triangle.
  struct Item {
    std::array<float, 9> v;
    uint id;
  };
  void check_leaf(std::span<const Item> items, const Box &own, bool exact = true) {
    Box whole;
    bool pieces = false;
    for (const Item &item : items) {
      ids.push_back(item.id);
      const uint primitive = item.id & SUN_ID_PRIMITIVE;
      EXPECT_EQ(item.id & ~SUN_ID_FRAGMENT, scene_.triangle_ids.at(primitive));
      const kernel::Triangle &t = scene_.triangles.at(primitive);
      for (std::size_t k = 0; k < 3; k++) EXPECT_EQ(std::memcmp(&item.v[3 * k], scene_.vertices[t.vertex[k]].position, 12), 0);
      if (item.id & SUN_ID_FRAGMENT) {
        pieces = true;
        std::size_t within = 0;
        for (std::size_t f = 0; f < scene_.fragments.size(); f++) {
          if (scene_.fragments[f].primitive != primitive) continue;
          const Box piece = box_of(scene_.fragments[f]);
          if (!contains(own, piece)) continue;
          within++;
          held.insert(uint(f));
        }
        EXPECT_GT(within, 0u);
        continue;
      }
      Box box;
      for (std::size_t k = 0; k < 3; k++) {
        const vec3 p(item.v[3 * k], item.v[3 * k + 1], item.v[3 * k + 2]);
        box.include({p, p});
      }
      EXPECT_TRUE(contains(own, box));
      whole.include(box);
    }
    EXPECT_TRUE(!exact || pieces || own == whole);
  }
  Box visit_binary(uint number, std::size_t depth) {
    deepest = std::max(deepest, depth);
    stack = std::max(stack, depth);
    const auto node = read<kernel::BinaryNode>(tree_.nodes, number);
    const Box own{vec3(node.lower[0], node.lower[1], node.lower[2]), vec3(node.upper[0], node.upper[1], node.upper[2])};
    EXPECT_LE(node.count, top_ ? 1u : 4u);
    if (node.count && !top_) {
      std::vector<Item> items;
      for (uint i = 0; i < node.count; i++) {
        const auto leaf = read<kernel::LeafTriangle>(tree_.leaves, node.first + i);
        if (std::isnan(leaf.v[0])) return {};  // a mesh of no triangles
        Item item{{}, leaf.id};
        std::copy_n(leaf.v, 9, item.v.begin());
        items.push_back(item);
      }
      check_leaf(items, own);
      return own;
    }
    Box box;
    for (uint i = 0; i < node.count; i++) box.include(instance(tree_.instance_list.at(node.first + i)));
    if (node.count == 0)
      for (uint child = node.first; child < node.first + 2; child++) box.include(visit_binary(child, depth + 1));
    EXPECT_TRUE(own == box);
    return own;
  }
  // `known` is the box that the node above has; a root has none, and lies within everything.
  template <class Node>
  Box visit_wide(uint reference, std::size_t depth, std::size_t waiting, const Box &known = {vec3(-INFINITY), vec3(INFINITY)}) {
    deepest = std::max(deepest, depth);
    Box box;
    if (reference & SUN_WIDE_LEAF) {
      if (top_) return instance(reference & ~SUN_WIDE_LEAF);
      const auto pack = read<kernel::WidePack>(tree_.leaves, reference & ~SUN_WIDE_LEAF);
      std::vector<Item> items;
      for (int lane = 0; lane < SUN_PACK; lane++) {
        if (std::isnan(pack.v[0][lane])) continue;
        Item item{{}, pack.id[lane]};
        for (std::size_t k = 0; k < 9; k++) item.v[k] = pack.v[k][lane];
        items.push_back(item);
      }
      check_leaf(items, known, depth > 1);
      return known;
    }
    const auto node = read<Node>(tree_.nodes, reference);
    std::size_t children = 0;
    for (std::size_t slot = 0; slot < std::size(node.child); slot++) children += node.plane[0][slot] <= node.plane[1][slot];
    stack = std::max(stack, waiting + children);
    EXPECT_GE(children, 2u);
    for (std::size_t slot = 0; slot < std::size(node.child); slot++) {
      const Box own{vec3(node.plane[0][slot], node.plane[2][slot], node.plane[4][slot]),
                    vec3(node.plane[1][slot], node.plane[3][slot], node.plane[5][slot])};
      if (own == Box{}) continue;
      EXPECT_TRUE(own == visit_wide<Node>(node.child[slot], depth + 1, waiting + children - 1, own));
      box.include(own);
    }
    return box;
  }

  const FlatScene &scene_;
  const Tree &tree_;
  const bool top_;
};

void check(const FlatScene &scene, Layout layout) {
  const Tree tree = build_tree(scene, layout);
  ASSERT_EQ(tree.layout, layout);
  ASSERT_EQ(tree.roots.size(), scene.instances.size());
  std::vector<bool> seen(scene.meshes.size());
  const std::size_t room = layout == Layout::binary ? SUN_BINARY_STACK : SUN_WIDE_STACK;
  for (std::size_t i = 0; i < scene.instances.size(); i++) {
    const uint mesh = scene.instance_mesh[i];
    if (seen[mesh]) continue;
    seen[mesh] = true;
    Walk walk(scene, tree, false);
    walk.visit(tree.roots[i]);
    const MeshRange &range = scene.meshes[mesh];
    const std::multiset<uint> got(walk.ids.begin(), walk.ids.end());
    std::multiset<uint> expected;  // every fragment, and every triangle that has none
    std::set<uint> in_pieces;
    for (uint f = range.first_fragment; f < range.first_fragment + range.fragment_count; f++) {
      const uint primitive = scene.fragments[f].primitive;
      in_pieces.insert(primitive);
      expected.insert(SUN_ID_FRAGMENT | scene.triangle_ids[primitive]);
      EXPECT_TRUE(walk.held.count(f)) << "piece " << f;
    }
    for (uint k = range.first_triangle; k < range.first_triangle + range.triangle_count; k++)
      if (!in_pieces.count(k)) expected.insert(scene.triangle_ids[k]);
    EXPECT_TRUE(got == expected) << "mesh " << mesh << ": " << got.size() << " of " << expected.size();
    EXPECT_LE(walk.stack, room);
    EXPECT_LE(walk.deepest, tree.depth);
  }
  if (scene.instances.size() > 1) {
    Walk walk(scene, tree, true);
    walk.visit(tree.top_root);
    std::multiset<uint> expected;
    for (uint i = 0; i < scene.instances.size(); i++) expected.insert(i);
    EXPECT_TRUE(std::multiset<uint>(walk.ids.begin(), walk.ids.end()) == expected);
    EXPECT_LE(walk.stack, room);
  }
}

class Trees : public testing::TestWithParam<Layout> {};

TEST_P(Trees, ContainTheirChildrenAndEveryTriangleOnce) {
  for (const Case &c : all_cases()) {
    SCOPED_TRACE(c.name);
    check(c.scene, GetParam());
  }
}

TEST_P(Trees, TakeAnyNumberOfTriangles) {
  Random random(31);
  for (const int count : {0, 1, 2, 4, 5, 8, 9, 16, 17, 100, 3000}) {
    SCOPED_TRACE(count);
    Soup soup;
    for (int i = 0; i < count; i++) {
      const vec3 at = random.in_box(vec3(-1), vec3(1));
      soup.triangle(at, at + 0.1f * random.direction(), at + 0.1f * random.direction());
    }
    check(soup.finish(), GetParam());
  }
}

TEST_P(Trees, EndOnEqualTriangles) {
  Soup soup;
  for (int i = 0; i < 5000; i++) soup.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  check(soup.finish(), GetParam());
}

TEST_P(Trees, EndOnEqualInstances) {
  Soup soup;
  soup.begin_mesh();
  soup.box(vec3(-1), vec3(1));
  for (int i = 0; i < 300; i++) soup.instance(0, identity);
  check(soup.finish(), GetParam());
}

// Sizes that fall by a constant factor make a tree by SAH peel off a few triangles a level, down to the smallest float and up beyond what areas hold.
TEST_P(Trees, StayWithinTheStackOnGeometricSeries) {
  for (const float factor : {0.5f, 0.9f, 0.98f}) {
    SCOPED_TRACE(factor);
    Soup soup;
    float size = 1e17f;
    for (int i = 0; i < 3000 && size > 1e-38f; i++, size *= factor) soup.triangle({size, 0, 0}, {2 * size, size, 0}, {2 * size, 0, size});
    check(soup.finish(), GetParam());
  }
  Soup soup;
  for (float size = 3e38f; size > 1e-38f; size *= 0.7f) soup.triangle({size, 0, 0}, {size, size, 0}, {size, 0, -size});
  check(soup.finish(), GetParam());
}

TEST_P(Trees, RefuseWhatIsNotFinite) {
  Soup soup;
  for (int i = 0; i < 20; i++) soup.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  FlatScene scene = soup.finish();
  scene.vertices[10].position[1] = NAN;
  EXPECT_THROW(build_tree(scene, GetParam()), Error);
  scene.vertices[10].position[1] = INFINITY;
  EXPECT_THROW(build_tree(scene, GetParam()), Error);
}

TEST_P(Trees, RefuseAnIdentityInstanceThatIsSmallerThanItsMesh) {
  Soup soup;
  soup.box(vec3(-1), vec3(1));
  FlatScene scene = soup.finish();
  scene.instances[0].upper[2] = std::nextafter(1.0f, 0.0f);
  EXPECT_THROW(build_tree(scene, GetParam()), Error);
}

// A tree of boxes in random order, as bad as trees get: reinsertion has to find much better ones, and to lose nothing.
TEST(Reinsertion, MakesABadTreeBetter) {
  Random random(51);
  constexpr uint leaves = 1024;
  BinaryTree tree;
  tree.nodes.resize(2 * leaves - 1);
  for (uint i = 0; i < leaves; i++) tree.items.push_back(i);
  for (uint i = 0; i < leaves - 1; i++) tree.nodes[i].first_child = 2 * i + 1;
  for (uint i = 2 * leaves - 1; i-- > 0;) {
    BinaryTree::Node &node = tree.nodes[i];
    Box box;
    if (i >= leaves - 1) {
      node.first_item = i - (leaves - 1);
      node.item_count = 1;
      const vec3 at = random.in_box(vec3(0), vec3(1));
      box = {at, at + 0.01f};
    } else {
      for (uint child = 2 * i + 1; child < 2 * i + 3; child++) {
        const auto &from = tree.nodes[child];
        box.include({vec3(from.lower[0], from.lower[1], from.lower[2]), vec3(from.upper[0], from.upper[1], from.upper[2])});
      }
    }
    for (int axis = 0; axis < 3; axis++) {
      node.lower[axis] = box.lower[axis];
      node.upper[axis] = box.upper[axis];
    }
  }
  const auto area = [&] {
    double sum = 0;
    for (const auto &n : tree.nodes) {
      const double x = n.upper[0] - n.lower[0], y = n.upper[1] - n.lower[1], z = n.upper[2] - n.lower[2];
      sum += x * y + y * z + z * x;
    }
    return sum;
  };
  const std::vector<BinaryTree::Node> leaves_before(tree.nodes.begin() + leaves - 1, tree.nodes.end());
  const double before = area();
  optimize_by_reinsertion(tree, 40);
  EXPECT_LT(area(), 0.5 * before);
  ASSERT_EQ(tree.nodes.size(), 2 * leaves - 1);
  ASSERT_EQ(tree.items.size(), leaves);
  EXPECT_EQ(std::set<uint>(tree.items.begin(), tree.items.end()).size(), leaves);
  EXPECT_EQ(tree.nodes[0].item_count, leaves);
  for (uint i = 0; i < tree.nodes.size(); i++) {
    const auto &node = tree.nodes[i];
    if (node.first_child == 0) {
      const auto &own = leaves_before[tree.items[node.first_item]];  // the box still goes with its item
      EXPECT_TRUE(std::equal(own.lower, own.lower + 3, node.lower) && std::equal(own.upper, own.upper + 3, node.upper));
      continue;
    }
    EXPECT_GT(node.first_child, i);
    const auto &a = tree.nodes[node.first_child], &b = tree.nodes[node.first_child + 1];
    EXPECT_EQ(a.first_item, node.first_item);
    EXPECT_EQ(b.first_item, a.first_item + a.item_count);
    EXPECT_EQ(node.item_count, a.item_count + b.item_count);
    for (int axis = 0; axis < 3; axis++) {
      EXPECT_EQ(node.lower[axis], std::min(a.lower[axis], b.lower[axis]));
      EXPECT_EQ(node.upper[axis], std::max(a.upper[axis], b.upper[axis]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Trees, testing::Values(Layout::binary, Layout::wide8, Layout::wide16), [](const auto &info) {
  return std::string(info.param == Layout::binary ? "binary" : info.param == Layout::wide8 ? "wide8" : "wide16");
});

}  // namespace
}  // namespace sunstone::hits
