// SPDX-License-Identifier: Apache-2.0
// Hits of every layout on the device are those of brute force on the host: t, u, v bit for bit, instance and primitive. So no layout can change a
// picture.
#include <gtest/gtest.h>

#include "kernels/hits/cases.h"
#include "kernels/hits/tracer.h"
#include "scene/ray.h"

namespace sunstone::hits {
namespace {

using kernel::uint;

constexpr Layout layouts[] = {Layout::binary, Layout::wide8, Layout::wide16};
constexpr const char *names[] = {"binary", "wide8", "wide16"};

// A tracer a layout; programs are built once.
class Layouts : public testing::Test {
 protected:
  void SetUp() override {
    device_ = test_device();
    if (!device_) GTEST_SKIP() << "SKIP: no OpenCL device";
  }
  void load(const FlatScene &scene) {
    for (std::size_t k = 0; k < std::size(layouts); k++) {
      if (k < tracers_.size())
        tracers_[k].load(scene);
      else
        tracers_.emplace_back(*device_, scene, layouts[k]);
    }
  }
  std::optional<Device> device_;
  std::vector<Tracer> tracers_;
};

TEST_F(Layouts, GiveTheHitsOfBruteForce) {
  for (const Case &c : all_cases()) {
    load(c.scene);
    const std::vector<TracedRay> rays(c.rays.begin(), c.rays.end());
    for (const uint want : {SUN_WANT_ALL, SUN_WANT_OPAQUE, SUN_WANT_PASSABLE}) {
      std::vector<kernel::Hit> expected;
      for (const TracedRay &ray : rays) expected.push_back(brute_force(c.scene, ray, want));
      for (std::size_t k = 0; k < tracers_.size(); k++) {
        const std::vector<kernel::Hit> hits = tracers_[k].closest(rays, want);
        const std::vector<uint> any = tracers_[k].any(rays, want);
        std::size_t wrong = 0, wrong_any = 0;
        for (std::size_t i = 0; i < rays.size(); i++) {
          wrong += !same(hits[i], expected[i]);
          wrong_any += (any[i] != 0) != (expected[i].instance != SUN_NONE);
        }
        EXPECT_EQ(wrong, 0u) << names[k] << ", " << c.name << ", of " << rays.size() << ", want " << want;
        EXPECT_EQ(wrong_any, 0u) << names[k] << ", " << c.name << ", of " << rays.size() << ", want " << want;
      }
    }
  }
}

// One after another behind the last hit: the whole list, on the device.
TEST_F(Layouts, ContinueBehindEveryHit) {
  for (const Case &c : {boxes_on_floor(), instances(), degenerate_triangles(), sides_and_kinds()}) {
    load(c.scene);
    std::vector<TracedRay> start;
    std::vector<std::vector<kernel::Hit>> expected;
    std::size_t most = 0;
    for (std::size_t i = 0; i < c.rays.size(); i += 5) {
      start.push_back({c.rays[i]});
      expected.push_back(all_hits(c.scene, start.back(), SUN_WANT_ALL));
      most = std::max(most, expected.back().size());
    }
    EXPECT_GT(most, 5u) << c.name;
    for (std::size_t k = 0; k < tracers_.size(); k++) {
      std::vector<TracedRay> rays = start;
      std::size_t wrong = 0;
      for (std::size_t step = 0; step <= most; step++) {
        const std::vector<kernel::Hit> hits = tracers_[k].closest(rays);
        for (std::size_t i = 0; i < rays.size(); i++) {
          if (step >= expected[i].size()) {
            wrong += hits[i].instance != SUN_NONE;
            continue;
          }
          wrong += !same(hits[i], expected[i][step]);
          rays[i].ray.passed_t = hits[i].t;
          rays[i].passed_instance = hits[i].instance;
          rays[i].passed_primitive = hits[i].primitive;
        }
      }
      EXPECT_EQ(wrong, 0u) << names[k] << ", " << c.name;
    }
  }
}

}  // namespace
}  // namespace sunstone::hits
