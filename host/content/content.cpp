// SPDX-License-Identifier: Apache-2.0
// The library's side of the table.
#include "content/content.h"

#include "bench/embree_reference.h"

static sunstone::TraversalReference embree(const sunstone::FlatScene &scene, const std::string &name, unsigned threads) {
  using namespace sunstone;
  const bool sixteen = name == "embree-16";
  const auto reference = std::make_shared<EmbreeReference>(scene, EmbreeOptions{name == "embree-robust", name != "embree-medium", threads});
  return {name, [=](std::span<const TraceRay> rays, bool any, std::span<kernel::Hit> hits) {
            return any ? reference->any(rays, hits) : sixteen ? reference->closest16(rays, hits) : reference->closest(rays, hits);
          }};
}

extern "C" __attribute__((visibility("default"))) const sunstone::Content *sunstone_content(std::size_t table_size) {
  static const sunstone::Content content = {
      .write_picture = sunstone::write_picture,
      .compare_images = sunstone::compare_images,
      .read_picture = sunstone::read_picture,
      .import_scene = sunstone::import_scene,
      .import_environment = sunstone::import_environment,
      .scene_bounds = sunstone::scene_bounds,
      .default_camera = sunstone::default_camera,
      .look_camera = sunstone::look_camera,
      .add_defaults = sunstone::add_defaults,
      .estimate_memory = sunstone::estimate_memory,
      .flatten = sunstone::flatten,
      .split_long_triangles = sunstone::split_long_triangles,
      .build_tree = sunstone::build_tree,
      .flatten_camera = sunstone::flatten_camera,
      .embree = embree,
  };
  return table_size == sizeof content ? &content : nullptr;
}
