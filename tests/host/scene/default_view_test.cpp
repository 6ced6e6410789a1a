// SPDX-License-Identifier: Apache-2.0
#include "scene/default_view.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <ctime>

#include "base/error.h"
#include "scene/validate.h"

using namespace sunstone;

namespace {

void add_quad(Primitive &p, const glm::vec3 &corner, const glm::vec3 &u, const glm::vec3 &v) {
  const std::uint32_t first = static_cast<std::uint32_t>(p.positions.size());
  for (const glm::vec3 &q : {corner, corner + u, corner + u + v, corner + v}) p.positions.push_back(q);
  for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + k);
}

Scene scene_of(Primitive p, bool double_sided = true) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].double_sided = double_sided;
  p.material = 0;
  scene.meshes.push_back({"mesh", {std::move(p)}});
  scene.instances.push_back({"instance", 0, glm::mat4x3(1)});
  return scene;
}

// A box from -1 to 1 without the side that faces along `axis` (0 to 2) in the direction `sign`.
Primitive open_box(int axis, int sign) {
  Primitive p;
  for (int a = 0; a < 3; a++)
    for (const int s : {-1, 1}) {
      if (a == axis && s == sign) continue;
      glm::vec3 corner(-1), u(0), v(0);
      corner[a] = static_cast<float>(s);
      u[(a + 1) % 3] = 2;
      v[(a + 2) % 3] = 2;
      add_quad(p, corner, u, v);
    }
  return p;
}

glm::vec3 towards(const Camera &camera) { return camera.transform[2]; }

// Whether a point is in the picture, and how far from its middle (1: at the rim).
float rim(const Camera &camera, float aspect, const glm::vec3 &point) {
  const glm::vec3 d = point - camera.transform[3];
  const float depth = -glm::dot(d, camera.transform[2]), half = std::tan(camera.yfov / 2);
  if (depth <= 0) return INFINITY;
  return std::max(std::abs(glm::dot(d, camera.transform[0])) / (depth * half * aspect), std::abs(glm::dot(d, camera.transform[1])) / (depth * half));
}

}  // namespace

TEST(DefaultCamera, LooksIntoAnOpenBoxFromItsOpenSide) {
  for (const int axis : {0, 2})
    for (const int sign : {-1, 1}) {
      const Camera camera = default_camera(scene_of(open_box(axis, sign)), 1.5f);
      EXPECT_GT(towards(camera)[axis] * static_cast<float>(sign), 0.8f) << axis << " " << sign;
    }
  EXPECT_GT(towards(default_camera(scene_of(open_box(1, 1)), 1.5f)).y, 0.3f);
}

TEST(DefaultCamera, ShowsThreeSidesOfAClosedBox) {
  const glm::vec3 t = towards(default_camera(scene_of(open_box(3, 0)), 1.5f));
  EXPECT_GT(std::abs(t.x), 0.3f);
  EXPECT_GT(t.y, 0.3f);
  EXPECT_GT(t.z, 0.3f);
}

TEST(DefaultCamera, SeesSingleSidedWallsFromTheirFront) {
  Primitive front, back;
  add_quad(front, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  add_quad(back, {-1, -1, 0}, {0, 2, 0}, {2, 0, 0});
  EXPECT_GT(towards(default_camera(scene_of(front, false), 1)).z, 0.5f);
  EXPECT_LT(towards(default_camera(scene_of(back, false), 1)).z, -0.5f);
}

TEST(DefaultCamera, FramesTheBoundsAtEveryAspect) {
  Primitive p = open_box(3, 0);
  for (glm::vec3 &q : p.positions) q = q * glm::vec3(5, 0.3f, 2) + glm::vec3(100, -20, 7);
  const Scene scene = scene_of(p);
  for (const float aspect : {0.5f, 1.0f, 1.7777778f, 4.0f}) {
    const Camera camera = default_camera(scene, aspect);
    float most = 0;
    for (const glm::vec3 &q : p.positions) most = std::max(most, rim(camera, aspect, q));
    EXPECT_LE(most, 1) << aspect;
    EXPECT_GE(most, 0.7f) << aspect;
    EXPECT_NEAR(camera.yfov, 0.6981317f, 1e-6f);
    EXPECT_NEAR(glm::length(camera.transform[0]), 1, 1e-5f);
    EXPECT_NEAR(glm::dot(glm::cross(camera.transform[0], camera.transform[1]), camera.transform[2]), 1, 1e-5f);
  }
}

TEST(DefaultCamera, CopesWithNothingAndWithAPoint) {
  const Camera nothing = default_camera(Scene{}, 1);
  EXPECT_EQ(glm::vec3(nothing.transform[3]), glm::vec3(0, 0, 3));
  EXPECT_EQ(towards(nothing), glm::vec3(0, 0, 1));
  Primitive p;
  p.positions.assign(3, {4, 5, 6});
  p.indices = {0, 1, 2};
  const Camera point = default_camera(scene_of(p), 1);
  EXPECT_GT(glm::distance(glm::vec3(point.transform[3]), glm::vec3(4, 5, 6)), 0);
  EXPECT_TRUE(std::isfinite(point.transform[3].x));
}

TEST(DefaultCamera, IsQuickForAMillionTriangles) {
  Primitive p;
  const int n = 708;
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= n; j++) p.positions.push_back({i * 0.01f, std::sin(i * 0.05f) * std::cos(j * 0.05f), j * 0.01f});
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const std::uint32_t k = static_cast<std::uint32_t>(i * (n + 1) + j), row = n + 1;
      for (const std::uint32_t q : {k, k + 1, k + row, k + 1, k + row + 1, k + row}) p.indices.push_back(q);
    }
  const Scene scene = scene_of(std::move(p));
  const std::clock_t start = std::clock();
  const Camera first = default_camera(scene, 1.5f);
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  RecordProperty("milliseconds", static_cast<int>(seconds * 1000));
  std::printf("1 million triangles: %.1f ms\n", seconds * 1000);
  EXPECT_LT(seconds, 1.0);  // 0.05 on an idle machine; sanitizers take their share
  EXPECT_EQ(first.transform, default_camera(scene, 1.5f).transform);
}

TEST(LookCamera, LooksAndRefusesWhatHasNoDirection) {
  const Camera camera = look_camera({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.5f);
  EXPECT_EQ(towards(camera), glm::vec3(0, 0, 1));
  EXPECT_EQ(camera.focus_distance, 5);
  EXPECT_THROW(look_camera({1, 2, 3}, {1, 2, 3}, {0, 1, 0}, 0.5f), UsageError);
  EXPECT_THROW(look_camera({0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 0.5f), UsageError);
  EXPECT_THROW(look_camera({0, NAN, 0}, {0, 0, 0}, {0, 1, 0}, 0.5f), UsageError);
}

TEST(AddDefaults, GivesASkyOnlyWhereNothingEmits) {
  const auto notes = [](Scene scene) {
    Notices notices;
    add_defaults(scene, 1, "file", true, notices);
    for (const Notice &notice : notices.all()) EXPECT_EQ(notice.kind, Notice::Kind::note);
    EXPECT_EQ(scene.cameras.size(), 1u);
    return std::pair(scene.environment.kind, notices.all().size());
  };
  const Scene dark = scene_of(open_box(2, 1));
  EXPECT_EQ(notes(dark), std::pair(Environment::Kind::map, std::size_t(2)));
  Scene emissive = dark, lamp = dark, black_lamp = dark, sky = dark, camera = dark, unused = dark;
  emissive.materials[0].emission = {0, 1, 0};
  EXPECT_EQ(notes(emissive), std::pair(Environment::Kind::none, std::size_t(1)));
  lamp.lights.emplace_back();
  EXPECT_EQ(notes(lamp), std::pair(Environment::Kind::none, std::size_t(1)));
  black_lamp.lights.emplace_back().intensity = glm::vec3(0);
  EXPECT_EQ(notes(black_lamp), std::pair(Environment::Kind::map, std::size_t(2)));
  sky.environment.kind = Environment::Kind::constant;
  EXPECT_EQ(notes(sky), std::pair(Environment::Kind::constant, std::size_t(1)));
  camera.cameras.emplace_back();
  EXPECT_EQ(notes(camera), std::pair(Environment::Kind::map, std::size_t(1)));
  unused.materials.emplace_back().emission = glm::vec3(1);
  EXPECT_EQ(notes(unused), std::pair(Environment::Kind::map, std::size_t(2)));
}
