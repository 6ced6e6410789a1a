// SPDX-License-Identifier: Apache-2.0
#include "flatten/weld.h"

#include <algorithm>
#include <cmath>

#include "flatten/tangents.h"
#include "math/vector.h"

namespace sunstone {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

bool usable(const glm::vec3 &normal) {
  const float squared = normal.x * normal.x + normal.y * normal.y + normal.z * normal.z;
  return squared > 1e-12f && squared < 1e12f;
}

// Gives a number to each distinct (source vertex, normal, tangent); the candidates of one source vertex are a short list.
class Welder {
 public:
  Welder(WeldedPrimitive &out, std::size_t sources, bool tangents) : out_(out), first_(sources, none), tangents_(tangents) {}
  std::uint32_t vertex(std::uint32_t source, const glm::vec3 &normal, const glm::vec4 &tangent) {
    for (std::uint32_t i = first_[source]; i != none; i = next_[i])
      if (out_.normals[i] == normal && (!tangents_ || out_.tangents[i] == tangent)) return i;
    const auto number = static_cast<std::uint32_t>(out_.source.size());
    out_.source.push_back(source);
    out_.normals.push_back(normal);
    if (tangents_) out_.tangents.push_back(tangent);
    next_.push_back(first_[source]);
    first_[source] = number;
    return number;
  }

 private:
  WeldedPrimitive &out_;
  std::vector<std::uint32_t> first_, next_;
  bool tangents_;
};

}  // namespace

glm::dvec3 triangle_cross(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c) {
  const double e[3] = {double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z};
  const double f[3] = {double(c.x) - a.x, double(c.y) - a.y, double(c.z) - a.z};
  return {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
}

glm::vec3 unit_vector(const glm::dvec3 &v) {
  const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return {0, 0, 1};
  const kernel::vec3 n =
      kernel::normalize3(kernel::make_vec3(static_cast<float>(v.x / largest), static_cast<float>(v.y / largest), static_cast<float>(v.z / largest)));
  return {n.x, n.y, n.z};
}

WeldedPrimitive weld(const Primitive &primitive, bool tangents, int uv_set) {
  WeldedPrimitive out;
  // By corner of the triangles that are kept.
  std::vector<std::uint32_t> corners;
  std::vector<glm::vec3> normals;
  corners.reserve(primitive.indices.size());
  normals.reserve(primitive.indices.size());
  for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    const std::uint32_t *index = &primitive.indices[i];
    const glm::dvec3 cross = triangle_cross(primitive.positions[index[0]], primitive.positions[index[1]], primitive.positions[index[2]]);
    const bool later = std::any_of(primitive.keys.begin(), primitive.keys.end(), [&](const PrimitiveKey &key) {
      return triangle_cross(key.positions[index[0]], key.positions[index[1]], key.positions[index[2]]) != glm::dvec3(0);
    });
    if (cross == glm::dvec3(0) && !later) {
      out.dropped++;
      continue;
    }
    const glm::vec3 flat = unit_vector(cross);
    for (int k = 0; k < 3; k++) {
      corners.push_back(index[k]);
      const bool own = !primitive.normals.empty() && usable(primitive.normals[index[k]]);
      normals.push_back(own ? unit_vector(glm::dvec3(primitive.normals[index[k]])) : flat);
    }
  }
  const bool own_tangents = tangents && !primitive.tangents.empty() && !primitive.normals.empty();
  std::vector<glm::vec4> made;
  if (tangents && !own_tangents && !primitive.uv[uv_set].empty()) {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> uvs;
    positions.reserve(corners.size());
    uvs.reserve(corners.size());
    for (std::uint32_t corner : corners) {
      positions.push_back(primitive.positions[corner]);
      uvs.push_back(primitive.uv[uv_set][corner]);
    }
    made = make_tangents(positions, normals, uvs);
  }
  Welder welder(out, primitive.positions.size(), tangents);
  out.indices.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); i++) {
    glm::vec4 tangent(0);
    if (own_tangents) {
      const glm::vec4 &given = primitive.tangents[corners[i]];
      if (usable(glm::vec3(given))) tangent = glm::vec4(unit_vector(glm::dvec3(given)), given.w < 0 ? -1.0f : 1.0f);
    } else if (!made.empty()) {
      tangent = made[i];
    }
    out.indices.push_back(welder.vertex(corners[i], normals[i], tangent));
  }
  return out;
}

}  // namespace sunstone
