// SPDX-License-Identifier: Apache-2.0
// The radius within which vcm merges, where it is left to the program: it follows what is seen, not how large the scene is around it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/render.h"
#include "support/scenes.h"

namespace sunstone::test {
namespace {

// A wall at a distance of 2, square to the view and filling it, in a room of that half size.
Scene wall_in_a_room(float half) {
  Scene scene;
  add(scene, quad({0, 0, -2}, {2, 0, 0}, {0, 2, 0}), matt({0.7f, 0.6f, 0.5f}));
  add(scene, box({-half, -half, -half}, {half, half, half}, true), matt({0.5f, 0.5f, 0.5f}));
  add_point_light(scene, {0, 0, 0.5f}, {1, 1, 1});
  add_camera(scene, {0, 0, 0}, {0, 0, -1}, 40);
  return scene;
}

std::string radius_of(const Case &scene, const RenderSettings &s, const Ways &ways = {}) { return render(scene, s, {0, 1}, ways).film.settings.at("radius"); }

RenderSettings vcm(int width, int height) {
  RenderSettings s = picture(width, height, 2);
  s.integrator = "vcm";
  return s;
}

}  // namespace

TEST(Radius, OfVcmIsTwoPixelsOfWhatIsSeen) {
  const double pixel = 2 * std::tan(20 * 3.14159265358979 / 180) * 2 / 24;  // where the wall is nearest; at its corners it is 1.2 times as far
  std::string first;
  for (const float half : {4.0f, 40.0f}) {
    const Case scene(wall_in_a_room(half));
    const std::string radius = radius_of(scene, vcm(32, 24));
    EXPECT_GT(std::stod(radius), 2 * pixel) << half;
    EXPECT_LT(std::stod(radius), 2.2 * pixel) << half;
    if (first.empty()) first = radius;
    EXPECT_EQ(radius, first);
    for (const auto &[how, ways] : other_ways()) EXPECT_EQ(radius_of(scene, vcm(32, 24), ways), radius) << how;
  }
  // Half as large with pixels of half the size.
  const double finer = std::stod(radius_of(Case(wall_in_a_room(40)), vcm(64, 48)));
  EXPECT_NEAR(finer / std::stod(first), 0.5, 0.02);
}

TEST(Radius, OfVcmIsNoLargerThanTheSceneAsks) {
  // Nothing is seen, or a scene no larger than a few pixels: by the scene's size and the light subpaths, as without a view.
  Scene scene = wall_in_a_room(4);
  scene.cameras.clear();
  add_camera(scene, {0, 0, 500}, {0, 0, 0}, 40);
  const double radius = std::stod(radius_of(Case(scene), vcm(32, 24))), size = 4 * std::sqrt(3.0);
  EXPECT_NEAR(radius, size / std::sqrt(32.0 * 24), 1e-3 * radius);
  scene.cameras.clear();
  add_camera(scene, {0, 0, 500}, {0, 0, 1000}, 40);
  EXPECT_NEAR(std::stod(radius_of(Case(scene), vcm(32, 24))), radius, 1e-6);
}

TEST(Radius, OfVcmThatIsGivenStays) {
  RenderSettings s = vcm(32, 24);
  s.radius = 0.25f;
  EXPECT_EQ(radius_of(Case(wall_in_a_room(4)), s), "0.25");
}

}  // namespace sunstone::test
