// SPDX-License-Identifier: Apache-2.0
#include "flatten/camera.h"

#include <gtest/gtest.h>

namespace sunstone {
namespace {

void expect_vector(const float *actual, glm::vec3 expected) {
  for (int c = 0; c < 3; c++) EXPECT_NEAR(actual[c], expected[c], 1e-6f) << "component " << c;
}

TEST(FlattenCamera, LooksAlongMinusZ) {
  Camera camera;
  camera.yfov = 1.57079637f;  // the half angle's tangent is 1
  camera.transform[3] = {1, 2, 3};
  const kernel::Camera flat = flatten_camera(camera, 200, 100);
  EXPECT_EQ(flat.kind, kernel::uint(SUN_CAMERA_PERSPECTIVE));
  expect_vector(flat.position, {1, 2, 3});
  expect_vector(flat.forward, {0, 0, -1});
  expect_vector(flat.right, {2, 0, 0});
  expect_vector(flat.up, {0, 1, 0});
  EXPECT_EQ(flat.lens_radius, 0.0f);
}

TEST(FlattenCamera, KeepsTheVerticalAngleWhateverTheFilesAspect) {
  Camera camera;
  camera.yfov = 1.0471976f;  // 60 degrees: tan 30 = 0.57735
  camera.aspect = 3.0f;
  const kernel::Camera flat = flatten_camera(camera, 50, 100);
  expect_vector(flat.up, {0, 0.57735027f, 0});
  expect_vector(flat.right, {0.28867513f, 0, 0});
}

TEST(FlattenCamera, TurnsWithItsNode) {
  Camera camera;
  camera.yfov = 1.57079637f;
  // Looks along +x, with z up: right = forward x up = -y.
  camera.transform = glm::mat4x3(glm::vec3(0, -1, 0), glm::vec3(0, 0, 1), glm::vec3(-1, 0, 0), glm::vec3(0));
  const kernel::Camera flat = flatten_camera(camera, 100, 100);
  expect_vector(flat.forward, {1, 0, 0});
  expect_vector(flat.right, {0, -1, 0});
  expect_vector(flat.up, {0, 0, 1});
}

TEST(FlattenCamera, Orthographic) {
  Camera camera;
  camera.orthographic = true;
  camera.half_height = 2;
  camera.half_width = 7;
  camera.lens_radius = 0.25f;
  camera.focus_distance = 4;
  const kernel::Camera flat = flatten_camera(camera, 300, 200);
  EXPECT_EQ(flat.kind, kernel::uint(SUN_CAMERA_ORTHOGRAPHIC));
  expect_vector(flat.right, {3, 0, 0});
  expect_vector(flat.up, {0, 2, 0});
  EXPECT_EQ(flat.lens_radius, 0.25f);
  EXPECT_EQ(flat.focus_distance, 4.0f);
}

}  // namespace
}  // namespace sunstone
