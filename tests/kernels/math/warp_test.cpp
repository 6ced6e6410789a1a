// SPDX-License-Identifier: Apache-2.0
// Each warp against its density: counts of warped points on a grid, by chi2 against the density integrated over each cell.
#include "math/warp.h"

#include <gtest/gtest.h>

#include <functional>

#include "chi2.h"
#include "math/hash.h"

namespace sunstone::kernel {
namespace {

using test::chi2_limit;
using test::chi2_score;

constexpr uint samples = 200000;

vec2 square(uint i, uint stream) { return make_vec2(unit_of_hash(hash3(i, stream, 0)), unit_of_hash(hash3(i, stream, 1))); }
// Corners and edges of the square, then random points.
vec2 any_square(uint i) {
  constexpr float edge[] = {0, 5.96046448e-8f, 0.5f, 0.99999994f};
  return i < 16 ? make_vec2(edge[i % 4], edge[i / 4]) : square(i, 9);
}

using Warp = std::function<vec3(vec2)>;
using Density = std::function<double(vec3)>;

// Directions on a grid of (cos, phi), whose cells are equal in solid angle.
double direction_score(const Warp &warp, const Density &density) {
  constexpr int rows = 40, columns = 40, fine = 8;
  std::vector<double> counts(rows * columns), expected(rows * columns);
  for (uint i = 0; i < samples; i++) {
    const vec3 v = warp(square(i, 0));
    const int row = std::min(rows - 1, static_cast<int>((v.z * 0.5 + 0.5) * rows));
    const double turn = std::atan2(v.y, v.x) / (2 * M_PI);
    counts[row * columns + std::min(columns - 1, static_cast<int>((turn - std::floor(turn)) * columns))]++;
  }
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < columns; column++)
      for (int i = 0; i < fine; i++)
        for (int j = 0; j < fine; j++) {
          const double z = -1 + 2 * (row + (i + 0.5) / fine) / rows, phi = 2 * M_PI * (column + (j + 0.5) / fine) / columns, r = std::sqrt(1 - z * z);
          const vec3 v = make_vec3(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z));
          expected[row * columns + column] += samples * density(v) * 4 * M_PI / (rows * columns * fine * fine);
        }
  return chi2_score(counts, expected);
}

void expect_unit(const Warp &warp) {
  for (uint i = 0; i < 100000; i++) {
    const vec3 v = warp(any_square(i));
    ASSERT_NEAR(std::sqrt(static_cast<double>(v.x) * v.x + static_cast<double>(v.y) * v.y + static_cast<double>(v.z) * v.z), 1, 3e-7) << i;
  }
}

TEST(Warp, CosineHemisphere) {
  expect_unit(square_to_cosine_hemisphere);
  EXPECT_LT(direction_score(square_to_cosine_hemisphere, square_to_cosine_hemisphere_pdf), chi2_limit);
  for (uint i = 0; i < 100000; i++) ASSERT_GE(square_to_cosine_hemisphere(any_square(i)).z, 0);
}

TEST(Warp, UniformHemisphere) {
  expect_unit(square_to_uniform_hemisphere);
  EXPECT_LT(direction_score(square_to_uniform_hemisphere, square_to_uniform_hemisphere_pdf), chi2_limit);
}

TEST(Warp, UniformSphere) {
  expect_unit(square_to_uniform_sphere);
  EXPECT_LT(direction_score(square_to_uniform_sphere, [](vec3) { return square_to_uniform_sphere_pdf(); }), chi2_limit);
}

TEST(Warp, Cone) {
  for (const float height : {2.0f, 1.0f, 0.35f}) {
    const auto warp = [&](vec2 u) { return square_to_cone(u, height); };
    expect_unit(warp);
    EXPECT_LT(direction_score(warp, [&](vec3 v) { return v.z >= 1 - height ? square_to_cone_pdf(height) : 0; }), chi2_limit) << height;
  }
  EXPECT_EQ(square_to_cone_pdf(0), 0);
  // A cone of 10^-4 radians: the sine must keep its digits although the cosine rounds to 1.
  const float height = 5e-9f;
  double squares = 0;
  for (uint i = 0; i < 10000; i++) {
    const vec3 v = square_to_cone(square(i, 3), height);
    const double sine = std::hypot(v.x, v.y);
    ASSERT_LE(sine, 1.0001e-4);
    squares += sine * sine;
  }
  EXPECT_NEAR(squares / 10000, height, 5 * height / std::sqrt(3 * 10000));
}

// A density that is off by a tenth must be seen: the test can fail.
TEST(Warp, TheTestSeesAWrongDensity) {
  EXPECT_GT(direction_score(square_to_cosine_hemisphere, [](vec3 v) { return v.z > 0 ? 0.9 * v.z / M_PI + 0.1 / (2 * M_PI) : 0; }), chi2_limit);
  EXPECT_GT(direction_score(square_to_uniform_sphere, [](vec3 v) { return (1 + 0.1 * v.x) / (4 * M_PI); }), chi2_limit);
}

TEST(Warp, Disk) {
  constexpr int n = 30, fine = 16;
  std::vector<double> counts(n * n), expected(n * n);
  const auto cell = [](float a) { return std::min(n - 1, static_cast<int>((a * 0.5 + 0.5) * n)); };
  for (uint i = 0; i < samples; i++) {
    const vec2 p = square_to_disk(square(i, 1));
    counts[cell(p.x) * n + cell(p.y)]++;
  }
  // By polar strips, so that the cells at the rim get their part without a jagged edge.
  constexpr int rings = n * fine * 2, turns = n * fine * 2;
  for (int ring = 0; ring < rings; ring++)
    for (int turn = 0; turn < turns; turn++) {
      const double radius = std::sqrt((ring + 0.5) / rings), angle = 2 * M_PI * (turn + 0.5) / turns;
      const vec2 p = make_vec2(static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle)));
      expected[cell(p.x) * n + cell(p.y)] += samples * square_to_disk_pdf(p) * M_PI / (static_cast<double>(rings) * turns);
    }
  EXPECT_LT(chi2_score(counts, expected), chi2_limit);
  for (uint i = 0; i < 100000; i++) {
    const vec2 p = square_to_disk(any_square(i));
    ASSERT_LE(std::hypot(static_cast<double>(p.x), static_cast<double>(p.y)), 1 + 2e-7);
  }
  EXPECT_EQ(square_to_disk(make_vec2(0.5f, 0.5f)).x, 0);
  EXPECT_EQ(square_to_disk_pdf(make_vec2(1, 1)), 0);
}

TEST(Warp, Triangle) {
  constexpr int n = 24;
  // Cells of the barycentric grid: those on the diagonal are half as large.
  std::vector<double> counts(n * n), expected(n * n);
  for (uint i = 0; i < samples; i++) {
    const vec2 b = square_to_triangle(square(i, 2));
    counts[static_cast<std::size_t>(b.x * n) * n + static_cast<std::size_t>(b.y * n)]++;
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; i + j < n; j++) expected[i * n + j] = samples * (i + j == n - 1 ? 1.0 : 2.0) / (n * n);
  EXPECT_LT(chi2_score(counts, expected), chi2_limit);
  for (uint i = 0; i < 100000; i++) {
    const vec2 b = square_to_triangle(any_square(i));
    ASSERT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1) << b.x << " " << b.y;
  }
  EXPECT_FLOAT_EQ(square_to_triangle_pdf(0.25f), 4);
  EXPECT_EQ(square_to_triangle_pdf(0), 0);
}

}  // namespace
}  // namespace sunstone::kernel
