// SPDX-License-Identifier: Apache-2.0
// Changes of measure, and heuristics that stay in order for densities of any size.
#include "math/measure.h"

#include <gtest/gtest.h>

#include <limits>

namespace sunstone::kernel {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float densities[] = {0.0f, 1e-45f, 1e-38f, 1e-20f, 0.3f, 1.0f, 7.0f, 1e20f, 3e38f, infinity};

TEST(Measure, HeuristicsAddUpToOne) {
  for (const float a : densities)
    for (const float b : densities) {
      const float balance = balance_heuristic(a, b), power = power_heuristic(a, b);
      for (const float weight : {balance, power}) {
        EXPECT_GE(weight, 0) << a << " " << b;
        EXPECT_LE(weight, 1) << a << " " << b;
      }
      if (a == 0) {
        EXPECT_EQ(balance, 0);
        EXPECT_EQ(power, 0);
      }
      if (a == 0 && b == 0) continue;
      EXPECT_NEAR(balance + balance_heuristic(b, a), 1, 1e-6) << a << " " << b;
      EXPECT_NEAR(power + power_heuristic(b, a), 1, 1e-6) << a << " " << b;
    }
}

TEST(Measure, HeuristicsKnownValues) {
  EXPECT_FLOAT_EQ(balance_heuristic(1, 3), 0.25f);
  EXPECT_FLOAT_EQ(power_heuristic(1, 3), 0.1f);
  EXPECT_FLOAT_EQ(power_heuristic(3e30f, 1e30f), 0.9f);
  EXPECT_FLOAT_EQ(power_heuristic(3e-30f, 1e-30f), 0.9f);
  EXPECT_EQ(power_heuristic(5, 0), 1);
  EXPECT_EQ(power_heuristic(infinity, 5), 1);
  EXPECT_EQ(power_heuristic(5, infinity), 0);
}

TEST(Measure, AreaAndSolidAngle) {
  EXPECT_FLOAT_EQ(pdf_area_to_solid_angle(0.5f, 9, -0.25f), 18);
  EXPECT_FLOAT_EQ(pdf_solid_angle_to_area(18, 9, 0.25f), 0.5f);
  EXPECT_EQ(pdf_area_to_solid_angle(0.5f, 9, 0), 0);
  EXPECT_EQ(pdf_solid_angle_to_area(18, 0, 1), 0);
}

TEST(Measure, Cosines) {
  EXPECT_EQ(clamp_cosine(1.0000001f), 1);
  EXPECT_EQ(clamp_cosine(-1.0000001f), -1);
  EXPECT_EQ(positive_cosine(-0.5f), 0);
  EXPECT_EQ(positive_cosine(0.5f), 0.5f);
  EXPECT_EQ(abs_cosine(-1.0000001f), 1);
}

}  // namespace
}  // namespace sunstone::kernel
