// SPDX-License-Identifier: Apache-2.0
#include "kernels/hits/soup.h"

#include <algorithm>
#include <cmath>

namespace sunstone::hits {

using kernel::uint;

const Matrix identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

Matrix multiply(const Matrix &a, const Matrix &b) {
  Matrix m{};
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++) {
      double sum = column == 3 ? a[4 * row + 3] : 0.0;
      for (int k = 0; k < 3; k++) sum += double(a[4 * row + k]) * b[4 * k + column];
      m[4 * row + column] = float(sum);
    }
  return m;
}
Matrix translation(float x, float y, float z) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}; }
Matrix scaling(float x, float y, float z) { return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0}; }
Matrix rotation(int axis, float radians) {
  Matrix m = identity;
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  m[4 * a + a] = m[4 * b + b] = std::cos(radians);
  m[4 * b + a] = std::sin(radians);
  m[4 * a + b] = -m[4 * b + a];
  return m;
}

std::uint32_t Random::number() {
  state_ += 0x9e3779b9u;
  return hash_number(state_);
}
float Random::unit() { return float(number() >> 8) * 0x1p-24f; }
glm::vec3 Random::direction() {
  const float z = in(-1, 1), phi = in(0, 6.2831853f), r = std::sqrt(std::max(0.0f, 1 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

uint Soup::begin_mesh() {
  scene_.meshes.push_back({uint(scene_.triangles.size()), 0});
  return uint(scene_.meshes.size() - 1);
}

void Soup::triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, uint bits) {
  if (scene_.meshes.empty()) begin_mesh();
  const uint first = uint(scene_.vertices.size());
  for (const glm::vec3 &p : {a, b, c}) {
    kernel::Vertex vertex{};
    for (int axis = 0; axis < 3; axis++) vertex.position[axis] = p[axis];
    scene_.vertices.push_back(vertex);
  }
  scene_.triangle_ids.push_back(uint(scene_.triangles.size()) | bits);
  scene_.triangles.push_back({{first, first + 1, first + 2}, 0});
  scene_.meshes.back().triangle_count++;
}

void Soup::quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, uint bits) {
  triangle(a, b, c, bits);
  triangle(a, c, d, bits);
}

void Soup::box(glm::vec3 l, glm::vec3 u, uint bits) {
  const auto corner = [&](int i) { return glm::vec3(i & 1 ? u.x : l.x, i & 2 ? u.y : l.y, i & 4 ? u.z : l.z); };
  constexpr int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto &s : sides) quad(corner(s[0]), corner(s[1]), corner(s[2]), corner(s[3]), bits);
}

void Soup::instance(uint mesh, const Matrix &m) {
  kernel::Instance instance{};
  instance.first_emitter = SUN_NONE;
  std::copy(m.begin(), m.end(), instance.to_world);
  const auto at = [&](int row, int column) { return double(m[4 * row + column]); };
  const auto cofactor = [&](int row, int column) {
    const int r1 = (row + 1) % 3, r2 = (row + 2) % 3, c1 = (column + 1) % 3, c2 = (column + 2) % 3;
    return at(r1, c1) * at(r2, c2) - at(r1, c2) * at(r2, c1);
  };
  const double determinant = at(0, 0) * cofactor(0, 0) + at(0, 1) * cofactor(0, 1) + at(0, 2) * cofactor(0, 2);
  for (int row = 0; row < 3; row++) {
    double shift = 0;
    for (int column = 0; column < 3; column++) {
      instance.to_object[4 * row + column] = float(cofactor(column, row) / determinant);
      shift -= cofactor(column, row) / determinant * at(column, 3);
    }
    instance.to_object[4 * row + 3] = float(shift);
  }
  if (m == identity) instance.flags |= SUN_INSTANCE_IDENTITY;
  if (determinant < 0) instance.flags |= SUN_INSTANCE_MIRRORED;
  std::fill_n(instance.lower, 3, INFINITY);
  std::fill_n(instance.upper, 3, -INFINITY);
  const MeshRange &range = scene_.meshes[mesh];
  for (uint i = 0; i < range.triangle_count; i++)
    for (const uint vertex : scene_.triangles[range.first_triangle + i].vertex) {
      const float *p = scene_.vertices[vertex].position;
      for (int row = 0; row < 3; row++) {
        const float x = m == identity ? p[row] : m[4 * row] * p[0] + m[4 * row + 1] * p[1] + m[4 * row + 2] * p[2] + m[4 * row + 3];
        instance.lower[row] = std::min(instance.lower[row], x);
        instance.upper[row] = std::max(instance.upper[row], x);
      }
    }
  scene_.instances.push_back(instance);
  scene_.instance_mesh.push_back(mesh);
}

FlatScene Soup::finish() {
  if (scene_.meshes.empty()) begin_mesh();
  if (scene_.instances.empty()) instance(0, identity);
  for (const kernel::Instance &i : scene_.instances) {
    scene_.bounds.lower = glm::min(scene_.bounds.lower, glm::vec3(i.lower[0], i.lower[1], i.lower[2]));
    scene_.bounds.upper = glm::max(scene_.bounds.upper, glm::vec3(i.upper[0], i.upper[1], i.upper[2]));
  }
  return std::move(scene_);
}

TraceRay make_ray(glm::vec3 origin, glm::vec3 direction, float t_max) {
  return {{origin.x, origin.y, origin.z}, t_max, {direction.x, direction.y, direction.z}, 0.0f};
}

}  // namespace sunstone::hits
