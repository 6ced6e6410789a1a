// SPDX-License-Identifier: Apache-2.0
// Small flattened scenes, made triangle by triangle, and random numbers for them.
#pragma once
#include <array>
#include <cstdint>

#include "bench/rays.h"
#include "flatten/flatten.h"

namespace sunstone::hits {

using Matrix = std::array<float, 12>;  // 3 x 4, row major
extern const Matrix identity;
Matrix multiply(const Matrix &a, const Matrix &b);
Matrix translation(float x, float y, float z);
Matrix scaling(float x, float y, float z);
Matrix rotation(int axis, float radians);

class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed * 2654435761u + 1) {}
  std::uint32_t number();
  float unit();  // [0, 1)
  float in(float lower, float upper) { return lower + (upper - lower) * unit(); }
  glm::vec3 in_box(glm::vec3 lower, glm::vec3 upper) {
    const float x = in(lower.x, upper.x), y = in(lower.y, upper.y);
    return {x, y, in(lower.z, upper.z)};
  }
  glm::vec3 direction();

 private:
  std::uint32_t state_;
};

class Soup {
 public:
  // Triangles that follow belong to a new mesh; returns its number.
  kernel::uint begin_mesh();
  void triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, kernel::uint bits = 0);  // SUN_ID_ bits
  void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, kernel::uint bits = 0);
  void box(glm::vec3 lower, glm::vec3 upper, kernel::uint bits = 0);  // fronts outside
  void instance(kernel::uint mesh, const Matrix &to_world);
  // Adds one instance of identity where there is none, fills bounds; no tree.
  FlatScene finish();

 private:
  FlatScene scene_;
};

TraceRay make_ray(glm::vec3 origin, glm::vec3 direction, float t_max = 1e30f);

}  // namespace sunstone::hits
