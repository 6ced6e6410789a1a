// SPDX-License-Identifier: Apache-2.0
// [Mikkelsen08] chapter 3 and appendix: corners with the same position, normal and coordinates are one vertex; triangles about a vertex that share
// edges and an orientation of their coordinates are a group; a group has one tangent, weighted by angles. The split of groups by an angle is left
// out: at the usual 180 degrees it parts tangents that are exactly opposite and no others.
#include "flatten/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "math/elementary.h"

namespace sunstone {
namespace {

constexpr std::int32_t none = -1;

bool not_zero(float x) { return std::fabs(x) > FLT_MIN; }
float dot(const glm::vec3 &a, const glm::vec3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
float length(const glm::vec3 &v) { return std::sqrt(dot(v, v)); }
glm::vec3 normalized(const glm::vec3 &v) {
  const float size = length(v);
  return not_zero(v.x) || not_zero(v.y) || not_zero(v.z) ? (1.0f / size) * v : v;
}
glm::vec3 projected(const glm::vec3 &v, const glm::vec3 &normal) { return normalized(v - dot(normal, v) * normal); }

struct Face {
  std::array<std::int32_t, 3> neighbour{none, none, none};  // across the edge from corner k to k + 1
  std::array<std::int32_t, 3> group{none, none, none};      // of each corner
  glm::vec3 along_u{0};                                     // first derivative, unit length
  bool preserving = false;                                  // are the coordinates wound as the triangle is?
  bool any = true;                                          // no derivative: goes along with any group
};

struct Group {
  std::uint32_t vertex = 0;
  bool preserving = false;
  std::vector<std::int32_t> faces;
};

// Corners with equal values get equal numbers: the first corner that has them.
std::vector<std::uint32_t> welded(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals, std::span<const glm::vec2> uvs) {
  const auto key = [&](std::uint32_t i) {
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // -0 is 0; NaN has an order too
    return std::array<std::uint32_t, 8>{bits(positions[i].x), bits(positions[i].y), bits(positions[i].z), bits(normals[i].x),
                                        bits(normals[i].y),   bits(normals[i].z),   bits(uvs[i].x),       bits(uvs[i].y)};
  };
  std::vector<std::uint32_t> order(positions.size()), vertex(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  for (std::size_t i = 0; i < order.size(); i++) vertex[order[i]] = i && key(order[i]) == key(order[i - 1]) ? vertex[order[i - 1]] : order[i];
  return vertex;
}

void derive(std::span<const glm::vec3> positions, std::span<const glm::vec2> uvs, std::vector<Face> &faces) {
  for (std::size_t f = 0; f < faces.size(); f++) {
    const glm::vec3 *p = &positions[3 * f];
    const glm::vec2 *t = &uvs[3 * f];
    const float t21x = t[1].x - t[0].x, t21y = t[1].y - t[0].y, t31x = t[2].x - t[0].x, t31y = t[2].y - t[0].y;
    const glm::vec3 d1 = p[1] - p[0], d2 = p[2] - p[0];
    const float signed_area = t21x * t31y - t21y * t31x;
    const glm::vec3 along_u = t31y * d1 - t21y * d2, along_v = -t31x * d1 + t21x * d2;
    Face &face = faces[f];
    face.preserving = signed_area > 0;
    if (!not_zero(signed_area)) continue;
    const float length_u = length(along_u), length_v = length(along_v), area = std::fabs(signed_area);
    face.along_u = not_zero(length_u) ? ((face.preserving ? 1.0f : -1.0f) / length_u) * along_u : along_u;
    face.any = !(not_zero(length_u / area) && not_zero(length_v / area));
  }
}

// Pairs of faces along edges that both use in opposite directions; at most one partner an edge.
void find_neighbours(const std::vector<std::uint32_t> &vertex, std::vector<Face> &faces) {
  struct Edge {
    std::uint32_t low, high;
    std::int32_t face;
    std::uint8_t corner;
    bool rising;  // from low to high
  };
  std::vector<Edge> edges;
  edges.reserve(vertex.size());
  for (std::size_t f = 0; f < faces.size(); f++)
    for (std::uint8_t k = 0; k < 3; k++) {
      const std::uint32_t a = vertex[3 * f + k], b = vertex[3 * f + (k + 1u) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(f), k, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge &a, const Edge &b) {
    return std::array<std::uint64_t, 4>{a.low, a.high, static_cast<std::uint64_t>(a.face), a.corner} <
           std::array<std::uint64_t, 4>{b.low, b.high, static_cast<std::uint64_t>(b.face), b.corner};
  });
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].low == edges[first].low && edges[last].high == edges[first].high) last++;
    // The first free edge takes the next free one of the other direction, which is: the k-th rising one and the k-th falling one are partners.
    std::size_t up = first, down = first;
    while (true) {
      while (up < last && !edges[up].rising) up++;
      while (down < last && edges[down].rising) down++;
      if (up == last || down == last) break;
      faces[static_cast<std::size_t>(edges[up].face)].neighbour[edges[up].corner] = edges[down].face;
      faces[static_cast<std::size_t>(edges[down].face)].neighbour[edges[down].corner] = edges[up].face;
      up++;
      down++;
    }
  }
}

std::size_t corner_of(const std::vector<std::uint32_t> &vertex, std::int32_t face, std::uint32_t which) {
  const auto f = 3 * static_cast<std::size_t>(face);
  return vertex[f] == which ? 0 : vertex[f + 1] == which ? 1 : 2;
}

std::vector<Group> find_groups(const std::vector<std::uint32_t> &vertex, std::vector<Face> &faces) {
  std::vector<Group> groups;
  std::vector<std::int32_t> waiting;
  for (std::size_t start = 0; start < vertex.size(); start++) {
    Face &first = faces[start / 3];
    if (first.any || first.group[start % 3] != none) continue;
    const auto number = static_cast<std::int32_t>(groups.size());
    Group group{vertex[start], first.preserving, {}};
    // Depth first, the left neighbour before the right one: a face without derivative takes the orientation of the group that meets it first.
    waiting.push_back(static_cast<std::int32_t>(start / 3));
    while (!waiting.empty()) {
      const std::int32_t at = waiting.back();
      waiting.pop_back();
      Face &face = faces[static_cast<std::size_t>(at)];
      const std::size_t k = corner_of(vertex, at, group.vertex);
      if (face.group[k] != none) continue;
      if (face.any && face.group == std::array<std::int32_t, 3>{none, none, none}) face.preserving = group.preserving;
      if (face.preserving != group.preserving) continue;
      face.group[k] = number;
      group.faces.push_back(at);
      for (const std::size_t side : {(k + 2) % 3, k})
        if (face.neighbour[side] != none) waiting.push_back(face.neighbour[side]);
    }
    std::sort(group.faces.begin(), group.faces.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

glm::vec3 group_tangent(const Group &group, const std::vector<std::uint32_t> &vertex, const std::vector<Face> &faces,
                        std::span<const glm::vec3> positions, std::span<const glm::vec3> normals) {
  glm::vec3 sum(0);
  for (const std::int32_t at : group.faces) {
    const Face &face = faces[static_cast<std::size_t>(at)];
    if (face.any) continue;
    const std::size_t k = corner_of(vertex, at, group.vertex), f = 3 * static_cast<std::size_t>(at);
    const glm::vec3 &normal = normals[f + k], &here = positions[f + k];
    const glm::vec3 before = projected(positions[f + (k + 2) % 3] - here, normal), after = projected(positions[f + (k + 1) % 3] - here, normal);
    const float angle = kernel::acos_real(std::min(1.0f, std::max(-1.0f, dot(before, after))));
    sum += angle * projected(face.along_u, normal);
  }
  return normalized(sum);
}

}  // namespace

std::vector<glm::vec4> make_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals, std::span<const glm::vec2> uvs) {
  std::vector<glm::vec4> tangents(positions.size(), glm::vec4(0));
  std::vector<Face> faces(positions.size() / 3);
  const std::vector<std::uint32_t> vertex = welded(positions, normals, uvs);
  derive(positions, uvs, faces);
  find_neighbours(vertex, faces);
  for (const Group &group : find_groups(vertex, faces)) {
    const glm::vec3 tangent = group_tangent(group, vertex, faces, positions, normals);
    const float size = length(tangent);
    if (!(size > 0.5f && size < 2.0f)) continue;  // opposite ones cancelled, or numbers beyond all measure
    // glTF's v runs down, normal maps' green up: the bitangent points to where v falls.
    const glm::vec4 whole(tangent, group.preserving ? -1.0f : 1.0f);
    for (const std::int32_t face : group.faces) tangents[3 * static_cast<std::size_t>(face) + corner_of(vertex, face, group.vertex)] = whole;
  }
  return tangents;
}

}  // namespace sunstone
