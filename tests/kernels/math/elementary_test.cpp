// SPDX-License-Identifier: Apache-2.0
// Elementary functions against long double: the errors that math/elementary.h states, and what happens at the edges.
#include "math/elementary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sunstone::kernel {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// |got - want| in units in the last place of want (of 2^-149 where it is subnormal).
double ulps(float got, long double want) {
  if (want == 0) return got == 0 ? 0 : 1e9;
  int exponent;
  frexpl(want, &exponent);
  return static_cast<double>(fabsl(static_cast<long double>(got) - want) / ldexpl(1, std::max(exponent - 24, -149)));
}

class Worst {
 public:
  void add(float got, long double want, float x, float y = 0) {
    const double error = ulps(got, want);
    if (error <= error_) return;
    error_ = error, x_ = x, y_ = y;
  }
  void expect_below(const char *name, double bound) const {
    EXPECT_LE(error_, bound) << name << " at " << x_ << ", " << y_;
    EXPECT_GT(error_, 0.4 * bound) << name << ": the stated error is far from the one measured";
    std::printf("%s: %.3f ULP at %.9g, %.9g\n", name, error_, static_cast<double>(x_), static_cast<double>(y_));
  }

 private:
  double error_ = -1;
  float x_ = 0, y_ = 0;
};

// Every stride-th float from lower to upper, 0 < lower.
template <class Work> void sweep(float lower, float upper, uint stride, Work &&work) {
  for (uint bits = as_uint(lower); bits <= as_uint(upper); bits += stride) work(as_float(bits));
}

TEST(Elementary, SinCos) {
  Worst sine, cosine;
  const auto check = [&](float x) {
    float s, c;
    sin_cos(x, &s, &c);
    sine.add(s, sinl(x), x);
    cosine.add(c, cosl(x), x);
  };
  sweep(1e-40f, 1e4f, 6007, check);
  for (int i = -200000; i < 200000; i++) check(0.05f * static_cast<float>(i));
  // Next to the multiples of pi/2, where most digits cancel.
  for (int k = 1; k < 6366; k++)
    for (int off = -2; off <= 2; off++) check(as_float(as_uint(static_cast<float>(k * 1.57079632679489661923L)) + static_cast<uint>(off)));
  sine.expect_below("sin", 1.6);
  cosine.expect_below("cos", 1.6);
}

TEST(Elementary, SinCosFarOut) {
  double worst = 0;
  sweep(1e4f, 1e6f, 211, [&](float x) {
    float s, c;
    sin_cos(x, &s, &c);
    worst = std::max({worst, std::fabs(static_cast<double>(s - sinl(x))), std::fabs(static_cast<double>(c - cosl(x)))});
  });
  EXPECT_LT(worst, 1e-7);
  for (const float x : {0.0f, -0.0f, 1.1e6f, -3e38f, infinity}) {
    float s, c;
    sin_cos(x, &s, &c);
    EXPECT_EQ(s, 0) << x;
    EXPECT_EQ(c, 1) << x;
  }
  float s, c;
  sin_cos(not_a_number, &s, &c);
  EXPECT_TRUE(std::isnan(s) && std::isnan(c));
}

TEST(Elementary, Exp) {
  Worst worst;
  sweep(1e-30f, 88.7228317f, 3001, [&](float x) { worst.add(exp_real(x), expl(x), x); });
  sweep(1e-30f, 104.5f, 3001, [&](float x) { worst.add(exp_real(-x), expl(-static_cast<long double>(x)), -x); });
  for (float x = -1; x < 1; x += 1e-5f) worst.add(exp_real(x), expl(x), x);
  worst.expect_below("exp", 1.0);
  EXPECT_EQ(exp_real(0), 1);
  EXPECT_EQ(exp_real(-200), 0);
  EXPECT_EQ(exp_real(-infinity), 0);
  EXPECT_EQ(exp_real(88.7228394f), SUN_FLOAT_MAX);
  EXPECT_EQ(exp_real(infinity), SUN_FLOAT_MAX);
  EXPECT_TRUE(std::isnan(exp_real(not_a_number)));
}

TEST(Elementary, Log) {
  Worst worst;
  sweep(1e-45f, SUN_FLOAT_MAX, 6007, [&](float x) { worst.add(log_real(x), logl(x), x); });
  sweep(0.5f, 2.0f, 37, [&](float x) { worst.add(log_real(x), logl(x), x); });
  worst.expect_below("log", 0.8);
  EXPECT_EQ(log_real(1), 0);
  EXPECT_EQ(log_real(0), -SUN_FLOAT_MAX);
  EXPECT_EQ(log_real(-1), -SUN_FLOAT_MAX);
  EXPECT_EQ(log_real(-infinity), -SUN_FLOAT_MAX);
  EXPECT_FLOAT_EQ(log_real(infinity), 88.7228394f);
  EXPECT_TRUE(std::isnan(log_real(not_a_number)));
}

TEST(Elementary, Pow) {
  Worst worst;
  const auto check = [&](float base, float exponent) {
    const long double want = powl(base, exponent);
    if (want <= SUN_FLOAT_MAX) worst.add(pow_real(base, exponent), want, base, exponent);
  };
  for (const float exponent : {-3.0f, -1.0f, -0.41666666f, 0.25f, 0.41666666f, 0.5f, 1.0f, 2.2f, 2.4f, 5.0f, 37.0f})
    sweep(1e-40f, 3e38f, 50021, [&](float base) { check(base, exponent); });
  for (const float base : {0.1f, 0.5f, 0.7f, 0.999f, 1.001f, 1.5f, 2.0f, 10.0f})
    for (float exponent = -140; exponent < 140; exponent += 0.013f) check(base, exponent);
  sweep(0.5f, 1.5f, 997, [&](float base) { check(base, 88.7f); });
  worst.expect_below("pow", 1.0);
  EXPECT_EQ(pow_real(0, 2), 0);
  EXPECT_EQ(pow_real(0, 0), 1);
  EXPECT_EQ(pow_real(3, 0), 1);
  EXPECT_EQ(pow_real(0, -1), SUN_FLOAT_MAX);
  EXPECT_EQ(pow_real(-5, 2), 0);
  EXPECT_EQ(pow_real(1, 1e30f), 1);
  EXPECT_EQ(pow_real(2, 1e30f), SUN_FLOAT_MAX);
  EXPECT_EQ(pow_real(2, -1e30f), 0);
  EXPECT_EQ(pow_real(1e38f, 1.02f), SUN_FLOAT_MAX);
  EXPECT_EQ(pow_real(infinity, infinity), SUN_FLOAT_MAX);
  EXPECT_EQ(pow_real(2, 10), 1024);
  EXPECT_TRUE(std::isnan(pow_real(not_a_number, 1)));
  EXPECT_TRUE(std::isnan(pow_real(1, not_a_number)));
}

TEST(Elementary, ArcSineAndCosine) {
  Worst sine, cosine;
  sweep(1e-40f, 1.0f, 2003, [&](float x) {
    sine.add(asin_real(x), asinl(x), x);
    sine.add(asin_real(-x), asinl(-x), -x);
    cosine.add(acos_real(x), acosl(x), x);
    cosine.add(acos_real(-x), acosl(-x), -x);
  });
  sweep(0.45f, 1.0f, 31, [&](float x) {
    sine.add(asin_real(x), asinl(x), x);
    cosine.add(acos_real(x), acosl(x), x);
  });
  sine.expect_below("asin", 1.6);
  cosine.expect_below("acos", 1.1);
  EXPECT_EQ(acos_real(1), 0);
  EXPECT_EQ(acos_real(1.5f), 0);
  EXPECT_EQ(acos_real(-infinity), SUN_PI);
  EXPECT_EQ(asin_real(2), SUN_HALF_PI);
  EXPECT_EQ(asin_real(-2), -SUN_HALF_PI);
  EXPECT_TRUE(std::isnan(acos_real(not_a_number)));
  EXPECT_TRUE(std::isnan(asin_real(not_a_number)));
}

TEST(Elementary, Atan2) {
  Worst worst;
  for (const float x : {-3e38f, -1.0f, -1e-40f, 1e-38f, 0.7f, 1.0f, 1e20f}) {
    sweep(1e-45f, SUN_FLOAT_MAX, 20011, [&](float y) { worst.add(atan2_real(y, x), atan2l(y, x), y, x); });
    sweep(1e-45f, SUN_FLOAT_MAX, 40009, [&](float y) { worst.add(atan2_real(-y, x), atan2l(-y, x), -y, x); });
  }
  for (int i = 0; i < 200; i++)
    for (int j = -200; j < 200; j++) {
      const float y = 0.0173f * static_cast<float>(j), x = 0.0219f * static_cast<float>(i - 100);
      if (x != 0) worst.add(atan2_real(y, x), atan2l(y, x), y, x);
    }
  worst.expect_below("atan2", 1.5);
  EXPECT_EQ(atan2_real(0, 0), 0);
  EXPECT_EQ(atan2_real(0, 1), 0);
  EXPECT_EQ(atan2_real(0, -1), SUN_PI);
  EXPECT_EQ(atan2_real(-0.0f, -1), -SUN_PI);
  EXPECT_EQ(atan2_real(1, 0), SUN_HALF_PI);
  EXPECT_EQ(atan2_real(-1, 0), -SUN_HALF_PI);
  EXPECT_TRUE(std::isnan(atan2_real(not_a_number, 1)));
  EXPECT_TRUE(std::isnan(atan2_real(1, not_a_number)));
}

}  // namespace
}  // namespace sunstone::kernel
