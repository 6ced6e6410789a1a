// SPDX-License-Identifier: Apache-2.0
// The whole of flatten: what enters the hash, limits, progress and the estimate.
#include "flatten/flatten.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "base/error.h"
#include "host/flatten/flatten_support.h"

namespace sunstone {
namespace {

// A scene with something in every array.
Scene full_scene() {
  Scene scene = scene_of(square(0), moved({0, 0, 1}));
  scene.meshes.push_back({"large", {bumpy(30, 1)}});
  for (int i = 0; i < 3; i++) scene.instances.push_back({"copy", 1, moved({float(i), 1, 2})});
  scene.images.push_back(byte_image(4, 4, 4, 8));
  scene.textures.push_back({0});
  Material &material = scene.materials.emplace_back();
  material.base_color_texture.texture = 0;
  material.normal_texture.texture = 0;
  material.emission = {1, 2, 3};
  scene.lights.emplace_back();
  scene.environment.kind = Environment::Kind::map;
  scene.environment.map = std::make_shared<Image>(float_image(4, 2, 3, {1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 2, 3, 4, 5, 6}));
  return scene;
}

TEST(Flatten, TheHashKnowsNeitherLayoutNorDevice) {
  const Scene scene = full_scene();
  const Hash hash = flattened(scene).scene_hash;
  for (Layout layout : {Layout::binary, Layout::wide8, Layout::wide16}) {
    FlattenOptions options;
    options.layout = layout;
    const FlatScene flat = flattened(scene, options);
    EXPECT_EQ(flat.scene_hash, hash);
    EXPECT_EQ(flat.tree.layout, layout);
  }
  FlattenOptions small;
  small.max_page_bytes = 1 << 20;
  EXPECT_EQ(flattened(scene, small).scene_hash, hash);
}

TEST(Flatten, TheHashChangesWithEveryInput) {
  const std::vector<std::function<void(Scene &)>> changes = {
      [](Scene &) {},
      [](Scene &s) { s.meshes[0].primitives[0].positions[1].x += 1e-6f; },
      [](Scene &s) { s.meshes[1].primitives[0].normals[5].x += 1e-2f; },
      [](Scene &s) { s.meshes[0].primitives[0].uv[0][2].y = 0.25f; },
      [](Scene &s) { s.meshes[0].primitives[0].colors.assign(4, glm::vec4(0.5f)); },
      [](Scene &s) { s.meshes[0].primitives[0].tangents.assign(4, glm::vec4(0, 1, 0, 1)); },
      [](Scene &s) { std::swap(s.meshes[0].primitives[0].indices[1], s.meshes[0].primitives[0].indices[2]); },
      [](Scene &s) { s.meshes[0].primitives[0].material = -1; },
      [](Scene &s) { s.instances[2].transform[3].z = 7; },
      [](Scene &s) { s.instances.push_back(s.instances[2]); },
      [](Scene &s) { std::get<0>(s.images[0].pixels)[17] ^= 1; },
      [](Scene &s) { s.textures[0].wrap_u = Wrap::mirror; },
      [](Scene &s) { s.textures[0].wrap_v = Wrap::clamp; },
      [](Scene &s) { s.textures[0].linear = false; },
      [](Scene &s) { s.materials[0].base_color_texture.uv_set = 1; },
      [](Scene &s) { s.materials[0].base_color_texture.transform[2].x = 0.5f; },
      [](Scene &s) { s.materials[0].base_color.y = 0.5f; },
      [](Scene &s) { s.materials[0].alpha_mode = AlphaMode::blend; },
      [](Scene &s) { s.materials[0].metallic = 0.5f; },
      [](Scene &s) { s.materials[0].roughness = 0.5f; },
      [](Scene &s) { s.materials[0].ior = 1.4f; },
      [](Scene &s) { s.materials[0].f0.x = 0.05f; },
      [](Scene &s) { s.materials[0].f90 = 0.5f; },
      [](Scene &s) { s.materials[0].transmission = 0.5f; },
      [](Scene &s) { s.materials[0].volume = true; },
      [](Scene &s) { s.materials[0].absorption.z = 0.5f; },
      [](Scene &s) { s.materials[0].emission.z = 4; },
      [](Scene &s) { s.materials[0].normal_scale = 0.5f; },
      [](Scene &s) { s.materials[0].double_sided = true; },
      [](Scene &s) { s.materials[0].unlit = true; },
      [](Scene &s) { s.lights[0].position.x = 1; },
      [](Scene &s) { s.lights[0].intensity.x = 2; },
      [](Scene &s) { s.lights[0].kind = Light::Kind::spot; },
      [](Scene &s) { s.lights.clear(); },
      [](Scene &s) { s.environment.strength = 2; },
      [](Scene &s) { s.environment.rotation = 0.25f; },
      [](Scene &s) { s.environment.kind = Environment::Kind::none; },
  };
  std::set<std::string> hashes;
  for (std::size_t i = 0; i < changes.size(); i++) {
    Scene scene = full_scene();
    changes[i](scene);
    EXPECT_TRUE(hashes.insert(flattened(scene).scene_hash.hex()).second) << "change " << i;
  }
}

TEST(Flatten, NamesAndCamerasAreNoPartOfTheHash) {
  Scene scene = full_scene();
  const Hash hash = flattened(scene).scene_hash;
  scene.name = "another";
  scene.instances[0].name = "renamed";
  scene.cameras.emplace_back();
  EXPECT_EQ(flattened(scene).scene_hash, hash);
}

TEST(Flatten, IsTheSameTwice) {
  const FlatScene a = flattened(full_scene()), b = flattened(full_scene());
  EXPECT_EQ(a.scene_hash, b.scene_hash);
  EXPECT_EQ(a.vertices.size(), b.vertices.size());
}

TEST(Flatten, ReportsItsProgress) {
  std::set<std::string> finished;
  FlattenOptions options;
  options.progress = [&](const char *what, double fraction) {
    EXPECT_TRUE(fraction >= 0 && fraction <= 1);
    if (fraction == 1) finished.insert(what);
  };
  flattened(full_scene(), options);
  for (const char *what : {"textures", "geometry", "emitters"}) EXPECT_TRUE(finished.count(what)) << what;
}

TEST(Flatten, RefusesWhatDoesNotFitIntoABuffer) {
  FlattenOptions options;
  options.max_page_bytes = 16 << 10;
  EXPECT_THROW(flattened(full_scene(), options), Error);
}

TEST(Flatten, TheEstimateIsNotBelowTheArrays) {
  const Scene scene = full_scene();
  const FlatScene flat = flattened(scene);
  const MemoryEstimate estimate = estimate_memory(scene, Layout::wide16);
  const std::size_t geometry = flat.vertices.size() * sizeof(kernel::Vertex) + flat.vertex_extras.size() * sizeof(kernel::VertexExtra) +
                               flat.triangles.size() * sizeof(kernel::Triangle) + flat.instances.size() * sizeof(kernel::Instance);
  EXPECT_GE(estimate.geometry, geometry);
  EXPECT_LE(estimate.geometry, 2 * geometry);
  EXPECT_EQ(estimate.textures, flat.texel_pages[0].size() * 4);
  EXPECT_GE(estimate.other, flat.emitters.size() * sizeof(kernel::Emitter) + (flat.environment_texels.size() + flat.environment_cdf.size()) * 4);
  EXPECT_GT(estimate.tree, 0u);
}

TEST(Flatten, LayoutNames) {
  for (Layout layout : {Layout::binary, Layout::wide8, Layout::wide16}) EXPECT_EQ(layout_from_name(layout_name(layout)), layout);
  EXPECT_THROW(layout_from_name("ternary"), UsageError);
}

}  // namespace
}  // namespace sunstone
