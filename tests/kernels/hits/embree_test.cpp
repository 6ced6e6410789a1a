// SPDX-License-Identifier: Apache-2.0
// Against Embree, robust: an implementation that shares no line with ours. It need not agree to the bit, nor on rays that graze an edge from outside;
// elsewhere it has to.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "bench/embree_reference.h"
#include "kernels/hits/cases.h"
#include "kernels/hits/tracer.h"

namespace sunstone::hits {
namespace {

using glm::vec3;
using kernel::uint;

struct Differences {
  std::size_t rays = 0, hits = 0, only_ours = 0, only_theirs = 0, t = 0;
};

Differences compare(const FlatScene &scene, const std::vector<TracedRay> &rays, const std::vector<kernel::Hit> &ours, float tolerance) {
  const EmbreeReference embree(scene, {.robust = true, .high = true, .threads = 2});
  std::vector<TraceRay> plain;
  for (const TracedRay &ray : rays) plain.push_back(ray.ray);
  std::vector<kernel::Hit> theirs(rays.size());
  embree.closest(plain, theirs);
  Differences d;
  d.rays = rays.size();
  for (std::size_t i = 0; i < rays.size(); i++) {
    const bool a = ours[i].instance != SUN_NONE, b = theirs[i].instance != SUN_NONE;
    d.hits += a;
    d.only_ours += a && !b;
    d.only_theirs += b && !a;
    d.t += a && b && !(std::fabs(ours[i].t - theirs[i].t) <= tolerance * std::max(1.0f, std::fabs(theirs[i].t)));
  }
  std::printf("%zu rays, %zu hit; only ours %zu, only Embree's %zu, t differs %zu\n", d.rays, d.hits, d.only_ours, d.only_theirs, d.t);
  return d;
}

class AgainstEmbree : public testing::Test {
 protected:
  void SetUp() override {
    device_ = test_device();
    if (!device_) GTEST_SKIP() << "SKIP: no OpenCL device";
  }
  std::vector<kernel::Hit> trace(const FlatScene &scene, const std::vector<TracedRay> &rays) {
    return Tracer(*device_, scene, Layout::wide16).closest(rays);
  }
  std::optional<Device> device_;
};

// In general position nothing may differ but rays within rounding of an edge: a few in a million.
TEST_F(AgainstEmbree, RandomTriangles) {
  for (const Case &c : {random_triangles(), in_pieces(random_triangles())}) {
    Random random(41);
    std::vector<TracedRay> rays;
    for (int i = 0; i < 200000; i++) rays.push_back({make_ray(random.in_box(vec3(-4), vec3(4)), random.direction())});
    const Differences d = compare(c.scene, rays, trace(c.scene, rays), 1e-3f);
    EXPECT_GT(d.hits, d.rays / 10) << c.name;
    EXPECT_LE(d.only_ours + d.only_theirs, 4u) << c.name;
    EXPECT_LE(d.t, 8u) << c.name;
  }
}

TEST_F(AgainstEmbree, Instances) {
  for (const Case &c : {instances(), in_pieces(instances())}) {
    Random random(42);
    std::vector<TracedRay> rays;
    for (int i = 0; i < 200000; i++) rays.push_back({make_ray(random.in_box(vec3(-5), vec3(5)), random.direction())});
    const Differences d = compare(c.scene, rays, trace(c.scene, rays), 1e-3f);
    EXPECT_GT(d.hits, d.rays / 10) << c.name;
    EXPECT_LE(d.only_ours + d.only_theirs, 8u) << c.name;
    EXPECT_LE(d.t, 16u) << c.name;
  }
}

// Boxes that stand on a floor, seen along the axes. Rays onto the floor's square always hit; those on the grid's lines meet silhouettes of boxes,
// where either side is right, so t is compared off the lines alone.
TEST_F(AgainstEmbree, CoplanarAxisAlignedTriangles) {
  const Case c = boxes_on_floor();
  std::vector<TracedRay> rays, on_lines;
  for (int z = 1; z < 96; z++)
    for (int x = 1; x < 96; x++) {
      const float a = float(x) / 16, b = float(z) / 16;
      auto &set = x % 16 == 0 || z % 16 == 0 ? on_lines : rays;
      set.push_back({make_ray({a, 4, b}, {0, -1, 0})});
      set.push_back({make_ray({a, 4, b}, {0.0f, -0.5f, -0.0f})});
      set.push_back({make_ray({a, -1, b}, {0, 1, 0})});
    }
  const Differences d = compare(c.scene, rays, trace(c.scene, rays), 1e-5f);
  EXPECT_EQ(d.hits, d.rays);
  EXPECT_EQ(d.only_theirs, 0u);
  EXPECT_EQ(d.t, 0u);
  const Differences lines = compare(c.scene, on_lines, trace(c.scene, on_lines), 1e-5f);
  EXPECT_EQ(lines.hits, lines.rays);
  // Random rays onto the same.
  Random random(43);
  rays.clear();
  for (int i = 0; i < 200000; i++) {
    const vec3 origin = random.in_box(vec3(-1, 0.01f, -1), vec3(7, 3, 7));
    rays.push_back({make_ray(origin, random.in_box(vec3(0.01f, 0, 0.01f), vec3(5.99f, 0, 5.99f)) - origin)});
  }
  const Differences e = compare(c.scene, rays, trace(c.scene, rays), 1e-4f);
  EXPECT_EQ(e.hits, e.rays);
  EXPECT_EQ(e.only_theirs, 0u);
  EXPECT_LE(e.t, 4u);
}

// Degenerate and aimed rays: whatever Embree's watertight test finds on triangles that have an inside, we may differ only at their silhouettes.
TEST_F(AgainstEmbree, AdversarialRays) {
  for (const Case &c : {degenerate_triangles(), far_from_origin(), in_pieces(degenerate_triangles()), in_pieces(far_from_origin())}) {
    std::vector<TracedRay> rays;
    for (const TraceRay &ray : c.rays) {
      bool plain = true;
      for (int axis = 0; axis < 3; axis++) plain = plain && std::isfinite(ray.origin[axis]) && std::isfinite(ray.direction[axis]);
      const bool some = ray.direction[0] != 0 || ray.direction[1] != 0 || ray.direction[2] != 0;
      if (plain && some && ray.t_max > 0 && ray.t_max > 1.5f) rays.push_back({ray});
    }
    std::printf("%s: ", c.name.c_str());
    const Differences d = compare(c.scene, rays, trace(c.scene, rays), 1e-2f);
    EXPECT_GT(d.hits, d.rays / 20) << c.name;
    EXPECT_LE(d.only_ours + d.only_theirs, d.rays / 20) << c.name;
    EXPECT_LE(d.t, d.rays / 20) << c.name;
  }
}

}  // namespace
}  // namespace sunstone::hits
