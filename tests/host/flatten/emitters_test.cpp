// SPDX-License-Identifier: Apache-2.0
// The emitters' order, powers and numbers, and punctual lights as the kernels see them.
#include "flatten/emitters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/flatten/flatten_support.h"
#include "scene/emitter.h"

namespace sunstone {
namespace {

constexpr double pi = 3.141592653589793;

Scene glowing(float radiance = 1) {
  Scene scene = scene_of(square(0));
  scene.materials.emplace_back().emission = glm::vec3(radiance);
  return scene;
}

TEST(Emitters, TrianglesByAreaAndSides) {
  Scene scene = glowing();
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].double_sided = true;
  scene.meshes.push_back({"large", {square(1)}});
  scene.instances.push_back({"large", 1, moved({0, 0, 5}, 3)});
  const FlatScene flat = flattened(scene);
  ASSERT_EQ(flat.emitters.size(), 4u);
  // Areas 2, 2, 18, 18; the large ones count twice: 2 + 2 + 36 + 36 = 76.
  EXPECT_NEAR(flat.emitters[0].pmf, 2 / 76.0, 1e-6);
  EXPECT_NEAR(flat.emitters[3].pmf, 36 / 76.0, 1e-6);
  for (kernel::uint i = 0; i < 4; i++) {
    EXPECT_EQ(flat.emitters[i].kind, kernel::uint(SUN_EMITTER_TRIANGLE));
    EXPECT_EQ(flat.emitters[i].a, 0u);
    EXPECT_EQ(flat.emitters[i].b, i);
    EXPECT_EQ(flat.triangle_emitter[i], i);
  }
  EXPECT_EQ(flat.instances[0].first_emitter, 0u);
}

TEST(Emitters, AHitFindsItsEmitterInEveryInstance) {
  Primitive primitive = bumpy(30, 3);
  primitive.material = 1;
  Primitive lamp = square(0);
  Scene scene = glowing();
  scene.materials.emplace_back();
  scene.meshes[0].primitives = {primitive, lamp};
  for (int i = 1; i < 4; i++) scene.instances.push_back({"copy", 0, moved({float(i) * 4, 0, 0}, float(i))});
  const FlatScene flat = flattened(scene);
  ASSERT_EQ(flat.instances.size(), 4u);
  ASSERT_EQ(flat.emitters.size(), 8u);
  double sum = 0;
  for (kernel::uint i = 0; i < 4; i++)
    for (kernel::uint t = 0; t < flat.triangles.size(); t++) {
      if (flat.triangle_emitter[t] == SUN_NONE) continue;
      const kernel::Emitter &emitter = flat.emitters[flat.instances[i].first_emitter + flat.triangle_emitter[t]];
      EXPECT_EQ(emitter.a, i);
      EXPECT_EQ(emitter.b, t);
      EXPECT_NEAR(emitter.pmf, (i ? double(i * i) : 1) / 30, 1e-6);  // 2 (1 + 1 + 4 + 9)
      sum += emitter.pmf;
    }
  EXPECT_EQ(sum, 1.0);
}

TEST(Emitters, NothingEmitsInTheDark) {
  const FlatScene flat = flattened(scene_of(square()));
  EXPECT_TRUE(flat.emitters.empty());
  EXPECT_EQ(flat.instances[0].first_emitter, SUN_NONE);
  EXPECT_EQ(flat.environment.emitter, SUN_NONE);
}

TEST(Emitters, EveryKindByItsPower) {
  Scene scene = glowing(2);  // two triangles of area 2
  Light point, spot, sun, dark;
  point.intensity = glm::vec3(3);
  spot.kind = Light::Kind::spot;
  spot.intensity = glm::vec3(5);
  spot.inner_angle = 0.3f;
  spot.outer_angle = 0.7f;
  sun.kind = Light::Kind::directional;
  sun.intensity = glm::vec3(7);
  dark.intensity = glm::vec3(0);
  scene.lights = {dark, point, spot, sun};
  scene.environment.kind = Environment::Kind::constant;
  scene.environment.constant = glm::vec3(0.25f);
  const FlatScene flat = flattened(scene);
  ASSERT_EQ(flat.lights.size(), 3u);
  ASSERT_EQ(flat.emitters.size(), 6u);
  const double disk = pi * 2;  // the square's half diagonal is sqrt 2
  // The spot's by numerical integration of its falloff.
  double cone = 0;
  for (int i = 0; i < 100000; i++) {
    const double c = -1 + 2 * (i + 0.5) / 100000;
    const double ramp = std::min(std::max((c - std::cos(0.7)) / (std::cos(0.3) - std::cos(0.7)), 0.0), 1.0);
    cone += ramp * ramp * 2 * pi * 2 / 100000;
  }
  const double powers[6] = {2 * 2 * pi, 2 * 2 * pi, 3 * 4 * pi, 5 * cone, 7 * disk, 0.25 * 4 * pi * disk};
  double total = 0;
  for (double power : powers) total += power;
  for (std::size_t i = 0; i < 6; i++) EXPECT_NEAR(flat.emitters[i].pmf, powers[i] / total, 1e-5) << i;
  EXPECT_EQ(flat.emitters[3].kind, kernel::uint(SUN_EMITTER_LIGHT));
  EXPECT_EQ(flat.emitters[3].a, 1u);
  EXPECT_EQ(flat.emitters[5].kind, kernel::uint(SUN_EMITTER_ENVIRONMENT));
  EXPECT_EQ(flat.environment.emitter, 5u);
}

// Punctual lights whose power is next to nothing still get their share: a sixteenth of the others' among them all.
TEST(Emitters, NarrowSpotsGetTheirChance) {
  Scene scene = glowing(1e6f);
  Light spot;
  spot.kind = Light::Kind::spot;
  spot.inner_angle = 0.01f;
  spot.outer_angle = 0.02f;
  scene.lights = {spot, spot};
  const FlatScene flat = flattened(scene);
  ASSERT_EQ(flat.emitters.size(), 4u);
  const double share = 1.0 / 32, total = 1 + 2 * share;
  for (std::size_t i = 0; i < 4; i++) EXPECT_NEAR(flat.emitters[i].pmf, (i < 2 ? 0.5 : share) / total, 1e-5) << i;
}

TEST(Emitters, TexturesWeighTriangles) {
  // The left half of the picture is black; the square is cut into a left and a right half.
  Primitive halves = square(0);
  halves.positions = {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}, {0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}};
  halves.normals.assign(8, glm::vec3(0, 0, 1));
  halves.uv[0] = {{0, 1}, {0.5f, 1}, {0.5f, 0}, {0, 0}, {0.5f, 1}, {1, 1}, {1, 0}, {0.5f, 0}};
  halves.indices = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
  Scene scene = glowing();
  scene.meshes[0].primitives = {halves};
  Image image = byte_image(8, 8, 3, 0);
  auto &pixels = std::get<0>(image.pixels);
  for (std::size_t i = 0; i < pixels.size(); i++) pixels[i] = i / 3 % 8 < 4 ? 0 : 255;
  scene.images.push_back(image);
  scene.textures.push_back({0, Wrap::clamp, Wrap::clamp, true});
  scene.materials[0].emission_texture.texture = 0;
  const FlatScene flat = flattened(scene);
  ASSERT_EQ(flat.emitters.size(), 4u);
  // Black triangles keep a twentieth of the picture's mean of 1/2.
  const double total = 2 * (1 + 0.025);
  EXPECT_NEAR(flat.emitters[0].pmf, 0.025 / total, 1e-5);
  EXPECT_NEAR(flat.emitters[2].pmf, 1 / total, 1e-5);
}

TEST(Lights, PointsFallOffWithTheSquare) {
  kernel::Light light{};
  light.kind = SUN_LIGHT_POINT;
  light.position[1] = 4;
  for (int c = 0; c < 3; c++) light.intensity[c] = 8.0f * float(c + 1);
  const auto sample = kernel::light_sample(&light, 0, kernel::make_vec3(0, 2, 0));
  EXPECT_EQ(sample.direction.y, 1.0f);
  EXPECT_EQ(sample.distance, 2.0f);
  EXPECT_EQ(sample.radiance.x, 2.0f);
  EXPECT_EQ(sample.radiance.z, 6.0f);
  EXPECT_EQ(kernel::light_sample(&light, 0, kernel::make_vec3(0, 4, 0)).radiance.x, 0.0f);  // at the light itself
}

TEST(Lights, SpotsFadeBetweenTheirAngles) {
  Scene scene = scene_of(square());
  Light spot;
  spot.kind = Light::Kind::spot;
  spot.position = {0, 0, 10};
  spot.direction = {0, 0, -1};
  spot.intensity = glm::vec3(100);
  spot.inner_angle = 0.2f;
  spot.outer_angle = 0.6f;
  scene.lights = {spot};
  const FlatScene flat = flattened(scene);
  for (double angle : {0.0, 0.1, 0.19, 0.3, 0.45, 0.59, 0.61, 1.2, 2.0}) {
    // At distance 5 from the light, `angle` off its axis.
    const auto sample =
        kernel::light_sample(flat.lights.data(), 0, kernel::make_vec3(float(5 * std::sin(angle)), 0, float(10 - 5 * std::cos(angle))));
    const double ramp = std::min(std::max((std::cos(angle) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6)), 0.0), 1.0);
    EXPECT_NEAR(sample.radiance.y, 4 * ramp * ramp, 1e-4) << angle;
    EXPECT_NEAR(sample.distance, 5, 1e-5);
  }
}

TEST(Lights, DirectionalOnesHaveNoPlace) {
  kernel::Light light{};
  light.kind = SUN_LIGHT_DIRECTIONAL;
  light.direction[1] = -1;
  light.intensity[0] = 3;
  const auto sample = kernel::light_sample(&light, 0, kernel::make_vec3(5, 6, 7));
  EXPECT_EQ(sample.direction.y, 1.0f);
  EXPECT_GT(sample.distance, 3e38f);
  EXPECT_EQ(sample.radiance.x, 3.0f);
}

}  // namespace
}  // namespace sunstone
