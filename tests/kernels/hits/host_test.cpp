// SPDX-License-Identifier: Apache-2.0
// The kernels' traversal compiled as C++ against brute force, and the rules of a hit one by one.
#include <gtest/gtest.h>

#include <cmath>

#include "flatten/bvh.h"
#include "kernels/hits/brute_force.h"
#include "kernels/hits/cases.h"
#include "scene/ray.h"

namespace sunstone::hits {
namespace {

using glm::vec3;
using kernel::uint;

TEST(Hits, BinaryTreeFindsWhatBruteForceFinds) {
  for (const Case &c : all_cases()) {
    const Tree tree = build_tree(c.scene, Layout::binary);
    int wrong = 0, found = 0;
    for (const TraceRay &ray : c.rays) {
      const kernel::Hit expected = brute_force(c.scene, {ray}, SUN_WANT_ALL), got = host_closest(c.scene, tree, {ray}, SUN_WANT_ALL);
      wrong += !same(expected, got);
      wrong += host_any(c.scene, tree, {ray}, SUN_WANT_ALL) != (expected.instance != SUN_NONE);
      found += expected.instance != SUN_NONE;
    }
    EXPECT_EQ(wrong, 0) << c.name;
    EXPECT_GT(found, int(c.rays.size() / 20)) << c.name << ": the rays hardly hit anything";
    EXPECT_LT(found, int(c.rays.size())) << c.name << ": the rays hit always";
  }
}

// A triangle in the plane z = 0, counter-clockwise seen from +z.
FlatScene one_triangle(uint bits, const Matrix &to_world = identity) {
  Soup soup;
  soup.begin_mesh();
  soup.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, bits);
  soup.instance(0, to_world);
  return soup.finish();
}

bool hits(const FlatScene &scene, const TraceRay &ray, uint want = SUN_WANT_ALL) { return brute_force(scene, {ray}, want).instance != SUN_NONE; }

TEST(Hits, SingleSidedTrianglesShowTheirFrontAlone) {
  const TraceRay front = make_ray({0.25f, 0.25f, 1}, {0, 0, -1}), back = make_ray({0.25f, 0.25f, -1}, {0, 0, 1});
  EXPECT_TRUE(hits(one_triangle(0), front));
  EXPECT_TRUE(hits(one_triangle(0), back));
  EXPECT_TRUE(hits(one_triangle(SUN_ID_SINGLE_SIDED), front));
  EXPECT_FALSE(hits(one_triangle(SUN_ID_SINGLE_SIDED), back));
  // For rays along each axis and both ways.
  for (int axis = 0; axis < 3; axis++)
    for (const float sign : {1.0f, -1.0f}) {
      Soup soup;
      vec3 a(0), b(0), origin(0.25f), direction(0);
      a[(axis + 1) % 3] = 1;
      b[(axis + 2) % 3] = 1;
      soup.triangle(vec3(0), a, b, SUN_ID_SINGLE_SIDED);  // a x b points along +axis
      origin[axis] = sign;
      direction[axis] = -sign;
      EXPECT_EQ(hits(soup.finish(), make_ray(origin, direction)), sign > 0) << axis;
    }
  // A mirror turns the winding around in space; the front stays the front of the mesh.
  const FlatScene mirrored = one_triangle(SUN_ID_SINGLE_SIDED, scaling(1, 1, -1));
  EXPECT_FALSE(hits(mirrored, front));
  EXPECT_TRUE(hits(mirrored, back));
  const FlatScene mirrored_x = one_triangle(SUN_ID_SINGLE_SIDED, scaling(-1, 1, 1));
  EXPECT_TRUE(hits(mirrored_x, make_ray({-0.25f, 0.25f, 1}, {0, 0, -1})));
  EXPECT_FALSE(hits(mirrored_x, make_ray({-0.25f, 0.25f, -1}, {0, 0, 1})));
}

TEST(Hits, KindsAreChosen) {
  const TraceRay ray = make_ray({0.25f, 0.25f, 1}, {0, 0, -1});
  for (const uint bits : {0u, SUN_ID_PASSABLE}) {
    EXPECT_TRUE(hits(one_triangle(bits), ray, SUN_WANT_ALL));
    EXPECT_EQ(hits(one_triangle(bits), ray, SUN_WANT_OPAQUE), bits == 0);
    EXPECT_EQ(hits(one_triangle(bits), ray, SUN_WANT_PASSABLE), bits != 0);
  }
}

TEST(Hits, IntervalIsOpen) {
  const FlatScene scene = one_triangle(0);
  EXPECT_FALSE(hits(scene, make_ray({0.25f, 0.25f, 1}, {0, 0, -1}, 1.0f)));
  EXPECT_TRUE(hits(scene, make_ray({0.25f, 0.25f, 1}, {0, 0, -1}, std::nextafter(1.0f, 2.0f))));
  EXPECT_FALSE(hits(scene, make_ray({0.25f, 0.25f, 0}, {0, 0, -1})));
}

TEST(Hits, BarycentricsNameTheCorners) {
  const FlatScene scene = one_triangle(0);
  const kernel::Hit hit = brute_force(scene, {make_ray({0.25f, 0.5f, 2}, {0, 0, -1})}, SUN_WANT_ALL);
  EXPECT_FLOAT_EQ(hit.t, 2.0f);
  EXPECT_FLOAT_EQ(hit.u, 0.25f);
  EXPECT_FLOAT_EQ(hit.v, 0.5f);
  EXPECT_EQ(hit.primitive, 0u);
  EXPECT_EQ(hit.instance, 0u);
}

// The key of a hit decides between equals: instance first, then primitive, whatever the order they are met in.
TEST(Hits, TiesGoToTheSmallestNumbers) {
  Soup soup;
  const uint a = soup.begin_mesh();
  for (int i = 0; i < 9; i++) soup.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  soup.instance(a, translation(1, 0, 0));
  soup.instance(a, identity);
  soup.instance(a, identity);
  const FlatScene scene = soup.finish();
  const Tree tree = build_tree(scene, Layout::binary);
  const kernel::Hit hit = host_closest(scene, tree, {make_ray({0.25f, 0.25f, 1}, {0, 0, -1})}, SUN_WANT_ALL);
  EXPECT_EQ(hit.instance, 1u);
  EXPECT_EQ(hit.primitive, 0u);
}

// Slabs: nested boxes have nested intervals, exactly; and they are conservative.
TEST(Hits, SlabsNestAndContain) {
  Random random(11);
  int crossed = 0;
  for (int i = 0; i < 20000; i++) {
    const float scale = std::exp2(random.in(-10, 10));
    vec3 l = scale * random.in_box(vec3(-1), vec3(1)), u = l + scale * random.in_box(vec3(0), vec3(1));
    if (i % 3 == 0) u.y = l.y;
    const vec3 outer_l = l - (i % 2 ? scale * random.in_box(vec3(0), vec3(1e-6f)) : vec3(0)),
               outer_u = u + scale * random.in_box(vec3(0), vec3(0.1f));
    const vec3 origin = scale * random.in_box(vec3(-3), vec3(3)), inside = random.in_box(l, u);
    vec3 direction = inside - origin;
    if (i % 5 == 0) direction[i % 3] = 0;
    const float reach[3] = {10 * scale, 10 * scale, 10 * scale};
    kernel::PreparedRay ray;
    ASSERT_TRUE(kernel::prepare_ray(&ray, &origin.x, &direction.x, reach));
    const auto in = kernel::box_interval(&ray, l.x, l.y, l.z, u.x, u.y, u.z, 0);
    const auto out = kernel::box_interval(&ray, outer_l.x, outer_l.y, outer_l.z, outer_u.x, outer_u.y, outer_u.z, 0);
    EXPECT_LE(out.near, in.near);
    EXPECT_GE(out.far, in.far);
    if (i % 5 == 0) continue;
    EXPECT_LE(in.near, in.far);  // aimed at a point inside
    EXPECT_LE(in.near, 1.0f);
    EXPECT_GE(in.far, 1.0f);
    crossed++;
  }
  EXPECT_GT(crossed, 10000);
}

// Going on behind each hit meets every hit once, in order, ties included.
TEST(Hits, ContinuingEnumeratesAll) {
  for (const Case &c : all_cases()) {
    const Tree tree = build_tree(c.scene, Layout::binary);
    std::size_t wrong = 0, total = 0, most = 0;
    for (std::size_t i = 0; i < c.rays.size(); i += 7)
      for (const uint want : {SUN_WANT_ALL, SUN_WANT_PASSABLE}) {
        const std::vector<kernel::Hit> expected = all_hits(c.scene, {c.rays[i]}, want);
        TracedRay ray{c.rays[i]};
        std::size_t met = 0;
        for (;; met++) {
          const kernel::Hit hit = host_closest(c.scene, tree, ray, want);
          if (hit.instance == SUN_NONE) break;
          if (met >= expected.size() || !same(hit, expected[met])) {
            wrong++;
            break;
          }
          ray.ray.passed_t = hit.t;
          ray.passed_instance = hit.instance;
          ray.passed_primitive = hit.primitive;
        }
        wrong += met != expected.size();
        total += met;
        most = std::max(most, met);
      }
    EXPECT_EQ(wrong, 0u) << c.name;
    EXPECT_GT(total, 100u) << c.name;
    EXPECT_GT(most, 2u) << c.name;
  }
}

}  // namespace
}  // namespace sunstone::hits
