// SPDX-License-Identifier: Apache-2.0
// Tangents against vectors that the original implementation (mikktspace.c) gave for the same input.
#include "flatten/tangents.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/flatten/flatten_support.h"

namespace sunstone {
namespace {

struct Corners {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
};

// Nine vertices of a bent sheet whose coordinates are mirrored about its middle.
Corners sheet() {
  Corners sheet;
  for (int y = 0; y < 2; y++)
    for (int x = 0; x < 2; x++)
      for (const auto &[dx, dy] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 0), std::pair(1, 1), std::pair(0, 1)}) {
        const int i = x + dx, j = y + dy;
        sheet.positions.push_back({i, j, float((i * j + 2 * i) % 3) * 0.25f});
        sheet.normals.push_back(glm::normalize(glm::vec3(i - 1, j - 1, 2)));
        sheet.uvs.push_back({float(std::abs(i - 1)) * 0.5f + 0.125f * float(j), float(j) * 0.5f + float(i) * 0.125f});
      }
  return sheet;
}

TEST(Tangents, AreMikkelsens) {
  // By corner, with the sign as mikktspace gives it for a v that runs up.
  const float expected[24][4] = {{-0.907465756f, 0.278682113f, -0.314391792f, -1},
                                 {-0.9984411f, -0.0499220528f, -0.0249610078f, -1},
                                 {-0.970142424f, 0.242535606f, 0, -1},
                                 {-0.907465756f, 0.278682113f, -0.314391792f, -1},
                                 {-0.970142424f, 0.242535606f, 0, -1},
                                 {-0.862653375f, 0.264171004f, -0.431326687f, -1},
                                 {0.975612819f, -0.196325362f, -0.0981626734f, 1},
                                 {0.867251515f, -0.105762385f, -0.486507028f, 1},
                                 {0.863473415f, -0.260800928f, -0.431736708f, 1},
                                 {0.975612819f, -0.196325362f, -0.0981626734f, 1},
                                 {0.863473415f, -0.260800928f, -0.431736708f, 1},
                                 {0.970142424f, -0.242535606f, 0, 1},
                                 {-0.862653375f, 0.264171004f, -0.431326687f, -1},
                                 {-0.970142424f, 0.242535606f, 0, -1},
                                 {-0.968086123f, 0.224159569f, -0.112079784f, -1},
                                 {-0.862653375f, 0.264171004f, -0.431326687f, -1},
                                 {-0.968086123f, 0.224159569f, -0.112079784f, -1},
                                 {-0.861640394f, 0.123091467f, -0.492365927f, -1},
                                 {0.970142424f, -0.242535606f, 0, 1},
                                 {0.863473415f, -0.260800928f, -0.431736708f, 1},
                                 {0.886074185f, -0.392337263f, -0.246868536f, 1},
                                 {0.970142424f, -0.242535606f, 0, 1},
                                 {0.886074185f, -0.392337263f, -0.246868536f, 1},
                                 {0.955841541f, -0.262856394f, 0.131428197f, 1}};
  const Corners corners = sheet();
  const auto tangents = make_tangents(corners.positions, corners.normals, corners.uvs);
  ASSERT_EQ(tangents.size(), 24u);
  for (std::size_t i = 0; i < 24; i++) {
    for (int c = 0; c < 3; c++) EXPECT_NEAR(tangents[i][c], expected[i][c], 1e-6f) << "corner " << i;
    EXPECT_EQ(tangents[i].w, -expected[i][3]) << "corner " << i;  // glTF's v runs down
  }
}

TEST(Tangents, ThePlainSquareHasThemAlongUWithGreenUp) {
  Scene scene = scene_of(square(0));
  scene.images.push_back(byte_image(2, 2, 3, 1));
  scene.textures.push_back({0});
  scene.materials.emplace_back().normal_texture.texture = 0;
  for (bool smooth : {true, false}) {
    if (!smooth) scene.meshes[0].primitives[0].normals.clear();
    const FlatScene flat = flattened(scene);
    ASSERT_EQ(flat.vertex_extras.size(), 4u);
    for (const auto &extra : flat.vertex_extras) {
      EXPECT_NEAR(extra.tangent[0], 1, 1e-6f);
      EXPECT_EQ(extra.tangent[3], 1.0f);  // cross(z, x) = +y, where v falls
    }
  }
}

TEST(Tangents, CoordinatesWithoutExtentGiveNone) {
  Corners corners = sheet();
  for (auto &uv : corners.uvs) uv = {0.5f, 0.5f};
  for (const auto &tangent : make_tangents(corners.positions, corners.normals, corners.uvs)) EXPECT_EQ(tangent, glm::vec4(0));
}

TEST(Tangents, BadCoordinatesGiveNoBadTangents) {
  Corners corners = sheet();
  corners.uvs[0] = {NAN, 0};
  corners.uvs[4] = {INFINITY, 1};
  corners.uvs[9] = {1e38f, -1e38f};
  for (const auto &tangent : make_tangents(corners.positions, corners.normals, corners.uvs))
    EXPECT_TRUE(tangent == glm::vec4(0) || std::fabs(glm::length(glm::vec3(tangent)) - 1) < 1e-4f);
}

// A fan of many triangles about one vertex, and many of them on one edge: no recursion, no time beyond n log n.
TEST(Tangents, LargeFans) {
  Corners fan;
  for (int i = 0; i < 200000; i++) {
    const auto rim = [](int k) { return glm::vec2(std::cos(float(k) * 3.1e-5f), std::sin(float(k) * 3.1e-5f)); };
    for (const glm::vec2 &p : {glm::vec2(0), rim(i), rim(i + 1)}) {
      fan.positions.push_back(glm::vec3(p, 0));
      fan.normals.push_back({0, 0, 1});
      fan.uvs.push_back(p);
    }
  }
  const auto tangents = make_tangents(fan.positions, fan.normals, fan.uvs);
  EXPECT_NEAR(tangents[0].x, 1, 1e-3f);
}

}  // namespace
}  // namespace sunstone
