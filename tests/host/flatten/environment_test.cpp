// SPDX-License-Identifier: Apache-2.0
// The environment's radiance, sampling and pdf, as kernels/scene/emitter.h answers over the arrays that flatten makes.
#include "flatten/environment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/flatten/flatten_support.h"
#include "scene/emitter.h"

namespace sunstone {
namespace {

constexpr double pi = 3.141592653589793;

struct Map {
  std::vector<float> texels, cdf;
  kernel::Environment environment{};
};

Map map_of(kernel::uint width, kernel::uint height, std::vector<float> texels, float rotation = 0) {
  Map map;
  map.texels = std::move(texels);
  map.environment.kind = SUN_ENVIRONMENT_MAP;
  map.environment.width = width;
  map.environment.height = height;
  map.environment.rotation = rotation;
  map.cdf = environment_distribution(map.texels, width, height);
  return map;
}

std::vector<float> random_texels(int count, std::uint32_t seed) {
  Random random(seed);
  std::vector<float> texels(static_cast<std::size_t>(3 * count));
  for (float &x : texels) x = std::pow(random.number(), 4.0f) * 5;
  return texels;
}

Map random_map() { return map_of(13, 7, random_texels(13 * 7, 1), 0.3f); }
// One bright texel in a dark map: all rows but three have weight 0.
Map pixel_map() {
  std::vector<float> texels(3 * 32 * 16);
  for (int c = 0; c < 3; c++) texels[static_cast<std::size_t>(3 * (5 * 32 + 31) + c)] = 1000;
  return map_of(32, 16, texels);
}
// A black lower half under a dim gradient with a sun.
Map sky_map() {
  std::vector<float> texels(3 * 24 * 12);
  for (int y = 0; y < 6; y++)
    for (int x = 0; x < 24; x++)
      for (int c = 0; c < 3; c++)
        texels[static_cast<std::size_t>(3 * (y * 24 + x) + c)] = 0.1f + 0.05f * float(y) + (x == 3 && y == 2 ? 500.0f : 0.0f);
  return map_of(24, 12, texels, 0.77f);
}
Map even_map() { return map_of(8, 4, std::vector<float>(3 * 8 * 4, 0.7f)); }

kernel::vec3 direction_of(double theta, double phi) {
  return {float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)), float(std::sin(theta) * std::sin(phi))};
}

// The chance of each cell by integrating environment_pdf over it, at n x n points.
std::vector<double> cell_integrals(const Map &map, int n) {
  const int w = int(map.environment.width), h = int(map.environment.height);
  std::vector<double> cells(static_cast<std::size_t>(w * h));
  for (int y = 0; y < h * n; y++)
    for (int x = 0; x < w * n; x++) {
      const double theta = pi * (y + 0.5) / (h * n), phi = 2 * pi * ((x + 0.5) / (w * n) - 0.5 - map.environment.rotation);
      const double pdf = kernel::environment_pdf(&map.environment, map.cdf.data(), direction_of(theta, phi));
      cells[static_cast<std::size_t>((y / n) * w + x / n)] += pdf * std::sin(theta) * (pi / (h * n)) * (2 * pi / (w * n));
    }
  return cells;
}

class Maps : public testing::TestWithParam<Map (*)()> {};

TEST_P(Maps, PdfIntegratesToOne) {
  double sum = 0;
  for (double cell : cell_integrals(GetParam()(), 8)) sum += cell;
  EXPECT_NEAR(sum, 1, 2e-5);
}

// Chi-squared over the cells; the 10^-6 quantile by Wilson and Hilferty's cube root.
TEST_P(Maps, SamplesFollowThePdf) {
  const Map map = GetParam()();
  const std::vector<double> expected = cell_integrals(map, 4);
  const int w = int(map.environment.width), h = int(map.environment.height), samples = 400000;
  std::vector<double> counts(expected.size());
  Random random(99);
  for (int i = 0; i < samples; i++) {
    const float u0 = random.number(), u1 = random.number();
    const kernel::EnvironmentSample sample = kernel::environment_sample(&map.environment, map.cdf.data(), u0, u1);
    ASSERT_NEAR(kernel::dot3(sample.direction, sample.direction), 1, 1e-5);
    if (sample.pdf == 0) continue;
    const double u = 0.5 + std::atan2(double(sample.direction.z), double(sample.direction.x)) / (2 * pi) + map.environment.rotation;
    const double x = (u - std::floor(u)) * w, y = std::acos(std::min(1.0, std::max(-1.0, double(sample.direction.y)))) / pi * h;
    counts[static_cast<std::size_t>(std::min(int(y), h - 1) * w + std::min(int(x), w - 1))]++;
    // Both say the same pdf, but where rounding moved the direction into the neighbouring cell.
    if (std::fabs(x - std::round(x)) < 1e-3 || std::fabs(y - std::round(y)) < 1e-3) continue;
    ASSERT_NEAR(kernel::environment_pdf(&map.environment, map.cdf.data(), sample.direction) / sample.pdf, 1, 1e-4);
  }
  double statistic = 0, rest_expected = 0, rest_count = 0;
  int cells = 0;
  for (std::size_t i = 0; i < expected.size(); i++) {
    const double mean = expected[i] * samples;
    if (mean < 10) {
      rest_expected += mean;
      rest_count += counts[i];
      continue;
    }
    statistic += (counts[i] - mean) * (counts[i] - mean) / mean;
    cells++;
  }
  if (rest_expected > 10) {
    statistic += (rest_count - rest_expected) * (rest_count - rest_expected) / rest_expected;
    cells++;
  } else {
    EXPECT_LT(rest_count, 60);
  }
  const double freedom = std::max(cells - 1, 1), spread = 2 / (9 * freedom);
  EXPECT_LT(statistic, freedom * std::pow(1 - spread + 4.753 * std::sqrt(spread), 3)) << cells << " cells";
}

// With the compensated distribution and uniform directions joined by the balance heuristic, the integral of the radiance comes out.
TEST_P(Maps, MultipleImportanceSamplingIsUnbiased) {
  const Map map = GetParam()();
  double expected = 0;
  const int n = 400;
  for (int y = 0; y < n; y++)
    for (int x = 0; x < 2 * n; x++) {
      const double theta = pi * (y + 0.5) / n;
      expected += kernel::environment_radiance(&map.environment, map.texels.data(), direction_of(theta, pi * (x + 0.5) / n)).y * std::sin(theta) *
                  (pi / n) * (pi / n);
    }
  Random random(5);
  const int samples = 200000;
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; i++) {
    double value = 0;
    const kernel::EnvironmentSample sample = kernel::environment_sample(&map.environment, map.cdf.data(), random.number(), random.number());
    if (sample.pdf > 0) value += kernel::environment_radiance(&map.environment, map.texels.data(), sample.direction).y / (sample.pdf + 1 / (4 * pi));
    const double y = random.between(-1, 1), phi = random.between(0, float(2 * pi));
    const kernel::vec3 uniform = direction_of(std::acos(y), phi);
    value += kernel::environment_radiance(&map.environment, map.texels.data(), uniform).y /
             (kernel::environment_pdf(&map.environment, map.cdf.data(), uniform) + 1 / (4 * pi));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / samples, error = std::sqrt((squares / samples - mean * mean) / samples);
  EXPECT_NEAR(mean, expected, 5 * error + 1e-3 * expected);
}

INSTANTIATE_TEST_SUITE_P(Environment, Maps, testing::Values(&random_map, &pixel_map, &sky_map, &even_map));

TEST(Environment, RadianceIsBilinearWrapsAroundAndClampsAtThePoles) {
  const Map map = random_map();
  const int w = 13, h = 7;
  Random random(3);
  for (int i = 0; i < 5000; i++) {
    const double theta = pi * random.number(), phi = 2 * pi * random.number();
    if (std::sin(theta) < 0.01) continue;
    const kernel::vec3 value = kernel::environment_radiance(&map.environment, map.texels.data(), direction_of(theta, phi));
    double u = 0.5 + phi / (2 * pi) + double(map.environment.rotation);
    const double x = (u - std::floor(u)) * w - 0.5, y = theta / pi * h - 0.5;
    double expected = 0;
    for (int dy = 0; dy < 2; dy++)
      for (int dx = 0; dx < 2; dx++) {
        const int column = (int(std::floor(x)) + dx + w) % w, row = std::min(std::max(int(std::floor(y)) + dy, 0), h - 1);
        const double fx = x - std::floor(x), fy = y - std::floor(y);
        expected += (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy) * map.texels[static_cast<std::size_t>(3 * (row * w + column) + 1)];
      }
    ASSERT_NEAR(value.y, expected, 2e-4);
  }
}

TEST(Environment, CompensationLeavesOutWhatIsBelowTheMean) {
  const Map map = sky_map();
  const kernel::vec3 dim = direction_of(pi * 0.4, 1.0), below = direction_of(pi * 0.9, 1.0);
  EXPECT_EQ(kernel::environment_pdf(&map.environment, map.cdf.data(), dim), 0.0f);
  EXPECT_EQ(kernel::environment_pdf(&map.environment, map.cdf.data(), below), 0.0f);
  const Map even = even_map();  // nothing is above its mean: uncompensated, about uniform
  EXPECT_NEAR(kernel::environment_pdf(&even.environment, even.cdf.data(), dim), 1 / (4 * pi), 0.02);
}

TEST(Environment, EveryTableEndsAtOneInStepsOfTheSampleNumbers) {
  const Map map = pixel_map();
  const auto check = [](const float *cdf, std::size_t n) {
    EXPECT_EQ(cdf[0], 0.0f);
    EXPECT_EQ(cdf[n], 1.0f);
    for (std::size_t i = 0; i < n; i++) {
      EXPECT_LE(cdf[i], cdf[i + 1]);
      EXPECT_EQ(cdf[i] * 0x1p24f, std::floor(cdf[i] * 0x1p24f));
    }
  };
  check(map.cdf.data(), 16);
  for (std::size_t y = 0; y < 16; y++) check(map.cdf.data() + 17 + 33 * y, 32);
}

Scene scene_with(const Image &image, float strength) {
  Scene scene = scene_of(square());
  scene.environment.kind = Environment::Kind::map;
  scene.environment.map = std::make_shared<Image>(image);
  scene.environment.strength = strength;
  return scene;
}

TEST(Environment, OfBlackIsNoEmitterButAMap) {
  const FlatScene flat = flattened(scene_with(float_image(4, 2, 3, std::vector<float>(24)), 1));
  EXPECT_EQ(flat.environment.kind, kernel::uint(SUN_ENVIRONMENT_MAP));
  EXPECT_EQ(flat.environment.emitter, SUN_NONE);
  EXPECT_TRUE(flat.emitters.empty());
}

TEST(Environment, StrengthIsInTheTexels) {
  const FlatScene flat = flattened(scene_with(float_image(4, 2, 3, std::vector<float>(24, 0.5f)), 3));
  EXPECT_EQ(flat.environment_texels[7], 1.5f);
  EXPECT_EQ(flat.environment.emitter, 0u);
  EXPECT_EQ(flat.emitters[0].pmf, 1.0f);
}

TEST(Environment, BadValuesAreClampedWithAWarning) {
  std::vector<float> texels(24, 1);
  texels[0] = NAN;
  texels[1] = -3;
  texels[2] = INFINITY;
  Notices notices;
  const FlatScene flat = flatten(scene_with(float_image(4, 2, 3, texels), 1), {}, notices);
  EXPECT_EQ(notices.all().size(), 1u);
  EXPECT_EQ(flat.environment_texels[0], 0.0f);
  EXPECT_EQ(flat.environment_texels[1], 0.0f);
  EXPECT_EQ(flat.environment_texels[2], 1e30f);
}

TEST(Environment, ConstantSky) {
  Scene scene = scene_of(square());
  scene.environment.kind = Environment::Kind::constant;
  scene.environment.constant = {1, 2, 3};
  scene.environment.strength = 2;
  const FlatScene flat = flattened(scene);
  EXPECT_EQ(flat.environment.kind, kernel::uint(SUN_ENVIRONMENT_CONSTANT));
  Random random(2);
  double mean_y = 0;
  for (int i = 0; i < 10000; i++) {
    const auto sample = kernel::environment_sample(&flat.environment, nullptr, random.number(), random.number());
    EXPECT_NEAR(kernel::dot3(sample.direction, sample.direction), 1, 1e-5);
    EXPECT_EQ(sample.pdf, kernel::environment_pdf(&flat.environment, nullptr, sample.direction));
    EXPECT_EQ(kernel::environment_radiance(&flat.environment, nullptr, sample.direction).z, 6.0f);
    mean_y += sample.direction.y / 10000;
  }
  EXPECT_NEAR(mean_y, 0, 0.03);
}

}  // namespace
}  // namespace sunstone
