// SPDX-License-Identifier: Apache-2.0
#include "import/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sunstone {

namespace {

// Tests of points against ears and of corners for being one, for each corner of a polygon and for a polygon: beyond them the rest is cut without
// looking, so that no outline takes long. A circle of 10,000 corners that were rounded, half of them inwards, stays below.
constexpr std::size_t tests_a_corner = std::size_t(1) << 15, tests_a_polygon = std::size_t(1) << 28;

double cross(const glm::dvec2 &a, const glm::dvec2 &b, const glm::dvec2 &c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

class EarClipper {
 public:
  EarClipper(std::vector<glm::dvec2> points, std::vector<std::uint32_t> &triangles) : points_(std::move(points)), triangles_(triangles) {
    const std::uint32_t n = static_cast<std::uint32_t>(points_.size());
    most_tests_ = std::min(tests_a_corner * n, tests_a_polygon);
    next_.resize(n);
    previous_.resize(n);
    blocking_.resize(n);
    for (std::uint32_t i = 0; i < n; i++) {
      next_[i] = (i + 1) % n;
      previous_[i] = (i + n - 1) % n;
    }
    glm::dvec2 lower = points_[0], upper = points_[0];
    for (const glm::dvec2 &p : points_) {
      lower = glm::min(lower, p);
      upper = glm::max(upper, p);
    }
    const glm::dvec2 size = upper - lower;
    flat_ = 1e-14 * (size.x * size.x + size.y * size.y);
    for (std::uint32_t i = 0; i < n; i++) mark(i);
  }

  // Looks for the first true ear, then the first corner without area, then, in a polygon that crosses itself, for a convex corner, then for any.
  bool run() {
    bool partition = true;
    std::uint32_t at = 0;
    for (std::size_t left = points_.size(); left > 3; left--) {
      std::uint32_t found = at;
      bool ear = false;
      for (int effort = tests_ > most_tests_ ? 2 : 0; effort < 3 && !ear; effort++) {
        std::size_t seen = 0;
        for (; seen < left && !ear; seen++, found = next_[found])
          if ((ear = fits(found, effort))) break;
        if (!ear)
          found = at;
        else if (effort == 2)
          partition = false;
      }
      partition = partition && ear;
      at = cut(found);
    }
    triangles_.insert(triangles_.end(), {previous_[at], at, next_[at]});
    return partition;
  }

 private:
  double turn(std::uint32_t i) const { return cross(points_[previous_[i]], points_[i], points_[next_[i]]); }

  bool fits(std::uint32_t i, int effort) {
    const double area = turn(i);
    tests_++;
    if (effort == 0) return area > flat_ && empty(i);
    if (effort == 1) return std::abs(area) <= flat_;  // takes nothing away from what is left to cover
    return area > 0;
  }

  // No corner of the rest lies in the triangle. A reflex corner on its rim blocks it too; one at a tip of the triangle (the twin at a bridge's end)
  // does not.
  bool empty(std::uint32_t i) {
    if (reflex_ == 0) return true;
    const std::uint32_t before = previous_[i], after = next_[i];
    const glm::dvec2 a = points_[before], b = points_[i], c = points_[after];
    const glm::dvec2 lower = glm::min(glm::min(a, b), c), upper = glm::max(glm::max(a, b), c);
    for (std::uint32_t k = next_[after]; k != before; k = next_[k]) {
      if (++tests_ > most_tests_) return false;
      const glm::dvec2 &p = points_[k];
      if (p.x < lower.x || p.x > upper.x || p.y < lower.y || p.y > upper.y || p == a || p == b || p == c) continue;
      const double u = cross(a, b, p), v = cross(b, c, p), w = cross(c, a, p);
      if (blocking_[k] ? u >= 0 && v >= 0 && w >= 0 : u > flat_ && v > flat_ && w > flat_) return false;
    }
    return true;
  }

  void mark(std::uint32_t i) {
    const bool blocks = turn(i) <= flat_;
    if (blocks && !blocking_[i]) reflex_++;
    if (!blocks && blocking_[i]) reflex_--;
    blocking_[i] = blocks;
  }

  std::uint32_t cut(std::uint32_t i) {
    const std::uint32_t before = previous_[i], after = next_[i];
    triangles_.insert(triangles_.end(), {before, i, after});
    next_[before] = after;
    previous_[after] = before;
    if (blocking_[i]) reflex_--;
    mark(before);
    mark(after);
    return after;
  }

  std::vector<glm::dvec2> points_;
  std::vector<std::uint32_t> next_, previous_;
  std::vector<char> blocking_;
  std::vector<std::uint32_t> &triangles_;
  std::size_t reflex_ = 0, tests_ = 0, most_tests_ = 0;
  double flat_ = 0;
};

void fan(std::size_t n, std::vector<std::uint32_t> &triangles) {
  for (std::uint32_t i = 1; i + 1 < n; i++) triangles.insert(triangles.end(), {0, i, i + 1});
}

}  // namespace

bool triangulate_polygon(std::span<const glm::vec3> corners, std::vector<std::uint32_t> &triangles) {
  const std::size_t n = corners.size();
  if (n < 3) return true;
  if (n == 3) {
    fan(n, triangles);
    return true;
  }
  glm::dvec3 normal(0);  // after Newell: twice the area, exact in its direction for planar polygons of any shape
  const glm::dvec3 origin(corners[0]);
  for (std::size_t i = 0; i < n; i++) {
    const glm::dvec3 a = glm::dvec3(corners[i]) - origin, b = glm::dvec3(corners[(i + 1) % n]) - origin;
    normal += glm::cross(a, b);
  }
  const glm::dvec3 size = glm::abs(normal);
  if (!(size.x + size.y + size.z > 0)) {  // all on one line
    fan(n, triangles);
    return true;
  }
  // Seen along the axis that it faces most, from the side where it runs counterclockwise.
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  std::vector<glm::dvec2> points(n);
  for (std::size_t i = 0; i < n; i++) {
    const glm::dvec3 p = glm::dvec3(corners[i]) - origin;
    points[i] = normal[axis] > 0 ? glm::dvec2(p[first], p[second]) : glm::dvec2(p[second], p[first]);
  }
  if (n == 4) {  // a convex quad is cut along its shorter diagonal
    const bool convex = cross(points[0], points[1], points[2]) > 0 && cross(points[1], points[2], points[3]) > 0 &&
                        cross(points[2], points[3], points[0]) > 0 && cross(points[3], points[0], points[1]) > 0;
    if (convex) {
      const bool even =
          glm::distance(glm::dvec3(corners[0]), glm::dvec3(corners[2])) <= glm::distance(glm::dvec3(corners[1]), glm::dvec3(corners[3]));
      const std::array<std::uint32_t, 6> cut = even ? std::array<std::uint32_t, 6>{0, 1, 2, 0, 2, 3} : std::array<std::uint32_t, 6>{0, 1, 3, 1, 2, 3};
      triangles.insert(triangles.end(), cut.begin(), cut.end());
      return true;
    }
  }
  return EarClipper(std::move(points), triangles).run();
}

}  // namespace sunstone
