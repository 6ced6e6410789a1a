// SPDX-License-Identifier: Apache-2.0
// Embree's builder makes a binary tree of each mesh and of the instances; layouts.cpp turns them into nodes. No hit depends on what the builder does.
#include "flatten/bvh.h"

#include <embree3/rtcore.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <numeric>
#include <string>

#include "base/error.h"
#include "flatten/layouts.h"
#include "flatten/reinsertion.h"

namespace sunstone {
namespace {

using kernel::uint;
using Node = BinaryTree::Node;

// Embree bounds its trees' depth by this; a tree that will not fit is built by halving instead. One entry a level waits in the binary layout.
constexpr unsigned max_depth = SUN_BINARY_STACK - 4;

struct Release {
  void operator()(RTCDeviceTy *device) const { rtcReleaseDevice(device); }
  void operator()(RTCBVHTy *bvh) const { rtcReleaseBVH(bvh); }
};
using Embree = std::unique_ptr<RTCDeviceTy, Release>;

std::string error_name(RTCError error) {
  switch (error) {
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "this CPU is not supported";
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "error " + std::to_string(int(error));
  }
}

// Bounds of all nodes from those of the items, so that they are exact whatever the builder made of them.
void fit_boxes(BinaryTree &tree, std::span<const RTCBuildPrimitive> boxes_by_item) {
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    Node &node = tree.nodes[i];
    std::fill_n(node.lower, 3, INFINITY);
    std::fill_n(node.upper, 3, -INFINITY);
    const auto include = [&](const float *lower, const float *upper) {
      for (int axis = 0; axis < 3; axis++) {
        node.lower[axis] = std::min(node.lower[axis], lower[axis]);
        node.upper[axis] = std::max(node.upper[axis], upper[axis]);
      }
    };
    if (node.first_child) {
      for (uint child = node.first_child; child < node.first_child + 2; child++) include(tree.nodes[child].lower, tree.nodes[child].upper);
    } else {
      for (uint k = node.first_item; k < node.first_item + node.item_count; k++) include(&boxes_by_item[k].lower_x, &boxes_by_item[k].upper_x);
    }
  }
}

// What Embree's callbacks make: an inner node has two children, a leaf has items.
struct Built {
  Built *child[2];
  const RTCBuildPrimitive *items;
  std::size_t item_count;
};

void *make_node(RTCThreadLocalAllocator allocator, unsigned, void *) { return new (rtcThreadLocalAlloc(allocator, sizeof(Built), 16)) Built{}; }
void set_children(void *node, void **children, unsigned count, void *) {
  for (unsigned i = 0; i < count; i++) static_cast<Built *>(node)->child[i] = static_cast<Built *>(children[i]);
}
void set_bounds(void *, const RTCBounds **, unsigned, void *) {}
void *make_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive *items, std::size_t count, void *) {
  void *copy = rtcThreadLocalAlloc(allocator, count * sizeof(RTCBuildPrimitive), 32);
  std::copy_n(items, count, static_cast<RTCBuildPrimitive *>(copy));
  return new (rtcThreadLocalAlloc(allocator, sizeof(Built), 16)) Built{{nullptr, nullptr}, static_cast<RTCBuildPrimitive *>(copy), count};
}

// Embree's tree in our order: both children of a node side by side, depth first.
BinaryTree read_built(const Built *root, std::size_t count) {
  BinaryTree tree;
  std::vector<RTCBuildPrimitive> boxes;
  tree.items.reserve(count);
  boxes.reserve(count);
  struct Open {
    const Built *built;
    uint node;
    std::size_t depth;
  };
  std::vector<Open> open{{root, 0, 1}};
  tree.nodes.emplace_back();
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    tree.depth = std::max(tree.depth, at.depth);
    Node &node = tree.nodes[at.node];
    node = Node{};
    node.first_item = uint(tree.items.size());
    if (at.built->child[0]) {
      const uint first = uint(tree.nodes.size());
      node.first_child = first;
      tree.nodes.resize(first + 2);
      open.push_back({at.built->child[1], first + 1, at.depth + 1});
      open.push_back({at.built->child[0], first, at.depth + 1});
    } else {
      node.item_count = uint(at.built->item_count);
      for (std::size_t i = 0; i < at.built->item_count; i++) {
        tree.items.push_back(at.built->items[i].primID);
        boxes.push_back(at.built->items[i]);
      }
    }
  }
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    Node &node = tree.nodes[i];
    if (node.first_child) node.item_count = tree.nodes[node.first_child].item_count + tree.nodes[node.first_child + 1].item_count;
  }
  fit_boxes(tree, boxes);
  return tree;
}

// Halves at the median centre along the longest axis: no SAH, but a depth of log2 for any input at all.
BinaryTree build_by_halving(std::span<const RTCBuildPrimitive> boxes, unsigned leaf_items) {
  BinaryTree tree;
  std::vector<uint> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  struct Open {
    uint node, first, count;
    std::size_t depth;
  };
  std::vector<Open> open{{0, 0, uint(boxes.size()), 1}};
  tree.nodes.emplace_back();
  const auto middle = [&](uint box, int axis) { return 0.5f * (&boxes[box].lower_x)[axis] + 0.5f * (&boxes[box].upper_x)[axis]; };
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    tree.depth = std::max(tree.depth, at.depth);
    tree.nodes[at.node] = Node{};
    tree.nodes[at.node].first_item = at.first;
    tree.nodes[at.node].item_count = at.count;
    if (at.count <= leaf_items) continue;
    const auto begin = order.begin() + at.first, end = begin + at.count;
    int longest = 0;
    float extent = -1.0f;
    for (int axis = 0; axis < 3; axis++) {
      const auto [low, high] = std::minmax_element(begin, end, [&](uint a, uint b) { return middle(a, axis) < middle(b, axis); });
      if (middle(*high, axis) - middle(*low, axis) > extent) {
        extent = middle(*high, axis) - middle(*low, axis);
        longest = axis;
      }
    }
    const uint half = at.count / 2;
    std::nth_element(begin, begin + half, end, [&](uint a, uint b) { return middle(a, longest) < middle(b, longest); });
    const uint first = uint(tree.nodes.size());
    tree.nodes[at.node].first_child = first;
    tree.nodes.resize(first + 2);
    open.push_back({first + 1, at.first + half, at.count - half, at.depth + 1});
    open.push_back({first, at.first, half, at.depth + 1});
  }
  std::vector<RTCBuildPrimitive> ordered;
  ordered.reserve(order.size());
  for (const uint i : order) ordered.push_back(boxes[i]);
  for (const RTCBuildPrimitive &box : ordered) tree.items.push_back(box.primID);
  fit_boxes(tree, ordered);
  return tree;
}

// Embree's tree by SAH (it reorders the boxes); an empty one where it would be deeper than it may.
BinaryTree build_by_sah(RTCDevice embree, std::vector<RTCBuildPrimitive> &boxes, unsigned leaf_items) {
  const std::unique_ptr<RTCBVHTy, Release> bvh(rtcNewBVH(embree));
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;  // "high" is the same without spatial splits
  arguments.maxBranchingFactor = 2;
  arguments.maxDepth = max_depth;
  arguments.sahBlockSize = leaf_items;
  arguments.minLeafSize = 1;
  arguments.maxLeafSize = leaf_items;
  arguments.bvh = bvh.get();
  arguments.primitives = boxes.data();
  arguments.primitiveCount = boxes.size();
  arguments.primitiveArrayCapacity = boxes.size();
  arguments.createNode = make_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = make_leaf;
  const void *root = rtcBuildBVH(&arguments);
  const RTCError error = rtcGetDeviceError(embree);
  if (error == RTC_ERROR_OUT_OF_MEMORY || error == RTC_ERROR_CANCELLED) throw Error{"tree", "Embree: " + error_name(error)};
  if (!root || error != RTC_ERROR_NONE) return {};
  BinaryTree tree = read_built(static_cast<const Built *>(root), boxes.size());
  if (tree.depth > max_depth) return {};
  optimize_by_reinsertion(tree, 1);  // a second pass gains a quarter of the first
  if (tree.depth > max_depth) tree = read_built(static_cast<const Built *>(root), boxes.size());
  return tree;
}

// Boxes beyond this overflow areas: they are not worth a SAH.
constexpr float sah_limit = 1e18f;

template <class LayOut>
TreePart build_part(RTCDevice embree, std::vector<RTCBuildPrimitive> &boxes, unsigned leaf_items, Layout layout, LayOut &&lay_out) {
  const bool moderate = std::all_of(boxes.begin(), boxes.end(), [](const auto &box) {
    return std::max({std::fabs(box.lower_x), std::fabs(box.lower_y), std::fabs(box.lower_z), std::fabs(box.upper_x), std::fabs(box.upper_y),
                     std::fabs(box.upper_z)}) < sah_limit;
  });
  if (moderate && boxes.size() > leaf_items) {
    const BinaryTree tree = build_by_sah(embree, boxes, leaf_items);
    if (!tree.nodes.empty()) {
      TreePart part = lay_out(tree);
      if (part.stack <= stack_entries(layout)) return part;
    }
  }
  TreePart part = lay_out(build_by_halving(boxes, leaf_items));
  if (part.stack > stack_entries(layout)) throw Error{"tree", "needs a deeper stack than the kernels have"};  // beyond 2^30 items only
  return part;
}

// Of triangles that are whole, and of the fragments of those that are not. What deforms is within its box at all keys, and so between them.
std::vector<RTCBuildPrimitive> item_boxes(const FlatScene &scene, const MeshRange &mesh) {
  std::vector<RTCBuildPrimitive> boxes;
  boxes.reserve(mesh.triangle_count + mesh.fragment_count);
  const std::span fragments = std::span(scene.fragments).subspan(mesh.first_fragment, mesh.fragment_count);
  std::size_t next = 0;
  for (uint i = mesh.first_triangle; i < mesh.first_triangle + mesh.triangle_count; i++) {
    if (next == fragments.size() || fragments[next].primitive != i) {
      boxes.push_back({});
      boxes.back().primID = i;
    }
    for (; next < fragments.size() && fragments[next].primitive == i; next++) {
      const kernel::Fragment &f = fragments[next];
      boxes.push_back({f.lower[0], f.lower[1], f.lower[2], 0, f.upper[0], f.upper[1], f.upper[2], SUN_ID_FRAGMENT | uint(mesh.first_fragment + next)});
    }
  }
  tbb::parallel_for(std::size_t(0), boxes.size(), [&](std::size_t i) {
    RTCBuildPrimitive &box = boxes[i];
    if (box.primID & SUN_ID_FRAGMENT) return;
    const kernel::Triangle &triangle = scene.triangles[box.primID];
    for (int axis = 0; axis < 3; axis++) {
      float lower = INFINITY, upper = -INFINITY;
      for (std::size_t key = 0; key < mesh_keys(scene, mesh); key++)
        for (const uint vertex : triangle.vertex) {
          const float x = scene.vertices[vertex + key * scene.deforming].position[axis];
          if (!std::isfinite(x)) throw Error{"tree", "triangle " + std::to_string(box.primID) + " has a corner that is not finite"};
          lower = std::min(lower, x);
          upper = std::max(upper, x);
        }
      (&box.lower_x)[axis] = lower;
      (&box.upper_x)[axis] = upper;
    }
  });
  return boxes;
}

// A mesh without triangles: a leaf whose one triangle is NaN, which no ray hits.
TreePart empty_part(Layout layout) {
  TreePart part;
  part.depth = part.stack = 1;
  part.leaf_count = 1;
  if (layout == Layout::binary) {
    kernel::BinaryNode node{{0, 0, 0}, 0, {0, 0, 0}, 1};
    kernel::LeafTriangle leaf{};
    std::fill_n(leaf.v, 9, NAN);
    part.node_count = 1;
    part.nodes.resize(sizeof node);
    part.leaves.resize(sizeof leaf);
    std::memcpy(part.nodes.data(), &node, sizeof node);
    std::memcpy(part.leaves.data(), &leaf, sizeof leaf);
  } else {
    kernel::WidePack pack{};
    for (auto &row : pack.v) std::fill(std::begin(row), std::end(row), NAN);
    part.root = SUN_WIDE_LEAF;
    part.leaves.resize(sizeof pack);
    std::memcpy(part.leaves.data(), &pack, sizeof pack);
  }
  return part;
}

// Flat scenes skip the world box of an identity instance, since it has to contain every box of its mesh.
void check_identity_boxes(const FlatScene &scene, std::span<const Bounds> mesh_bounds) {
  for (std::size_t i = 0; i < scene.instances.size(); i++) {
    const kernel::Instance &instance = scene.instances[i];
    const Bounds &bounds = mesh_bounds[scene.instance_mesh[i]];
    if (!(instance.flags & SUN_INSTANCE_IDENTITY) || bounds.empty()) continue;
    for (int axis = 0; axis < 3; axis++)
      if (!(instance.lower[axis] <= bounds.lower[axis]) || !(instance.upper[axis] >= bounds.upper[axis]))
        throw Error{"tree", "the box of instance " + std::to_string(i) + " does not contain its mesh"};
  }
}

Bounds bounds_of(std::span<const RTCBuildPrimitive> boxes) {
  Bounds bounds;
  for (const auto &box : boxes) {
    bounds.lower = glm::min(bounds.lower, glm::vec3(box.lower_x, box.lower_y, box.lower_z));
    bounds.upper = glm::max(bounds.upper, glm::vec3(box.upper_x, box.upper_y, box.upper_z));
  }
  return bounds;
}

TreePart build_top(RTCDevice embree, const FlatScene &scene, Layout layout) {
  std::vector<RTCBuildPrimitive> boxes(scene.instances.size() - scene.plane_count, RTCBuildPrimitive{});
  for (std::size_t i = 0; i < boxes.size(); i++) {
    const kernel::Instance &instance = scene.instances[i];
    boxes[i].geomID = 0;
    boxes[i].primID = uint(i);
    if (scene.meshes[scene.instance_mesh[i]].triangle_count == 0) continue;  // nothing to hit: its box may be empty
    for (int axis = 0; axis < 3; axis++) {
      if (!(instance.lower[axis] <= instance.upper[axis]) || !std::isfinite(instance.lower[axis]) || !std::isfinite(instance.upper[axis]))
        throw Error{"tree", "the box of instance " + std::to_string(i) + " is empty or not finite"};
      (&boxes[i].lower_x)[axis] = instance.lower[axis];
      (&boxes[i].upper_x)[axis] = instance.upper[axis];
    }
  }
  return build_part(embree, boxes, 1, layout, [&](const BinaryTree &tree) { return lay_out_instances(tree, layout); });
}

}  // namespace

Tree build_tree(const FlatScene &scene, Layout layout, const std::function<void(const char *what, double fraction)> &progress) {
  const Embree embree(rtcNewDevice(nullptr));
  if (!embree) throw Error{"tree", "Embree: " + error_name(rtcGetDeviceError(nullptr))};

  std::vector<TreePart> parts(scene.meshes.size());
  std::vector<Bounds> mesh_bounds(scene.meshes.size());
  std::mutex mutex;
  std::size_t done = 0;
  const auto report = [&](std::size_t triangles) {
    if (!progress) return;
    const std::lock_guard lock(mutex);
    done += triangles;
    progress("building the tree", scene.triangles.empty() ? 1.0 : std::min(1.0, double(done) / double(scene.triangles.size())));
  };
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
    const MeshRange &mesh = scene.meshes[i];
    if (mesh.triangle_count == 0) {
      parts[i] = empty_part(layout);
      return;
    }
    std::vector<RTCBuildPrimitive> boxes = item_boxes(scene, mesh);
    mesh_bounds[i] = bounds_of(boxes);
    parts[i] =
        build_part(embree.get(), boxes, leaf_triangles(layout), layout, [&](const BinaryTree &tree) { return lay_out_mesh(tree, layout, scene, mesh_keys(scene, mesh)); });
    report(mesh.triangle_count);
  });
  check_identity_boxes(scene, mesh_bounds);

  Tree tree;
  tree.layout = layout;
  std::vector<uint> mesh_roots(parts.size());
  std::size_t node_total = 0, leaf_total = 0;
  for (const TreePart &part : parts) {
    node_total += part.nodes.size();
    leaf_total += part.leaves.size();
  }
  if (parts.size() > 1) {
    tree.nodes.reserve(node_total);
    tree.leaves.reserve(leaf_total);
  }
  for (std::size_t i = 0; i < parts.size(); i++) mesh_roots[i] = append_part(tree, std::exchange(parts[i], {}));
  for (std::size_t i = 0; i < scene.instances.size(); i++) {
    const uint mesh = scene.instance_mesh[i];
    tree.roots.push_back(scene.instances[i].flags & SUN_INSTANCE_SHAPE ? scene.meshes[mesh].first_triangle : mesh_roots.at(mesh));
  }
  if (scene.instances.size() - scene.plane_count > 1) tree.top_root = append_part(tree, build_top(embree.get(), scene, layout));
  return tree;
}

}  // namespace sunstone
