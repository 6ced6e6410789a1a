// SPDX-License-Identifier: Apache-2.0
#include "import/obj_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>

#include "import/polygon.h"

namespace sunstone {

namespace {

constexpr int smooth_normal = -2, face_normal = -1;  // instead of a normal's number

glm::vec3 triple(std::span<const float> values, int i) {
  return {values[3 * std::size_t(i)], values[3 * std::size_t(i) + 1], values[3 * std::size_t(i) + 2]};
}

// A vertex of a primitive is a corner's three indices and, where the normal is made, whose it is: its smoothing group's or its face's.
struct Key {
  int position, texture_coordinate, normal;
  std::uint32_t owner;
  bool operator==(const Key &) const = default;
};
struct KeyHash {
  std::size_t operator()(const Key &k) const {
    std::uint64_t h = std::uint64_t(std::uint32_t(k.position)) * 0x9e3779b97f4a7c15ull;
    h = (h ^ (h >> 29) ^ std::uint32_t(k.texture_coordinate)) * 0xbf58476d1ce4e5b9ull;
    h = (h ^ (h >> 32) ^ std::uint32_t(k.normal)) * 0x94d049bb133111ebull;
    h = (h ^ (h >> 29) ^ k.owner) * 0x9e3779b97f4a7c15ull;
    return h ^ (h >> 31);
  }
};

class Builder {
 public:
  explicit Builder(const ObjFaces &faces) : faces_(faces) {}

  ObjMesh run() {
    starts();
    make_face_normals();
    make_smooth_normals();
    std::map<int, std::vector<std::size_t>> by_material;
    for (std::size_t f = 0; f < faces_.counts.size(); f++) by_material[faces_.materials[f]].push_back(f);
    ObjMesh out;
    for (const auto &[material, list] : by_material) out.mesh.primitives.push_back(primitive(material, list, out.crossing));
    return out;
  }

 private:
  void starts() {
    start_.resize(faces_.counts.size());
    std::size_t at = 0;
    for (std::size_t f = 0; f < start_.size(); f++) {
      start_[f] = at;
      at += faces_.counts[f];
    }
  }

  const ObjFaces::Corner &corner(std::size_t f, std::size_t k) const { return faces_.corners[start_[f] + k]; }
  glm::dvec3 point(std::size_t f, std::size_t k) const { return glm::dvec3(triple(faces_.positions, corner(f, k).position)); }

  void make_face_normals() {
    face_normals_.assign(start_.size(), glm::vec3(0));
    for (std::size_t f = 0; f < start_.size(); f++) {
      glm::dvec3 sum(0);
      const glm::dvec3 origin = point(f, 0);
      for (std::size_t k = 1; k + 1 < faces_.counts[f]; k++) sum += glm::cross(point(f, k) - origin, point(f, k + 1) - origin);
      const double length = glm::length(sum);
      if (length > 0 && std::isfinite(length)) face_normals_[f] = glm::vec3(sum / length);
    }
  }

  // Positions that several numbers share (as exporters write them for seams) count as one place.
  std::vector<int> places() const {
    const std::size_t n = faces_.positions.size() / 3;
    std::vector<int> order(n), place(n);
    std::iota(order.begin(), order.end(), 0);
    const auto less = [&](int a, int b) {
      const glm::vec3 p = triple(faces_.positions, a), q = triple(faces_.positions, b);
      return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z != q.z ? p.z < q.z : a < b;
    };
    std::sort(order.begin(), order.end(), less);
    for (std::size_t i = 0; i < n; i++) {
      const bool same = i > 0 && triple(faces_.positions, order[i]) == triple(faces_.positions, order[i - 1]);
      place[order[i]] = same ? place[order[i - 1]] : order[i];
    }
    return place;
  }

  // Weight of a face's normal at its corner k [Max99]: the sine of the angle over the product of the edges, exact for points on a sphere.
  double weight(std::size_t f, std::size_t k) const {
    const std::size_t n = faces_.counts[f];
    const glm::dvec3 a = point(f, (k + n - 1) % n) - point(f, k), b = point(f, (k + 1) % n) - point(f, k);
    const double squares = glm::dot(a, a) * glm::dot(b, b);
    return squares > 0 && std::isfinite(squares) ? glm::length(glm::cross(a, b)) / squares : 0;
  }

  void make_smooth_normals() {
    bool needed = false;
    for (std::size_t f = 0; f < start_.size() && !needed; f++)
      for (std::size_t k = 0; faces_.smoothing[f] != 0 && k < faces_.counts[f]; k++) needed = needed || corner(f, k).normal < 0;
    if (!needed) return;
    place_ = places();
    for (std::size_t f = 0; f < start_.size(); f++)
      for (std::size_t k = 0; faces_.smoothing[f] != 0 && k < faces_.counts[f]; k++)
        smooth_[group_place(f, k)] += weight(f, k) * glm::dvec3(face_normals_[f]);
  }

  std::uint64_t group_place(std::size_t f, std::size_t k) const {
    return std::uint64_t(faces_.smoothing[f]) << 32 | std::uint32_t(place_[corner(f, k).position]);
  }

  glm::vec3 normal_of(std::size_t f, std::size_t k, const Key &key) const {
    if (key.normal >= 0) return triple(faces_.normals, key.normal);
    if (key.normal == smooth_normal) {
      const glm::dvec3 sum = smooth_.at(group_place(f, k));
      const double length = glm::length(sum);
      if (length > 0) return glm::vec3(sum / length);
    }
    return face_normals_[f];
  }

  Primitive primitive(int material, const std::vector<std::size_t> &list, std::size_t &crossing) const {
    Primitive p;
    p.material = material;
    bool flat = true, any_coordinate = false;
    std::size_t corners = 0;
    for (const std::size_t f : list)
      for (std::size_t k = 0; k < faces_.counts[f]; k++, corners++) {
        flat = flat && corner(f, k).normal < 0 && faces_.smoothing[f] == 0;
        any_coordinate = any_coordinate || corner(f, k).texture_coordinate >= 0;
      }
    std::unordered_map<Key, std::uint32_t, KeyHash> numbers;
    numbers.reserve(corners / 3);
    std::vector<std::uint32_t> vertex, cut;
    std::vector<glm::vec3> outline;
    for (const std::size_t f : list) {
      vertex.clear();
      outline.clear();
      for (std::size_t k = 0; k < faces_.counts[f]; k++) {
        const ObjFaces::Corner &c = corner(f, k);
        Key key{c.position, c.texture_coordinate, c.normal, 0};
        if (c.normal < 0 && !flat) {
          key.normal = faces_.smoothing[f] ? smooth_normal : face_normal;
          key.owner = faces_.smoothing[f] ? faces_.smoothing[f] : static_cast<std::uint32_t>(f);
        }
        const auto [found, is_new] = numbers.try_emplace(key, static_cast<std::uint32_t>(p.positions.size()));
        if (is_new) add_vertex(p, f, k, key, flat, any_coordinate);
        vertex.push_back(found->second);
        outline.push_back(triple(faces_.positions, c.position));
      }
      cut.clear();
      if (!triangulate_polygon(outline, cut)) crossing++;
      for (const std::uint32_t i : cut) p.indices.push_back(vertex[i]);
    }
    return p;
  }

  void add_vertex(Primitive &p, std::size_t f, std::size_t k, const Key &key, bool flat, bool any_coordinate) const {
    p.positions.push_back(triple(faces_.positions, key.position));
    if (!flat) p.normals.push_back(normal_of(f, k, key));
    if (any_coordinate) {
      const std::size_t t = 2 * std::size_t(std::max(key.texture_coordinate, 0));
      p.uv[0].push_back(key.texture_coordinate < 0 ? glm::vec2(0) : glm::vec2(faces_.texture_coordinates[t], 1 - faces_.texture_coordinates[t + 1]));
    }
    if (!faces_.colors.empty()) p.colors.push_back(glm::vec4(triple(faces_.colors, key.position), 1));
  }

  const ObjFaces &faces_;
  std::vector<std::size_t> start_;
  std::vector<glm::vec3> face_normals_;
  std::vector<int> place_;
  std::unordered_map<std::uint64_t, glm::dvec3> smooth_;
};

}  // namespace

ObjMesh build_obj_mesh(const ObjFaces &faces) { return Builder(faces).run(); }

}  // namespace sunstone
