// SPDX-License-Identifier: Apache-2.0
// Pieces of long triangles: they cover their triangles, and a ray finds what it would find without them.
#include "flatten/bvh.h"
#include "flatten/fragments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/hits/brute_force.h"
#include "kernels/hits/cases.h"
#include "scene/ray.h"

namespace sunstone::hits {
namespace {

using glm::vec3;
using kernel::Fragment;
using kernel::uint;

vec3 corner(const FlatScene &scene, uint triangle, int k) {
  const float *p = scene.vertices[scene.triangles[triangle].vertex[k]].position;
  return {p[0], p[1], p[2]};
}

TEST(Fragments, CoverTheirTriangles) {
  const Case c = in_pieces(random_triangles());
  ASSERT_GT(c.scene.fragments.size(), 2 * c.scene.triangles.size());
  Random random(3);
  std::size_t points = 0, cut = 0;
  for (std::size_t first = 0; first < c.scene.fragments.size();) {
    const uint triangle = c.scene.fragments[first].primitive;
    std::size_t last = first;
    if (triangle == SUN_NONE) {
      first++;
      continue;
    }
    while (last < c.scene.fragments.size() && c.scene.fragments[last].primitive == triangle) last++;
    EXPECT_GT(last, first + 1) << "a triangle in one piece";
    const vec3 a = corner(c.scene, triangle, 0), b = corner(c.scene, triangle, 1), d = corner(c.scene, triangle, 2);
    for (int i = 0; i < 50; i++, points++) {
      float u = random.unit(), v = random.unit();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const vec3 p = i < 3 ? (i == 0 ? a : i == 1 ? b : d) : a + u * (b - a) + v * (d - a);
      std::size_t within = 0;
      for (std::size_t f = first; f < last; f++) {
        const Fragment &piece = c.scene.fragments[f];
        bool inside = true;
        for (int axis = 0; axis < 3; axis++) inside = inside && p[axis] >= piece.lower[axis] - 1e-6f && p[axis] <= piece.upper[axis] + 1e-6f;
        within += inside;
      }
      EXPECT_GE(within, 1u);
      cut += within < last - first;
    }
    first = last;
  }
  EXPECT_GT(cut, points / 2) << "the pieces' boxes are no smaller than the triangle's";
}

// Whatever is in pieces is hit where it was whole, at the same distance but for rounding.
TEST(Fragments, ChangeNoHitButForRounding) {
  for (const Case &whole : {random_triangles(), boxes_on_floor(), instances(), one_turned_instance()}) {
    const Case pieces = in_pieces(whole);
    std::size_t hits = 0, wrong = 0;
    for (std::size_t i = 0; i < whole.rays.size(); i++) {
      const kernel::Hit a = brute_force(whole.scene, {whole.rays[i]}, SUN_WANT_ALL), b = brute_force(pieces.scene, {whole.rays[i]}, SUN_WANT_ALL);
      hits += a.instance != SUN_NONE;
      const bool near = std::fabs(a.t - b.t) <= 1e-5f * std::max(1.0f, std::fabs(a.t));
      wrong += (a.instance == SUN_NONE) != (b.instance == SUN_NONE) || (a.instance != SUN_NONE && !near);
    }
    EXPECT_GT(hits, whole.rays.size() / 20) << whole.name;
    EXPECT_EQ(wrong, 0u) << whole.name << ", of " << whole.rays.size();
  }
}

// A needle as long as the scene is seen along its length and across it, and passed: once.
TEST(Fragments, AreHitOnce) {
  Soup soup;
  soup.triangle({-5, -5, -5}, {5, 5, 5}, {5, 5.01f, 5});
  soup.triangle({-5, 5, -5}, {5, -5, 5}, {5, -5, 5.3f});
  Case c{"needles", soup.finish(), {}};
  c = in_pieces(std::move(c));
  ASSERT_GE(c.scene.fragments.size(), 6u);
  Random random(8);
  std::size_t hits = 0;
  for (int i = 0; i < 20000; i++) {
    const uint triangle = random.number() & 1;
    const vec3 a = corner(c.scene, triangle, 0), b = corner(c.scene, triangle, 1), d = corner(c.scene, triangle, 2);
    float u = random.unit(), v = random.unit();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const vec3 target = a + u * (b - a) + v * (d - a);
    vec3 origin = target + 3.0f * random.direction();
    if (i % 4 == 0) origin = target + (b - a) * 0.3f + 0.02f * random.direction();  // nearly along it
    const std::vector<kernel::Hit> all = all_hits(c.scene, {make_ray(origin, target - origin)}, SUN_WANT_ALL);
    std::size_t of_it = 0;
    for (const kernel::Hit &hit : all) of_it += hit.primitive == triangle;
    hits += of_it;
    EXPECT_LE(of_it, 1u);
  }
  EXPECT_GT(hits, 15000u);
}

// Rays nearly within the plane of a long triangle, whose t from rounded areas is off by many pieces. The tree holds pieces alone, and where it is asked for
// the very t that the whole triangle gives, and for nothing before or behind it, it culls all but those that hold t: there has to be one.
TEST(Fragments, AreFoundByGrazingRays) {
  Random random(17);
  std::size_t hits = 0, wrong = 0, rays = 0;
  for (int round = 0; round < 24; round++) {
    Soup soup;
    const vec3 a = 10.0f * random.direction(), b = 10.0f * random.direction(), d = 10.0f * random.direction();
    soup.triangle(a, b, d);
    FlatScene scene = soup.finish();
    split_long_triangles(scene, {.least_triangles = 1, .splits_a_triangle = 400});
    ASSERT_GT(scene.fragments.size(), 300u);
    const Tree tree = build_tree(scene, Layout::binary);
    const vec3 x = glm::normalize(b - a), normal = glm::normalize(glm::cross(b - a, d - a)), y = glm::cross(normal, x);
    for (int i = 0; i < 4000; i++, rays++) {
      float u = random.unit(), v = random.unit();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const float angle = 6.2831853f * random.unit(), tilt = std::exp2(-8.0f - 30.0f * random.unit());
      const vec3 along = std::cos(angle) * x + std::sin(angle) * y + tilt * normal;
      TracedRay ray{make_ray(a + u * (b - a) + v * (d - a) - random.in(1, 20) * along, along)};
      const kernel::Hit whole = brute_force(scene, ray, SUN_WANT_ALL);
      if (whole.instance != SUN_NONE) {
        ray.ray.t_max = std::nextafter(whole.t, INFINITY);
        ray.ray.passed_t = std::nextafter(whole.t, 0.0f);
      }
      const kernel::Hit found = host_closest(scene, tree, ray, SUN_WANT_ALL);
      hits += whole.instance != SUN_NONE;
      wrong += !same(whole, found);
    }
  }
  EXPECT_GT(hits, rays / 10);
  EXPECT_EQ(wrong, 0u) << "of " << hits << " hits";
}

TEST(Fragments, LeaveSmallMeshesAlone) {
  Case c = one_turned_instance();
  ASSERT_EQ(c.scene.triangles.size(), 200u);
  split_long_triangles(c.scene);
  EXPECT_EQ(c.scene.meshes[0].fragment_count, 0u);
  split_long_triangles(c.scene, {.least_triangles = 200});
  EXPECT_GT(c.scene.meshes[0].fragment_count, 30u);
}

}  // namespace
}  // namespace sunstone::hits
