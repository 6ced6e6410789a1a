// SPDX-License-Identifier: Apache-2.0
#include "flatten/fragments.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "math/elementary.h"

namespace sunstone {
namespace {

using kernel::Fragment;
using kernel::uint;
using Point = std::array<double, 3>;

constexpr int levels = 20;                   // planes stand at multiples of 2^-20 of the grid
constexpr double largest_coordinate = 1e18;  // beyond, areas overflow
constexpr double most_splits = 4096;         // of one triangle: a ray along its plane may ask all its pieces
constexpr uint chunk = 4096;                 // triangles a task takes

struct Box {
  double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY};
  void include(const Point &p) {
    for (std::size_t axis = 0; axis < 3; axis++) {
      lower[axis] = std::min(lower[axis], p[axis]);
      upper[axis] = std::max(upper[axis], p[axis]);
    }
  }
  double extent(int axis) const { return upper[axis] - lower[axis]; }
  double longest() const { return std::max({extent(0), extent(1), extent(2)}); }
};

// A cube about a mesh, halved along each axis again and again: the planes of level l halve its cells of level l - 1.
struct Grid {
  double lower[3], size;
  double place(double x, int axis) const { return (x - lower[axis]) / size * double(1 << levels); }
};

// The most important plane that a box lies on both sides of: that of the lowest level.
struct Plane {
  int axis = -1, level = levels + 1;
  double at = 0;
};

Plane plane_of(const Grid &grid, const Box &box) {
  Plane plane;
  double longest = 0;
  for (int axis = 0; axis < 3; axis++) {
    const double last = double((1 << levels) - 1);
    const auto low = uint(std::clamp(std::floor(grid.place(box.lower[axis], axis)), 0.0, last));
    const auto high = uint(std::clamp(std::ceil(grid.place(box.upper[axis], axis)) - 1, 0.0, last));
    if (high <= low) continue;
    const int bit = 31 - __builtin_clz(low ^ high), level = levels - bit;
    const double at = grid.lower[axis] + grid.size * (double(high >> bit << bit) / double(1 << levels));
    if (!(at > box.lower[axis] && at < box.upper[axis])) continue;
    if (level < plane.level || (level == plane.level && box.extent(axis) > longest)) {
      plane = {axis, level, at};
      longest = box.extent(axis);
    }
  }
  return plane;
}

std::array<Point, 3> corners_of(const FlatScene &scene, uint triangle) {
  std::array<Point, 3> corners;
  for (std::size_t k = 0; k < 3; k++)
    for (std::size_t axis = 0; axis < 3; axis++) corners[k][axis] = double(scene.vertices[scene.triangles[triangle].vertex[k]].position[axis]);
  return corners;
}

Box box_of(std::span<const Point> points) {
  Box box;
  for (const Point &p : points) box.include(p);
  return box;
}

// What a triangle is worth splitting: the area its box wastes, less at planes of no importance; its cube root spreads splits well [Karras13, 4.2].
float priority_of(const Grid &grid, const std::array<Point, 3> &corners) {
  const Box box = box_of(corners);
  const Plane plane = plane_of(grid, box);
  if (plane.axis < 0) return 0.0f;
  double a[3], b[3];
  for (std::size_t axis = 0; axis < 3; axis++) {
    a[axis] = corners[1][axis] - corners[0][axis];
    b[axis] = corners[2][axis] - corners[0][axis];
  }
  const double ideal = std::fabs(a[1] * b[2] - a[2] * b[1]) + std::fabs(a[2] * b[0] - a[0] * b[2]) + std::fabs(a[0] * b[1] - a[1] * b[0]);
  const double x = box.extent(0), y = box.extent(1), z = box.extent(2), area = 2 * (x * y + y * z + z * x);
  const double worth = (area - ideal) / (grid.size * grid.size) * std::ldexp(1.0, -plane.level);
  return worth > 1e-30 ? kernel::pow_real(float(worth), 1.0f / 3.0f) : 0.0f;
}

// Outwards to floats, and by a little more that makes up for the errors of a hit's distance (docs/decisions/0002-hits.md), within the triangle's own box.
Fragment fragment_of(uint triangle, const Box &piece, const Box &whole) {
  Fragment fragment{};
  fragment.primitive = triangle;
  const double margin = whole.longest() * double(SUN_FRAGMENT_MARGIN);
  for (int axis = 0; axis < 3; axis++) {
    const float lower = std::nextafter(float(piece.lower[axis] - margin), -INFINITY), upper = std::nextafter(float(piece.upper[axis] + margin), INFINITY);
    fragment.lower[axis] = std::max(lower, float(whole.lower[axis]));
    fragment.upper[axis] = std::min(upper, float(whole.upper[axis]));
  }
  return fragment;
}

// Cuts the part of a triangle within `polygon` by up to `splits` planes.
void split(const Grid &grid, uint triangle, const Box &whole, const std::vector<Point> &polygon, uint splits, std::vector<Fragment> &out) {
  const Box box = box_of(polygon);
  const Plane plane = splits ? plane_of(grid, box) : Plane{};
  if (plane.axis < 0) {
    out.push_back(fragment_of(triangle, box, whole));
    return;
  }
  const auto axis = static_cast<std::size_t>(plane.axis);
  std::vector<Point> below, above;
  for (std::size_t i = 0; i < polygon.size(); i++) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    if (p[axis] <= plane.at) below.push_back(p);
    if (p[axis] >= plane.at) above.push_back(p);
    if ((p[axis] < plane.at && q[axis] > plane.at) || (p[axis] > plane.at && q[axis] < plane.at)) {
      const double t = (plane.at - p[axis]) / (q[axis] - p[axis]);
      Point cut;
      for (std::size_t k = 0; k < 3; k++) cut[k] = p[k] + t * (q[k] - p[k]);
      cut[axis] = plane.at;
      below.push_back(cut);
      above.push_back(cut);
    }
  }
  const double low = box_of(below).longest(), high = box_of(above).longest();
  const uint rest = splits - 1, share = std::min(rest, uint(std::floor(double(rest) * (low / (low + high)) + 0.5)));
  split(grid, triangle, whole, below, share, out);
  split(grid, triangle, whole, above, rest - share, out);
}

// The factor by which priorities become numbers of splits, so that all together stay within `most`.
double scale_of(std::span<const float> priorities, std::uint64_t most) {
  const auto total = [&](double scale) {
    std::uint64_t sum = 0;
    for (const float p : priorities) sum += std::uint64_t(std::min(double(p) * scale, most_splits));
    return sum;
  };
  double low = 0, high = 1;
  while (high < 1e30 && total(high) <= most) high *= 2;
  for (int i = 0; i < 24; i++) {
    const double middle = 0.5 * (low + high);
    (total(middle) <= most ? low : high) = middle;
  }
  return low;
}

std::vector<Fragment> fragments_of(const FlatScene &scene, const MeshRange &mesh, const SplitOptions &options) {
  if (mesh.deforms || mesh.triangle_count < std::max(1u, options.least_triangles)) return {};
  Box bounds;
  for (uint i = 0; i < mesh.triangle_count; i++)
    for (const Point &p : corners_of(scene, mesh.first_triangle + i)) {
      // Where this is not so the tree's build says it, or does without areas.
      for (const double x : p)
        if (!(std::fabs(x) < largest_coordinate)) return {};
      bounds.include(p);
    }
  const Grid grid{{bounds.lower[0], bounds.lower[1], bounds.lower[2]}, bounds.longest()};
  if (!(grid.size > 1e-9)) return {};  // products of smaller coordinates have no remainders to tell

  std::vector<float> priorities(mesh.triangle_count);
  const uint chunks = (mesh.triangle_count + chunk - 1) / chunk;
  const auto in_chunks = [&](auto &&work) {
    tbb::parallel_for(uint(0), chunks, [&](uint c) {
      for (uint i = c * chunk; i < std::min((c + 1) * chunk, mesh.triangle_count); i++) work(c, i);
    });
  };
  in_chunks([&](uint, uint i) { priorities[i] = priority_of(grid, corners_of(scene, mesh.first_triangle + i)); });
  const double scale = scale_of(priorities, std::uint64_t(options.splits_a_triangle * double(mesh.triangle_count)));

  std::vector<std::vector<Fragment>> parts(chunks);
  in_chunks([&](uint c, uint i) {
    const uint splits = uint(std::min(double(priorities[i]) * scale, most_splits));
    if (!splits) return;
    const std::array<Point, 3> corners = corners_of(scene, mesh.first_triangle + i);
    split(grid, mesh.first_triangle + i, box_of(corners), {corners.begin(), corners.end()}, splits, parts[c]);
  });
  std::vector<Fragment> all;
  for (const std::vector<Fragment> &part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

void split_long_triangles(FlatScene &scene, const SplitOptions &options) {
  Fragment none{};
  none.primitive = SUN_NONE;
  scene.fragments.assign(1, none);
  for (MeshRange &mesh : scene.meshes) {
    const std::vector<Fragment> made = fragments_of(scene, mesh, options);
    mesh.first_fragment = uint(scene.fragments.size());
    mesh.fragment_count = uint(made.size());
    scene.fragments.insert(scene.fragments.end(), made.begin(), made.end());
    if (scene.fragments.size() > SUN_ID_PRIMITIVE) throw Error{"flatten", "more than 2^29 pieces of triangles", "use a simpler scene"};
  }
  scene.fragments[0].count = uint(scene.fragments.size() - 1);
  scene.fragments.push_back(none);
}

}  // namespace sunstone
