// SPDX-License-Identifier: Apache-2.0
#include "kernels/hits/brute_force.h"

#include <algorithm>
#include <cstring>

#include "scene/traverse.h"

namespace sunstone::hits {
namespace {

using namespace kernel;

Ray kernel_ray(const TracedRay &from) {
  Ray ray;
  std::copy_n(from.ray.origin, 3, ray.origin);
  std::copy_n(from.ray.direction, 3, ray.direction);
  ray.t_max = from.ray.t_max;
  ray.passed_t = from.ray.passed_t;
  ray.passed_instance = from.passed_instance;
  ray.passed_primitive = from.passed_primitive;
  ray.time = from.time;
  return ray;
}

// A top tree of one node, so that the kernels' functions find the scene's bounds in it.
struct Bare {
  BinaryNode root{};
  TraceScene scene{};
  std::vector<kernel::Instance> instances;
  explicit Bare(const FlatScene &from) : instances(instances_with_keys(from)) {
    std::fill_n(root.lower, 3, INFINITY);
    std::fill_n(root.upper, 3, -INFINITY);
    for (const kernel::Instance &instance : from.instances)
      for (int axis = 0; axis < 3; axis++) {
        root.lower[axis] = std::min(root.lower[axis], instance.lower[axis]);
        root.upper[axis] = std::max(root.upper[axis], instance.upper[axis]);
      }
    scene.nodes = &root;
    scene.instances = instances.data();
    scene.motion = reinterpret_cast<const Motion *>(instances.data() + from.instances.size());
    scene.instance_count = uint(from.instances.size());
  }
};

// Calls tell(search, place, t, u, v, primitive) for what counts; it may take the hit into the search.
template <class Tell>
void each_hit(const FlatScene &flat, const Ray &ray, Search &search, Tell &&tell) {
  const Bare bare(flat);
  PreparedRay world, inside;
  if (flat.instances.empty() || !prepare_world_ray(&world, &bare.scene, &ray)) return;
  for (uint i = 0; i < flat.instances.size(); i++) {
    Place place;
    if (!enter_instance(&bare.scene, i, &ray, &world, &search, &inside, &place)) continue;
    const MeshRange &mesh = flat.meshes[flat.instance_mesh[i]];
    uint next = mesh.first_fragment;  // in the order of their triangles
    const uint last = next + mesh.fragment_count;
    for (uint k = mesh.first_triangle; k < mesh.first_triangle + mesh.triangle_count; k++) {
      // Before and after the ray's time.
      LeafTriangle leaves[2];
      for (uint key = 0; key < 2; key++) {
        const std::size_t first = mesh.deforms ? (place.moment.step + key) * flat.deforming : 0;
        for (int corner = 0; corner < 3; corner++) std::copy_n(flat.vertices[first + flat.triangles[k].vertex[corner]].position, 3, leaves[key].v + 3 * corner);
      }
      const LeafAt leaf{&leaves[0], &leaves[1], place.moment.blend};
      const auto try_leaf = [&](uint id) {
        leaves[0].id = id;
        Pierced pierced;
        float t, u, v;
        uint primitive;
        if (pierce(leaf, &inside, &pierced) &&
            counts(leaf, flat.fragments.data(), &inside, &place, &search, &pierced, 1, &t, &u, &v, &primitive))
          tell(search, place, t, u, v, primitive);
      };
      bool in_pieces = false;
      for (; next < last && flat.fragments[next].primitive == k; next++) in_pieces = true;
      try_leaf(flat.triangle_ids[k] | (in_pieces ? SUN_ID_FRAGMENT : 0));
    }
  }
}

TraceScene tree_scene(const FlatScene &scene, const Tree &tree, const std::vector<kernel::Instance> &instances) {
  return make_trace_scene(reinterpret_cast<const uchar *>(tree.nodes.data()), reinterpret_cast<const uchar *>(tree.leaves.data()),
                          tree.instance_list.data(), tree.roots.data(), tree.top_root, scene.fragments.data(), instances.data(), uint(scene.instances.size() - scene.plane_count), uint(scene.plane_count));
}

}  // namespace

Hit brute_force(const FlatScene &scene, const TracedRay &from, uint want) {
  const Ray ray = kernel_ray(from);
  Search search = begin_search(&ray, want);
  each_hit(scene, ray, search,
           [](Search &s, const Place &place, float t, float u, float v, uint primitive) { take_hit(&s, &place, t, u, v, primitive); });
  const Bare bare(scene);
  return hit_of_search(&bare.scene, &search);
}

std::vector<Hit> all_hits(const FlatScene &scene, const TracedRay &from, uint want) {
  const Ray ray = kernel_ray(from);
  Search search = begin_search(&ray, want);
  std::vector<Hit> hits;
  each_hit(scene, ray, search, [&](const Search &s, const Place &place, float t, float u, float v, uint primitive) {
    Search one = s;
    take_hit(&one, &place, t, u, v, primitive);
    const Bare bare(scene);
    hits.push_back(hit_of_search(&bare.scene, &one));
  });
  std::sort(hits.begin(), hits.end(), [](const Hit &a, const Hit &b) {
    return a.t != b.t ? a.t < b.t : a.instance != b.instance ? a.instance < b.instance : a.primitive < b.primitive;
  });
  return hits;
}

Hit host_closest(const FlatScene &scene, const Tree &binary, const TracedRay &ray, uint want) {
  const std::vector<kernel::Instance> instances = instances_with_keys(scene);
  const TraceScene trace = tree_scene(scene, binary, instances);
  return closest_hit(&trace, kernel_ray(ray), want);
}

bool host_any(const FlatScene &scene, const Tree &binary, const TracedRay &ray, uint want) {
  const std::vector<kernel::Instance> instances = instances_with_keys(scene);
  const TraceScene trace = tree_scene(scene, binary, instances);
  return any_hit(&trace, kernel_ray(ray), want) != 0;
}

bool same(const Hit &a, const Hit &b) { return std::memcmp(&a, &b, offsetof(Hit, pad)) == 0; }

}  // namespace sunstone::hits
