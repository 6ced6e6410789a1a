// SPDX-License-Identifier: Apache-2.0
#include "learn/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace sunstone {

TEST(Fit, LinesThatAreKnown) {
  const std::vector<double> x = {-1, 0, 2, 5}, y = {5, 3, -1, -7};
  const Line line = fit_line(x, y);
  EXPECT_NEAR(line.slope, -2, 1e-12);
  EXPECT_NEAR(line.intercept, 3, 1e-12);
  EXPECT_NEAR(line.slope_error, 0, 1e-7);
  // Points (0, 0), (1, 2), (2, 1): slope 1/2, residuals -1/2, 1, -1/2, so the error is sqrt((3/2) / 1 / 2).
  const Line scattered = fit_line(std::vector<double>{0, 1, 2}, std::vector<double>{0, 2, 1});
  EXPECT_NEAR(scattered.slope, 0.5, 1e-12);
  EXPECT_NEAR(scattered.intercept, 0.5, 1e-12);
  EXPECT_NEAR(scattered.slope_error, std::sqrt(0.75), 1e-12);
}

TEST(Fit, PowersThatAreKnown) {
  std::vector<double> n, error;
  for (double samples = 1; samples < 1e6; samples *= 3) {
    n.push_back(samples);
    error.push_back(0.25 / std::sqrt(samples));
  }
  const Line line = fit_power(n, error);
  EXPECT_NEAR(line.slope, -0.5, 1e-12);
  EXPECT_NEAR(std::exp(line.intercept), 0.25, 1e-12);
}

TEST(Fit, WhatHasNoSlope) {
  EXPECT_THROW(fit_line(std::vector<double>{1}, std::vector<double>{1}), Error);
  EXPECT_THROW(fit_line(std::vector<double>{1, 2}, std::vector<double>{1}), Error);
  EXPECT_THROW(fit_line(std::vector<double>{2, 2, 2}, std::vector<double>{1, 2, 3}), Error);
  EXPECT_THROW(fit_power(std::vector<double>{1, 2}, std::vector<double>{0, 1}), Error);
}

TEST(Ticks, AreRoundAndWithin) {
  EXPECT_EQ(linear_ticks(0, 10, 6), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(linear_ticks(0, 1, 11).size(), 11u);
  for (const auto &[low, high] : std::vector<std::pair<double, double>>{{0, 16}, {-3.2, 7.7}, {1e-5, 2e-5}, {0, 12345}, {0.99, 1.01}}) {
    const std::vector<double> ticks = linear_ticks(low, high, 8);
    EXPECT_GE(ticks.size(), 2u) << low << " " << high;
    EXPECT_LE(ticks.size(), 8u) << low << " " << high;
    const double span = high - low;
    EXPECT_GE(ticks.front(), low - 1e-9 * span);
    EXPECT_LE(ticks.back(), high + 1e-9 * span);
    const double step = ticks[1] - ticks[0], mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    EXPECT_TRUE(std::fabs(mantissa - 1) < 1e-6 || std::fabs(mantissa - 2) < 1e-6 || std::fabs(mantissa - 5) < 1e-6) << step;
  }
}

TEST(Ticks, OfLogarithmicAxesAreDecades) {
  const std::vector<double> all = log_ticks(0.5, 100000, 8);
  ASSERT_EQ(all.size(), 6u);
  for (std::size_t i = 0; i < all.size(); i++) EXPECT_DOUBLE_EQ(all[i], std::pow(10.0, static_cast<double>(i)));
  EXPECT_LE(log_ticks(1e-20, 1e20, 8).size(), 8u);
  EXPECT_GE(log_ticks(1e-20, 1e20, 8).size(), 4u);
  EXPECT_TRUE(log_ticks(0, 10, 8).empty());
  EXPECT_EQ(log_ticks(1, 1, 8).size(), 1u);
}

TEST(Numbers, AreShown) {
  EXPECT_EQ(show_number(0), "0");
  EXPECT_EQ(show_number(0.25), "0.25");
  EXPECT_EQ(show_number(-2), "−2");
  EXPECT_EQ(show_number(100), "100");
  EXPECT_EQ(show_number(1024), "1\u202f024");
  EXPECT_EQ(show_number(100000, 6), "100\u202f000");
  EXPECT_EQ(show_number(3.14159, 3), "3.14");
  EXPECT_EQ(show_number(1e-4), "10⁻⁴");
  EXPECT_EQ(show_number(2.5e-7), "2.5·10⁻⁷");
  EXPECT_EQ(show_number(9.99999e-5, 3), "10⁻⁴");
  EXPECT_EQ(show_number(1e7), "10⁷");
  EXPECT_EQ(show_number(std::nan("")), "–");
  EXPECT_EQ(show_number(INFINITY), "∞");
}

}  // namespace sunstone
