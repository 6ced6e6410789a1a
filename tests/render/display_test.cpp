// SPDX-License-Identifier: Apache-2.0
// Frames for a display: each its own camera's though two are under way at once, one picture whatever the ways, bytes by the curve of sRGB, and what the film has.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <span>

#include "flatten/camera.h"
#include "support/render.h"
#include "support/scenes.h"

namespace sunstone::test {
namespace {

using Frame = std::vector<kernel::uint>;

RenderSettings view(int width, int height) {
  RenderSettings s = picture(width, height, 5);
  s.integrator = "whitted";
  s.filter = box_filter();
  s.ambient = {0.1f, 0.2f, 0.3f};
  return s;
}

// Two balls, seen by cameras that look this way and that.
struct Flight {
  Case scene;
  std::vector<kernel::Camera> cameras;
};

Scene balls() {
  Scene scene;
  add_shape(scene, Shape::Kind::quad, matt({0.75f, 0.5f, 0.25f}), scaled({6, 1, 6}, {0, 0, 0}));
  add_shape(scene, Shape::Kind::sphere, glass({0, 0, 0}), scaled({1, 1, 1}, {-1.2f, 1, 0}));
  add_shape(scene, Shape::Kind::sphere, metal({0.9f, 0.6f, 0.3f}, 0), scaled({1, 1, 1}, {1.2f, 1, 0}));
  add_point_light(scene, {-3, 7, 4}, {150, 150, 150});
  set_sky(scene, {0.35f, 0.55f, 0.9f});
  add_camera(scene, {0, 2, 7}, {0, 0.3f, 0}, 40);
  return scene;
}

Flight fly(int width, int height, float narrower = 1) {
  Flight flight{Case(balls()), {}};
  for (int i = 0; i < 5; i++) {
    kernel::Camera camera = flight.scene.camera(width, height);
    const float angle = 0.09f * static_cast<float>(i - 2), s = std::sin(angle), c = std::cos(angle);
    for (float *v : {camera.right, camera.up, camera.forward}) {
      const float x = v[0], z = v[2];
      v[0] = c * x + s * z;
      v[2] = c * z - s * x;
    }
    for (float *v : {camera.right, camera.up})
      for (int k = 0; k < 3; k++) v[k] *= narrower;
    flight.cameras.push_back(camera);
  }
  return flight;
}

double srgb(double linear) { return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055); }

double channel(kernel::uint word, int c) { return static_cast<double>(word >> (8 * c) & 255u); }

}  // namespace

TEST(Display, AFrameIsOfItsOwnCamera) {
  const Flight flight = fly(37, 22);
  const std::span<const kernel::Camera> cameras = flight.cameras;
  std::set<Frame> different;
  for (std::size_t i = 0; i < cameras.size(); i++) {
    const Frame alone = show(flight.scene, view(37, 22), cameras.subspan(i, 1), 1);
    ASSERT_EQ(alone.size(), 37u * 22u);
    EXPECT_EQ(show(flight.scene, view(37, 22), cameras.first(i + 1), 1), alone) << i << " frames before it";
    different.insert(alone);
  }
  EXPECT_EQ(different.size(), cameras.size());
}

TEST(Display, OnePictureWhateverTheWays) {
  const Flight flight = fly(37, 22);
  const std::span<const kernel::Camera> camera = std::span(flight.cameras).first(1);
  const Frame usual = show(flight.scene, view(37, 22), camera, 1);
  for (const auto &[name, ways] : other_ways()) EXPECT_EQ(show(flight.scene, view(37, 22), camera, 1, ways), usual) << name;
  for (const unsigned lanes : {1u, 16u}) {
    Ways ways;
    ways.lanes = lanes;
    ways.trimmed = true;
    ways.few_shapes = true;
    EXPECT_EQ(show(flight.scene, view(37, 22), camera, 1, ways), usual) << "few shapes, lanes " << lanes;
  }
}

// Half of a step of rounding, and the tenth that the curve is off.
TEST(Display, BytesFollowTheCurveOfSrgb) {
  Scene scene;
  set_sky(scene, {1, 0.5f, 0.125f});
  add_camera(scene, {0, 0, 0}, {0, 0, -1}, 40);
  const Case sky(scene);
  const std::vector camera{sky.camera(4, 4)};
  const RenderSettings settings = view(4, 4);
  for (int i = 0; i <= 120; i++) {
    const float scale = i == 0 ? 0.0f : std::exp2(static_cast<float>(i - 110) / 8);  // 2^-13.6 to 2^1.25
    const Frame frame = show(sky, settings, camera, scale);
    for (const kernel::uint word : frame) {
      ASSERT_EQ(word >> 24, 255u);
      for (int c = 0; c < 3; c++) {
        const double linear = static_cast<double>(scale) * (c == 0 ? 1 : c == 1 ? 0.5 : 0.125);
        ASSERT_NEAR(channel(word, c), linear >= 1 ? 255 : srgb(linear), 0.6) << "scale " << scale << ", channel " << c;
      }
    }
  }
}

// Through a hundredth of a degree, where a pixel's middle and its mean are one.
TEST(Display, ShowsWhatTheFilmHas) {
  const Flight flight = fly(4, 4, 3e-4f);
  std::set<kernel::uint> different;
  for (const kernel::Camera &camera : flight.cameras) {
    const Frame frame = show(flight.scene, view(4, 4), std::span(&camera, 1), 0.5f);
    const Film film = render(flight.scene, view(4, 4), {0, 4}, {}, {}, &camera).film;
    different.insert(frame[5]);
    for (int c = 0; c < 3; c++) EXPECT_NEAR(channel(frame[5], c), srgb(std::min(1.0, 0.5 * mean(film, "beauty", whole(film), c))), 1) << c;
  }
  EXPECT_GE(different.size(), 4u);
}

}  // namespace sunstone::test
