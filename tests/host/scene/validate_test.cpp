// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.h"

using namespace sunstone;

namespace {

// One triangle of one material.
Scene small_scene() {
  Scene scene;
  scene.materials.resize(1);
  Primitive p;
  p.material = 0;
  p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  p.indices = {0, 1, 2};
  scene.meshes.push_back({"mesh", {p}});
  scene.instances.push_back({"instance", 0, glm::mat4x3(1)});
  return scene;
}

Primitive &primitive(Scene &scene) { return scene.meshes[0].primitives[0]; }

struct Result {
  std::string error;
  std::vector<Notice> notices;
};

Result run(Scene &scene) {
  Notices notices;
  Result result;
  try {
    validate(scene, "file", notices);
  } catch (const Error &error) {
    result.error = error.what();
  }
  result.notices = notices.all();
  return result;
}

Scene changed(const std::function<void(Scene &)> &change) {
  Scene scene = small_scene();
  change(scene);
  return scene;
}

}  // namespace

TEST(Validate, AGoodSceneIsLeftAlone) {
  Scene scene = small_scene();
  primitive(scene).normals.assign(3, {0, 0, 1});
  const Result result = run(scene);
  EXPECT_EQ(result.error, "");
  EXPECT_TRUE(result.notices.empty());
  EXPECT_EQ(primitive(scene).indices.size(), 3u);
}

TEST(Validate, WhatPointsNowhereIsRefusedByName) {
  const std::vector<std::pair<std::function<void(Scene &)>, const char *>> faults = {
      {[](Scene &s) { primitive(s).indices[1] = 3; }, "meshes[0] \"mesh\".primitives[0]: vertex index 3, but there are 3 vertices"},
      {[](Scene &s) { primitive(s).indices.push_back(0); }, "not a multiple of 3"},
      {[](Scene &s) { primitive(s).material = 1; }, "material: index 1, but there are 1"},
      {[](Scene &s) { primitive(s).uv[0].resize(2); }, "3 positions, but 2 texture coordinates"},
      {[](Scene &s) { primitive(s).colors.resize(4); }, "3 positions, but 4 colours"},
      {[](Scene &s) { s.instances[0].mesh = 1; }, "instances[0] \"instance\": mesh: index 1"},
      {[](Scene &s) { s.instances[0].mesh = -1; }, "mesh: index -1"},
      {[](Scene &s) { s.materials[0].normal_texture.texture = 0; }, "normal_texture: index 0, but there are 0"},
      {[](Scene &s) { s.materials[0].emission_texture.uv_set = 2; }, "texture coordinate set 2"},
      {[](Scene &s) {
         s.textures.push_back({5, Wrap::repeat, Wrap::repeat, true});
       },
       "textures[0]: image: index 5"},
      {[](Scene &s) {
         s.images.push_back({"picture", 4, 4, 3, std::vector<float>(7)});
       },
       "images[0] \"picture\""},
      {[](Scene &s) { s.cameras.emplace_back().yfov = 0; }, "cameras[0]: a vertical angle of 0"},
      {[](Scene &s) { s.cameras.emplace_back().aspect = -1.0f; }, "aspect ratio of -1"},
      {[](Scene &s) { s.cameras.emplace_back().transform[0] = glm::vec3(0); }, "singular"},
      {[](Scene &s) { s.lights.emplace_back().direction = glm::vec3(0); }, "lights[0]"},
      {[](Scene &s) { s.lights.emplace_back().position.x = NAN; }, "lights[0]: its position"},
  };
  for (const auto &[change, text] : faults) {
    Scene scene = changed(change);
    const Result result = run(scene);
    EXPECT_NE(result.error.find(text), std::string::npos) << "wanted " << text << ", got " << result.error;
    EXPECT_TRUE(result.error.starts_with("file: ")) << result.error;
  }
}

TEST(Validate, BadTrianglesAreDroppedWithOneWarning) {
  Scene scene = small_scene();
  Primitive &p = primitive(scene);
  for (const float bad : {NAN, INFINITY, 3e38f, -2e18f}) {
    p.positions.push_back({bad, 0, 0});
    p.indices.insert(p.indices.end(), {0, 1, static_cast<std::uint32_t>(p.positions.size() - 1)});
  }
  const Result result = run(scene);
  EXPECT_EQ(result.error, "");
  ASSERT_EQ(result.notices.size(), 1u);
  EXPECT_NE(result.notices[0].text.find("4 of 5 triangles dropped"), std::string::npos) << result.notices[0].text;
  EXPECT_EQ(primitive(scene).indices, (std::vector<std::uint32_t>{0, 1, 2}));
  const Bounds bounds = scene_bounds(scene);
  EXPECT_EQ(bounds.lower, glm::vec3(0));
  EXPECT_EQ(bounds.upper, glm::vec3(1, 1, 0));
}

TEST(Validate, MeshesLeftEmptyGoWithTheirInstances) {
  Scene scene = small_scene();
  scene.meshes.insert(scene.meshes.begin(), scene.meshes[0]);
  for (glm::vec3 &p : scene.meshes[0].primitives[0].positions) p.x = NAN;
  scene.instances.push_back({"second", 1, glm::mat4x3(1)});
  EXPECT_EQ(run(scene).error, "");
  ASSERT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "second");
  EXPECT_EQ(scene.instances[0].mesh, 0);
}

TEST(Validate, SingularInstancesAreDropped) {
  for (const glm::mat4x3 &transform :
       {glm::mat4x3(0), glm::mat4x3(glm::vec3(1, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 0, 1), glm::vec3(0)), glm::mat4x3(NAN),
        glm::mat4x3(glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(INFINITY))}) {
    Scene scene = small_scene();
    scene.instances[0].transform = transform;
    const Result result = run(scene);
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_EQ(result.notices.size(), 1u);
  }
  Scene tiny = small_scene();
  tiny.instances[0].transform = glm::mat4x3(1e-6f);
  run(tiny);
  EXPECT_EQ(tiny.instances.size(), 1u);
}

TEST(Validate, FactorsAreClampedWithOneWarningAKind) {
  Scene scene = small_scene();
  for (int i = 0; i < 5; i++) scene.materials.push_back(scene.materials[0]);
  for (Material &m : scene.materials) {
    m.roughness = 7;
    m.base_color = {2, NAN, -1};
    m.emission = {-3, INFINITY, 1};
    m.ior = 0;
  }
  const Result result = run(scene);
  EXPECT_EQ(result.error, "");
  EXPECT_LE(result.notices.size(), 8u);
  for (const Material &m : scene.materials) {
    EXPECT_EQ(m.roughness, 1);
    EXPECT_EQ(m.base_color, glm::vec3(1, 0.5f, 0));
    EXPECT_EQ(m.emission.x, 0);
    EXPECT_TRUE(std::isfinite(m.emission.y));
    EXPECT_EQ(m.ior, 1);
  }
}

TEST(Validate, NormalsGetUnitLengthAndLostOnesAreMade) {
  Scene scene = small_scene();
  primitive(scene).normals = {{0, 0, 5}, {0, 0, 0}, {NAN, 0, 0}};
  const Result result = run(scene);
  EXPECT_EQ(result.notices.size(), 1u);
  for (const glm::vec3 &n : primitive(scene).normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST(Validate, LightsAreBroughtIntoRange) {
  Scene scene = small_scene();
  Light light;
  light.kind = Light::Kind::spot;
  light.intensity = {-40, 1, 1};
  light.inner_angle = 1;
  light.outer_angle = 0.5f;
  light.direction = {0, 0, -3};
  scene.lights.push_back(light);
  EXPECT_EQ(run(scene).error, "");
  EXPECT_EQ(scene.lights[0].intensity.x, 0);
  EXPECT_EQ(scene.lights[0].inner_angle, 0.5f);
  EXPECT_EQ(scene.lights[0].direction, glm::vec3(0, 0, -1));
}

TEST(SceneBounds, FollowTransformsExactly) {
  Scene scene = small_scene();
  const float c = std::sqrt(0.5f);
  scene.instances[0].transform = glm::mat4x3(glm::vec3(c, c, 0), glm::vec3(-c, c, 0), glm::vec3(0, 0, 1), glm::vec3(10, 0, 0));
  const Bounds bounds = scene_bounds(scene);
  EXPECT_FLOAT_EQ(bounds.lower.x, 10 - c);
  EXPECT_FLOAT_EQ(bounds.upper.x, 10 + c);
  EXPECT_FLOAT_EQ(bounds.upper.y, c);
  EXPECT_TRUE(scene_bounds(Scene{}).empty());
}
