// SPDX-License-Identifier: Apache-2.0
#include "flatten/geometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "flatten/placement.h"
#include "flatten/weld.h"
#include "host/flatten/flatten_support.h"

namespace sunstone {
namespace {

glm::vec3 position_of(const FlatScene &flat, std::size_t triangle, std::size_t corner) {
  const float *p = flat.vertices[flat.triangles[triangle].vertex[corner]].position;
  return {p[0], p[1], p[2]};
}
glm::vec3 normal_of(const FlatScene &flat, std::size_t triangle, std::size_t corner) {
  const float *n = flat.vertices[flat.triangles[triangle].vertex[corner]].normal;
  return {n[0], n[1], n[2]};
}

glm::mat4x3 skewed(float scale_x) {
  glm::mat4x3 m;
  m[0] = glm::vec3(0.3f, 1.1f, -0.2f) * scale_x;
  m[1] = {-0.7f, 0.4f, 0.9f};
  m[2] = {1.3f, 0.1f, 0.5f};
  m[3] = {10, -20, 3};
  return m;
}

TEST(Geometry, AMeshShownOnceIsBakedIntoInstanceZero) {
  Scene scene = scene_of(square(), moved({1, 2, 3}, 2));
  scene.meshes.push_back({"other", {square()}});
  scene.instances.push_back({"second", 1, moved({0, 0, -5})});
  const FlatScene flat = flattened(scene);
  ASSERT_EQ(flat.instances.size(), 1u);
  ASSERT_EQ(flat.meshes.size(), 1u);
  EXPECT_EQ(flat.instances[0].flags, SUN_INSTANCE_IDENTITY);
  EXPECT_EQ(flat.meshes[0].triangle_count, 4u);
  EXPECT_EQ(position_of(flat, 0, 0), glm::vec3(-1, 0, 3));
  EXPECT_EQ(position_of(flat, 2, 0), glm::vec3(-1, -1, -5));
  EXPECT_EQ(flat.bounds.lower, glm::vec3(-1, -1, -5));
  EXPECT_EQ(flat.bounds.upper, glm::vec3(3, 4, 3));
  EXPECT_EQ(flat.vertices.size(), 8u);  // shared corners stay shared
  EXPECT_EQ(flat.vertex_extras.size(), 1u);
}

TEST(Geometry, SmallMeshesAreBakedAndLargeOnesInstanced) {
  Scene scene = scene_of(bumpy(20, 1));  // 800 triangles
  for (int i = 1; i < 5; i++) scene.instances.push_back({"copy", 0, moved({float(i) * 3, 0, 0})});
  EXPECT_EQ(flattened(scene).instances.size(), 1u);
  scene.instances.push_back({"copy", 0, moved({18, 0, 0})});
  const FlatScene flat = flattened(scene);
  EXPECT_EQ(flat.instances.size(), 6u);
  EXPECT_EQ(flat.triangles.size(), 800u);
  for (const auto &instance : flat.instances) EXPECT_EQ(instance.flags, 0u);
}

// The same mesh under the same transform, once baked and once as an instance among many.
TEST(Geometry, BakedAndInstancedAgree) {
  for (float mirror : {1.0f, -1.0f}) {
    const glm::mat4x3 transform = skewed(mirror);
    const Primitive primitive = bumpy(24, 5);
    const FlatScene baked = flattened(scene_of(primitive, transform));
    Scene many = scene_of(primitive, transform);
    for (int i = 0; i < 4; i++) many.instances.push_back({"copy", 0, moved({float(i), 0, 50})});
    const FlatScene instanced = flattened(many);
    ASSERT_EQ(instanced.instances.size(), 5u);
    const kernel::Instance &instance = instanced.instances[0];
    EXPECT_EQ(instance.flags, mirror < 0 ? SUN_INSTANCE_MIRRORED : 0);
    ASSERT_EQ(baked.triangles.size(), instanced.triangles.size());
    for (std::size_t t = 0; t < baked.triangles.size(); t++)
      for (std::size_t k = 0; k < 3; k++) {
        const std::size_t other = mirror < 0 && k ? 3 - k : k;
        const auto &vertex = instanced.vertices[instanced.triangles[t].vertex[other]];
        ASSERT_EQ(position_of(baked, t, k), transform_point(instance, vertex.position));  // to the bit
        glm::vec3 n;
        for (int c = 0; c < 3; c++)
          n[c] =
              instance.to_object[c] * vertex.normal[0] + instance.to_object[4 + c] * vertex.normal[1] + instance.to_object[8 + c] * vertex.normal[2];
        ASSERT_LT(glm::distance(glm::normalize(n), normal_of(baked, t, k)), 1e-5f);
        for (int c = 0; c < 3; c++) {
          ASSERT_GE(position_of(baked, t, k)[c], instance.lower[c]);
          ASSERT_LE(position_of(baked, t, k)[c], instance.upper[c]);
        }
      }
    for (int c = 0; c < 3; c++) EXPECT_NEAR(instance.upper[c], baked.bounds.upper[c], 1e-3f);
    // to_object undoes to_world.
    const glm::vec3 there = transform_point(instance, instanced.vertices[7].position);
    for (int r = 0; r < 3; r++) {
      const float *m = instance.to_object + 4 * r;
      EXPECT_NEAR(m[0] * there.x + m[1] * there.y + m[2] * there.z + m[3], instanced.vertices[7].position[r], 1e-4f);
    }
  }
}

// Counter-clockwise seen from the side that the normals point to, mirrored or not.
TEST(Geometry, AMirroredFrontStaysTheFront) {
  for (float mirror : {1.0f, -1.0f}) {
    const FlatScene flat = flattened(scene_of(square(), skewed(mirror)));
    for (std::size_t t = 0; t < 2; t++) {
      const glm::dvec3 cross = triangle_cross(position_of(flat, t, 0), position_of(flat, t, 1), position_of(flat, t, 2));
      EXPECT_GT(glm::dot(cross, glm::dvec3(normal_of(flat, t, 0))), 0);
    }
  }
}

TEST(Geometry, MirroringTurnsTheTangentsSign) {
  Primitive primitive = square(0);
  primitive.tangents.assign(4, glm::vec4(1, 0, 0, 1));
  Scene scene = scene_of(primitive);
  scene.images.push_back(byte_image(2, 2, 3, 1));
  scene.textures.push_back({0});
  scene.materials.emplace_back().normal_texture.texture = 0;
  scene.instances[0].transform[0] = {-2, 0, 0};
  const FlatScene flat = flattened(scene);
  ASSERT_EQ(flat.vertex_extras.size(), flat.vertices.size());
  const float *tangent = flat.vertex_extras[0].tangent;
  EXPECT_EQ(glm::vec3(tangent[0], tangent[1], tangent[2]), glm::vec3(-1, 0, 0));
  // The bitangent of the mesh was +y, and the mirror leaves it there: w * cross(z, -x) = +y needs w = -1.
  EXPECT_EQ(tangent[3], -1.0f);
  EXPECT_EQ(flat.vertex_extras[0].color[2], 1.0f);
}

TEST(Geometry, FlatNormalsAreSharedWhereTheyAreEqual) {
  Primitive primitive = square();
  primitive.normals.clear();
  EXPECT_EQ(flattened(scene_of(primitive)).vertices.size(), 4u);
  primitive.positions[3].z = 1;  // folded along the diagonal
  const FlatScene flat = flattened(scene_of(primitive));
  EXPECT_EQ(flat.vertices.size(), 6u);
  EXPECT_EQ(normal_of(flat, 0, 0), glm::vec3(0, 0, 1));
  EXPECT_LT(normal_of(flat, 1, 0).z, 1.0f);
}

TEST(Geometry, TrianglesWithoutAreaAreDroppedAndCounted) {
  Primitive primitive = square();
  primitive.indices.insert(primitive.indices.end(), {0, 0, 1, 1, 2, 1});
  primitive.positions.push_back({0, 0, 0});
  primitive.normals.push_back({0, 0, 1});
  primitive.uv[0].push_back({0, 0});
  primitive.indices.insert(primitive.indices.end(), {0, 4, 2});  // three corners on a line
  Notices notices;
  const FlatScene flat = flatten(scene_of(primitive), {}, notices);
  EXPECT_EQ(flat.triangles.size(), 2u);
  EXPECT_EQ(flat.vertices.size(), 4u);
  ASSERT_EQ(notices.all().size(), 1u);
  EXPECT_NE(notices.all()[0].text.find("3 triangles"), std::string::npos);
}

TEST(Geometry, TinyAndHugeTrianglesKeepUnitNormals) {
  for (float scale : {1e-18f, 1e-6f, 1e6f, 1e17f}) {
    Primitive primitive = square();
    primitive.normals.clear();
    const FlatScene flat = flattened(scene_of(primitive, moved({0, 0, 0}, scale)));
    ASSERT_EQ(flat.triangles.size(), 2u) << scale;
    EXPECT_EQ(normal_of(flat, 0, 0), glm::vec3(0, 0, 1)) << scale;
  }
}

TEST(Geometry, AnEmptySceneHasOneInstanceOfAnEmptyMesh) {
  Scene scene;
  const FlatScene flat = flattened(scene);
  ASSERT_EQ(flat.instances.size(), 1u);
  EXPECT_EQ(flat.meshes[flat.instance_mesh[0]].triangle_count, 0u);
  EXPECT_FALSE(flat.bounds.empty());
  Primitive line = square();
  line.indices = {0, 1, 1};
  EXPECT_EQ(flattened(scene_of(line)).instances.size(), 1u);
}

TEST(Geometry, IdsTellTheSidesAndWhatPasses) {
  Scene scene = scene_of(square(0));
  scene.materials.resize(1);
  const auto bits = [&] { return flattened(scene).triangle_ids[1] & ~SUN_ID_PRIMITIVE; };
  EXPECT_EQ(flattened(scene).triangle_ids[1] & SUN_ID_PRIMITIVE, 1u);
  EXPECT_EQ(bits(), SUN_ID_SINGLE_SIDED);
  scene.materials[0].double_sided = true;
  EXPECT_EQ(bits(), 0u);
  scene.materials[0] = {};
  scene.materials[0].transmission = 0.5f;
  EXPECT_EQ(bits(), 0u);  // rough and thin
  scene.materials[0].roughness = 0;
  EXPECT_EQ(bits(), SUN_ID_PASSABLE);
  scene.materials[0].volume = true;
  EXPECT_EQ(bits(), 0u);
  scene.meshes[0].primitives[0].material = -1;
  EXPECT_EQ(bits(), 0u);  // the default material has two sides
}

TEST(Geometry, BoxesOfManyCopiesContainEveryVertex) {
  Scene scene = scene_of(bumpy(30, 2));
  Random random(4);
  for (int i = 0; i < 40; i++) {
    glm::mat4x3 m;
    for (int c = 0; c < 4; c++)
      for (int r = 0; r < 3; r++) m[c][r] = random.between(-3, 3) * (c == 3 ? 100.0f : 1.0f);
    scene.instances.push_back({"copy", 0, m});
  }
  const FlatScene flat = flattened(scene);
  for (const auto &instance : flat.instances)
    for (const auto &vertex : flat.vertices) {
      const glm::vec3 p = transform_point(instance, vertex.position);
      for (int c = 0; c < 3; c++) ASSERT_TRUE(p[c] > instance.lower[c] && p[c] < instance.upper[c]);
    }
}

}  // namespace
}  // namespace sunstone
