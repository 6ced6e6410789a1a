// SPDX-License-Identifier: Apache-2.0
#include "pipeline/upload.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "base/error.h"

namespace sunstone {

namespace {

// Puts arrays one behind the other, in words.
class Records {
 public:
  template <class T> kernel::uint add(const std::vector<T> &values) {
    static_assert(sizeof(T) % sizeof(kernel::uint) == 0);
    // Each begins on a cache line.
    words_.resize((words_.size() + 15) / 16 * 16);
    const std::size_t at = words_.size(), size = values.size() * (sizeof(T) / sizeof(kernel::uint));
    if (at + size > SUN_NONE) throw Error("records", "the tables of this scene have more than 2^32 words");
    words_.resize(at + size);
    if (size) std::memcpy(words_.data() + at, values.data(), size * sizeof(kernel::uint));
    return static_cast<kernel::uint>(at);
  }
  const std::vector<kernel::uint> &words() {
    // An empty table at the end still has an address to read for lanes that are switched off.
    words_.resize(words_.size() + 64);
    return words_;
  }

 private:
  std::vector<kernel::uint> words_;
};

template <class T> std::size_t bytes_of(const std::vector<T> &values) { return values.size() * sizeof(T); }

}  // namespace

DeviceScene upload(const Device &device, const FlatScene &scene, std::span<const float> filter, kernel::Frame &frame) {
  Records records;
  std::vector<float> tables = scene.tables;
  tables.resize(SUN_TABLE_FLOATS);
  std::ranges::copy(filter, tables.begin() + SUN_TABLE_FILTER);
  frame.at_triangle_emitter = records.add(scene.triangle_emitter);
  frame.at_triangle_object = records.add(scene.triangle_object);
  frame.at_instance_object = records.add(scene.instance_object);
  frame.at_materials = records.add(scene.materials);
  frame.at_texture_refs = records.add(scene.texture_refs);
  frame.at_textures = records.add(scene.textures);
  frame.at_emitters = records.add(scene.emitters);
  std::vector<kernel::Light> lights = scene.lights;
  lights.insert(lights.end(), scene.light_keys.begin(), scene.light_keys.end());
  frame.at_lights = records.add(lights);
  frame.at_tables = records.add(tables);
  frame.at_environment_texels = records.add(scene.environment_texels);
  frame.at_environment_cdf = records.add(scene.environment_cdf);
  const std::vector<kernel::uint> &words = records.words();

  std::vector<kernel::Instance> with_keys;
  if (scene.motion_steps) with_keys = instances_with_keys(scene);
  const std::vector<kernel::Instance> &instances = scene.motion_steps ? with_keys : scene.instances;
  std::size_t bytes = bytes_of(scene.tree.nodes) + bytes_of(scene.tree.leaves) + bytes_of(scene.fragments) + bytes_of(scene.vertices) + bytes_of(scene.vertex_extras) +
                      bytes_of(scene.triangles) + bytes_of(instances) + bytes_of(words);
  for (const auto &page : scene.texel_pages) bytes += bytes_of(page);
  if (bytes + device.allocated() > device.info().memory)
    throw Error(device.info().name, fmt::format("the scene needs {:.1f} MiB, the device has {:.1f} MiB", static_cast<double>(bytes) / 1048576.0,
                                                static_cast<double>(device.info().memory) / 1048576.0),
                "choose another --device, or a smaller scene");
  DeviceScene on;
  on.bytes = bytes;
  on.nodes = Buffer<std::byte>(device, scene.tree.nodes, "nodes of the tree");
  on.leaves = Buffer<std::byte>(device, scene.tree.leaves, "leaves of the tree");
  on.instance_list = Buffer<kernel::uint>(device, scene.tree.instance_list, "instance list");
  on.roots = Buffer<kernel::uint>(device, scene.tree.roots, "roots");
  on.fragments = Buffer<kernel::Fragment>(device, scene.fragments, "fragments");
  on.vertices = Buffer<kernel::Vertex>(device, scene.vertices, "vertices");
  on.extras = Buffer<kernel::VertexExtra>(device, scene.vertex_extras, "vertex extras");
  on.triangles = Buffer<kernel::Triangle>(device, scene.triangles, "triangles");
  on.instances = Buffer<kernel::Instance>(device, instances, "instances");
  on.records = Buffer<kernel::uint>(device, words, "tables of the scene");
  for (std::size_t i = 0; i < on.pages.size(); i++) on.pages[i] = Buffer<kernel::uint>(device, scene.texel_pages[i], fmt::format("texture page {}", i));
  on.top_root = scene.tree.top_root;

  frame.environment = scene.environment;
  frame.emitter_count = static_cast<kernel::uint>(scene.emitters.size());
  frame.instance_count = static_cast<kernel::uint>(scene.instances.size() - scene.plane_count);
  frame.light_count = static_cast<kernel::uint>(scene.lights.size());
  frame.motion_steps = scene.motion_steps;
  frame.plane_count = static_cast<kernel::uint>(scene.plane_count);
  frame.first_shape = static_cast<kernel::uint>(scene.instances.size() - scene.shape_count);
  Bounds known;
  for (std::size_t i = 0; i < frame.instance_count; i++)
    for (int axis = 0; axis < 3; axis++) {
      known.lower[axis] = std::min(known.lower[axis], scene.instances[i].lower[axis]);
      known.upper[axis] = std::max(known.upper[axis], scene.instances[i].upper[axis]);
    }
  for (int axis = 0; axis < 3; axis++) {
    frame.lower[axis] = known.lower[axis];
    frame.upper[axis] = known.upper[axis];
  }
  if (scene.vertex_extras.size() == scene.vertices.size() && scene.vertices.size() > 0 && scene.has_textures) frame.flags |= SUN_FRAME_EXTRAS;
  if (!scene.bounds.empty()) {
    const glm::vec3 center = (scene.bounds.lower + scene.bounds.upper) * 0.5f, half = scene.bounds.upper - center;
    for (int axis = 0; axis < 3; axis++) frame.scene_center[axis] = center[axis];
    frame.scene_radius = std::sqrt(half.x * half.x + half.y * half.y + half.z * half.z);
  }
  return on;
}

}  // namespace sunstone
