// SPDX-License-Identifier: Apache-2.0
// Hits of every layout on the device are those of brute force on the host: t, u, v bit for bit, instance and primitive. So no layout can change a picture.
#include <gtest/gtest.h>

#include "kernels/hits/cases.h"
#include "kernels/hits/tracer.h"
#include "scene/ray.h"

namespace sunstone::hits {
namespace {

using kernel::uint;

class Layouts : public testing::TestWithParam<Layout> {};

TEST_P(Layouts, GiveTheHitsOfBruteForce) {
  const std::optional<Device> device = test_device();
  if (!device) GTEST_SKIP() << "SKIP: no OpenCL device";
  std::optional<Tracer> tracer;
  for (const Case &c : all_cases()) {
    if (tracer) tracer->load(c.scene);
    else tracer.emplace(*device, c.scene, GetParam());
    const std::vector<TracedRay> rays(c.rays.begin(), c.rays.end());
    for (const uint want : {SUN_WANT_ALL, SUN_WANT_OPAQUE, SUN_WANT_PASSABLE}) {
      const std::vector<kernel::Hit> hits = tracer->closest(rays, want);
      const std::vector<uint> any = tracer->any(rays, want);
      std::size_t wrong = 0, wrong_any = 0;
      for (std::size_t i = 0; i < rays.size(); i++) {
        const kernel::Hit expected = brute_force(c.scene, rays[i], want);
        wrong += !same(hits[i], expected);
        wrong_any += (any[i] != 0) != (expected.instance != SUN_NONE);
      }
      EXPECT_EQ(wrong, 0u) << c.name << " of " << rays.size() << ", want " << want;
      EXPECT_EQ(wrong_any, 0u) << c.name << " of " << rays.size() << ", want " << want;
    }
  }
}

// One after another behind the last hit: the whole list, on the device.
TEST_P(Layouts, ContinueBehindEveryHit) {
  const std::optional<Device> device = test_device();
  if (!device) GTEST_SKIP() << "SKIP: no OpenCL device";
  std::optional<Tracer> tracer;
  for (const Case &c : {boxes_on_floor(), instances(), degenerate_triangles(), sides_and_kinds()}) {
    if (tracer) tracer->load(c.scene);
    else tracer.emplace(*device, c.scene, GetParam());
    std::vector<TracedRay> rays;
    std::vector<std::vector<kernel::Hit>> expected;
    std::size_t most = 0;
    for (std::size_t i = 0; i < c.rays.size(); i += 5) {
      rays.push_back({c.rays[i]});
      expected.push_back(all_hits(c.scene, rays.back(), SUN_WANT_ALL));
      most = std::max(most, expected.back().size());
    }
    std::size_t wrong = 0;
    for (std::size_t step = 0; step <= most; step++) {
      const std::vector<kernel::Hit> hits = tracer->closest(rays);
      for (std::size_t i = 0; i < rays.size(); i++) {
        const bool more = step < expected[i].size();
        if (!more) {
          wrong += hits[i].instance != SUN_NONE;
          continue;
        }
        wrong += !same(hits[i], expected[i][step]);
        rays[i].ray.passed_t = hits[i].t;
        rays[i].passed_instance = hits[i].instance;
        rays[i].passed_primitive = hits[i].primitive;
      }
    }
    EXPECT_EQ(wrong, 0u) << c.name;
    EXPECT_GT(most, 5u) << c.name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Layouts, testing::Values(Layout::binary, Layout::wide8, Layout::wide16), [](const auto &info) {
  return std::string(info.param == Layout::binary ? "binary" : info.param == Layout::wide8 ? "wide8" : "wide16");
});

}  // namespace
}  // namespace sunstone::hits
