// SPDX-License-Identifier: Apache-2.0
// The statistics that the render tests stand on, against closed forms and against their own rate of false alarm.
#include "support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sunstone::test {

TEST(Statistics, IncompleteBetaOfClosedForms) {
  for (const double x : {0.0, 1e-6, 0.1, 0.25, 0.5, 0.9, 0.999999, 1.0}) {
    EXPECT_NEAR(incomplete_beta(1, 1, x), x, 1e-14);
    EXPECT_NEAR(incomplete_beta(1, 5, x), 1 - std::pow(1 - x, 5), 1e-13);
    EXPECT_NEAR(incomplete_beta(7, 1, x), std::pow(x, 7), 1e-13);
    EXPECT_NEAR(incomplete_beta(2, 2, x), x * x * (3 - 2 * x), 1e-13);
    EXPECT_NEAR(incomplete_beta(0.5, 0.5, x), 2 / M_PI * std::asin(std::sqrt(x)), 1e-12);
    EXPECT_NEAR(incomplete_beta(3.5, 12.25, x), 1 - incomplete_beta(12.25, 3.5, 1 - x), 1e-12);
  }
}

TEST(Statistics, StudentOfClosedForms) {
  for (const double t : {0.0, 0.3, 1.0, 2.5, 10.0, 1000.0}) {
    EXPECT_NEAR(student_two_sided(t, 1), 1 - 2 / M_PI * std::atan(t), 1e-12) << "Cauchy's distribution";
    EXPECT_NEAR(student_two_sided(t, 2), 1 - t / std::sqrt(2 + t * t), 1e-12);
    EXPECT_NEAR(student_two_sided(t, 1e8), std::erfc(t / std::sqrt(2.0)), 1e-7) << "nearly normal";
  }
  // Far out in the tail the relative error counts.
  const double t = 40, exact = 1 - t / std::sqrt(2 + t * t);
  EXPECT_NEAR(student_two_sided(t, 2) / exact, 1, 1e-9);
  for (const double p : {0.5, 1e-3, 1e-9}) EXPECT_NEAR(student_two_sided(student_quantile(p, 17), 17) / p, 1, 1e-9);
}

TEST(Statistics, WelchTellsConstantsApart) {
  const std::vector<double> a(16, 0.5), b(16, 0.5), c(16, 0.5001);
  EXPECT_EQ(welch(a, b), 1);
  EXPECT_EQ(welch(a, c), 0);
}

TEST(Statistics, WelchIsUniformUnderTheHypothesisAndSmallBeyondIt) {
  std::mt19937 generator(1);
  std::normal_distribution<double> wide(3, 2), narrow(3, 0.5), moved(4.5, 0.5);
  constexpr int tests = 20000;
  int below[2] = {0, 0};
  for (int i = 0; i < tests; i++) {
    std::vector<double> a(16), b(24);
    for (double &v : a) v = wide(generator);
    for (double &v : b) v = narrow(generator);
    const double p = welch(a, b);
    below[0] += p < 0.05;
    below[1] += p < 0.001;
  }
  EXPECT_NEAR(below[0], 0.05 * tests, 6 * std::sqrt(0.05 * tests));
  EXPECT_NEAR(below[1], 0.001 * tests, 6 * std::sqrt(0.001 * tests));
  std::vector<double> a(16), b(16);
  for (double &v : a) v = narrow(generator);
  for (double &v : b) v = moved(generator);
  EXPECT_LT(welch(a, b), 1e-6);
}

TEST(Statistics, HolmStepsDown) {
  // 0.01 <= 0.05/4; 0.014 <= 0.05/3; 0.03 > 0.05/2: and there it ends, though 0.04 < 0.05.
  const std::vector<double> p{0.03, 0.01, 0.04, 0.014};
  EXPECT_EQ(holm_rejected(p, 0.05), (std::vector<std::size_t>{1, 3}));
  EXPECT_TRUE(holm_rejected(std::vector<double>(10, 1.0), 0.05).empty());
  EXPECT_EQ(holm_rejected(std::vector<double>{1.0, 0.0}, 1e-6), (std::vector<std::size_t>{1}));
}

TEST(Statistics, IntervalsMissAsOftenAsTheySay) {
  std::mt19937 generator(2);
  std::normal_distribution<double> values(1, 3);
  int missed = 0;
  constexpr int tests = 20000;
  for (int i = 0; i < tests; i++) {
    std::vector<double> a(16);
    for (double &v : a) v = values(generator);
    const Moments m = moments(a);
    if (std::abs(m.mean - 1) > interval(m, 0.01)) missed++;
  }
  EXPECT_NEAR(missed, 0.01 * tests, 6 * std::sqrt(0.01 * tests));
}

}  // namespace sunstone::test
