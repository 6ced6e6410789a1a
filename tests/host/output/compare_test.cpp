// SPDX-License-Identifier: Apache-2.0
// Metrics worked out by hand; FLIP against figures of its authors' program.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "base/error.h"
#include "output/color.h"
#include "output/flip.h"
#include "output/output.h"

namespace sunstone {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();

Image picture(int width, int height, std::vector<float> rgb) { return {"a picture", width, height, 3, std::move(rgb)}; }

}  // namespace

TEST(Compare, ByHand) {
  // Differences 0.5 at r = 0 and -0.25 at r = 1, four values without.
  const Image reference = picture(1, 2, {0, 1, 1, 0.5f, 1, 0}), image = picture(1, 2, {0, 1, 1, 0.5f, 0.75f, 0.5f});
  const Comparison result = compare_images(image, reference);
  EXPECT_DOUBLE_EQ(result.rmse, std::sqrt((0.25 + 0.0625) / 6));
  EXPECT_DOUBLE_EQ(result.relmse, (0.25 / 0.01 + 0.0625 / 1.01) / 6);
  EXPECT_DOUBLE_EQ(result.psnr, 10 * std::log10(6 / 0.3125));
  EXPECT_EQ(result.largest, 0.5);
  EXPECT_EQ(result.largest_x, 0);
  EXPECT_EQ(result.largest_y, 1);
  EXPECT_EQ(result.bad_pixels, 0u);
  EXPECT_NE(compare_images(reference, image).relmse, result.relmse) << "the reference is the second";
}

TEST(Compare, EqualPictures) {
  const Image a = picture(2, 1, {0, 1, 1e6f, 0.5f, -1, 0});
  const Comparison result = compare_images(a, a);
  EXPECT_EQ(result.rmse, 0);
  EXPECT_EQ(result.relmse, 0);
  EXPECT_EQ(result.psnr, infinity);
  EXPECT_EQ(result.flip, 0);
  EXPECT_EQ(result.largest, 0);
}

TEST(Compare, WhatIsNotFiniteIsCountedAndLeftOut) {
  const Image reference = picture(4, 1, {0, 0, 0, nan, 0, 0, 0, 0, 0, 0.5f, 0, 0}),
              image = picture(4, 1, {0, -infinity, 0, 0, 0, 0, infinity, nan, 0, 0.75f, 0, 0});
  const Comparison result = compare_images(image, reference);
  EXPECT_EQ(result.bad_pixels, 3u);
  EXPECT_DOUBLE_EQ(result.rmse, std::sqrt(0.0625 / 3));
  EXPECT_EQ(result.largest_x, 3);
  EXPECT_TRUE(std::isfinite(result.flip));
  const Image bad = picture(1, 1, {nan, nan, nan});
  EXPECT_EQ(compare_images(bad, bad).rmse, infinity) << "nothing is known, so nothing is near";
  EXPECT_EQ(compare_images(bad, bad).flip, 1);
}

TEST(Compare, OtherSizesAreRefused) {
  const Image a = picture(2, 1, std::vector<float>(6)), b = picture(1, 2, std::vector<float>(6));
  EXPECT_THROW(compare_images(a, b), Error);
  EXPECT_THROW(compare_images(picture(2, 1, std::vector<float>(5)), a), Error);
  EXPECT_THROW(compare_images({"grey", 2, 1, 1, std::vector<float>(2)}, a), Error);
  EXPECT_THROW(compare_images({"bytes", 2, 1, 3, std::vector<std::uint8_t>(6)}, a), Error);
}

namespace {

constexpr int width = 64, height = 48;
using Bytes = std::vector<int>;  // RGB
using Value = std::function<int(int channel, int x, int y)>;

Bytes bytes_of(const Value &f) {
  Bytes bytes;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++) bytes.push_back(f(c, x, y));
  return bytes;
}
Bytes solid(int r, int g, int b) {
  return bytes_of([=](int c, int, int) { return c == 0 ? r : c == 1 ? g : b; });
}
Bytes gradient(int shift) {
  return bytes_of([=](int c, int x, int y) { return (((x + shift) * (3 + c) + y * (c != 1 ? 2 : 4)) / 2) % 256; });
}
Bytes noisy_gradient() {
  const Bytes base = gradient(0);
  return bytes_of([&](int c, int x, int y) {
    return std::min(255, base[static_cast<std::size_t>((y * width + x) * 3 + c)] + (x * x * 7 + y * 13 * x + y * y * 5 + c * 31) % 41);
  });
}

struct Flip {
  double mean = 0, largest = 0;
};
Flip flip(const Bytes &reference, const Bytes &test, double pixels_per_degree = flip_pixels_per_degree) {
  const auto linear = [](const Bytes &bytes) {
    std::vector<float> values;
    for (const int byte : bytes) values.push_back(static_cast<float>(srgb_decode(byte / 255.0)));
    return values;
  };
  const std::vector<float> errors = flip_errors(linear(test), linear(reference), width, height, pixels_per_degree);
  Flip result;
  for (const float error : errors) {
    EXPECT_GE(error, 0);
    EXPECT_LE(error, 1);
    result.mean += error / static_cast<double>(errors.size());
    result.largest = std::max(result.largest, static_cast<double>(error));
  }
  return result;
}

}  // namespace

// The figures are those of flip-evaluator 1.7, the authors' own program (PyPI), for the same bytes; it computes in floats.
TEST(Flip, AgreesWithItsAuthors) {
  struct Case {
    const char *name;
    Bytes reference, test;
    double pixels_per_degree, mean, largest;
  };
  const Bytes smooth = gradient(0), noisy = noisy_gradient(), grey = solid(128, 128, 128);
  Bytes dot = grey, line = grey;
  const auto paint = [](Bytes &bytes, int x, int y, std::array<int, 3> rgb) {
    std::copy(rgb.begin(), rgb.end(), bytes.begin() + (y * width + x) * 3);
  };
  paint(dot, 32, 24, {255, 255, 255});
  for (int y = 0; y < height; y++) paint(line, 32, y, {200, 40, 90});
  const std::vector<Case> cases = {{"black and white", solid(0, 0, 0), solid(255, 255, 255), 67, 0.9673653, 0.9673918},
                                   {"red and green", solid(255, 0, 0), solid(0, 255, 0), 67, 0.9866497, 0.9866658},
                                   {"green and blue", solid(0, 255, 0), solid(0, 0, 255), 67, 1, 1},
                                   {"a shift by a pixel", smooth, gradient(1), 67, 0.0625756, 0.0681817},
                                   {"noise", smooth, noisy, 67, 0.3210474, 0.4502539},
                                   {"noise seen from near", smooth, noisy, 30, 0.3472483, 0.5597051},
                                   {"a dot", grey, dot, 67, 0.0014004, 0.3788172},
                                   {"a line", grey, line, 67, 0.0250613, 0.4215566}};
  for (const Case &each : cases) {
    const Flip result = flip(each.reference, each.test, each.pixels_per_degree);
    EXPECT_NEAR(result.mean, each.mean, 2e-4) << each.name;
    EXPECT_NEAR(result.largest, each.largest, 5e-4) << each.name;
    const Flip swapped = flip(each.test, each.reference, each.pixels_per_degree);
    EXPECT_NEAR(swapped.mean, result.mean, 1e-6) << each.name << ": either may be the reference";
  }
}

TEST(Flip, HighlightsAreShownAtExposureZero) {
  const Image bright = picture(4, 4, std::vector<float>(48, 5.0f)), white = picture(4, 4, std::vector<float>(48, 1.0f)),
              dark = picture(4, 4, std::vector<float>(48, -1.0f)), black = picture(4, 4, std::vector<float>(48, 0.0f));
  EXPECT_EQ(compare_images(bright, white).flip, 0) << "both are white on a screen";
  EXPECT_EQ(compare_images(dark, black).flip, 0);
  EXPECT_GT(compare_images(bright, white).rmse, 3.9);
  EXPECT_GT(compare_images(bright, black).flip, 0.95);
}

}  // namespace sunstone
