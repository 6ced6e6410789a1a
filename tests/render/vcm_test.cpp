// SPDX-License-Identifier: Apache-2.0
// Vertex connection and merging: bdpt, and merging in a disk beside it. Where no disk is met it is bdpt to the bit; where every strategy finds every path their weights
// add up to one; and what the disks' size leaves of an error goes away with it.
#include <gtest/gtest.h>

#include <cmath>

#include "support/agree.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace sunstone::test {
namespace {

constexpr double false_alarms = 1e-6 / 20;  // of one comparison: there are fewer than 20
constexpr std::uint32_t seeds = 24;

RenderSettings vcm(int width, int height, unsigned max_depth, float radius, float alpha = 1) {
  RenderSettings s = picture(width, height, max_depth);
  s.integrator = "vcm";
  s.radius = radius;
  s.alpha = alpha;
  return s;
}

RenderSettings with_integrator(RenderSettings s, const std::string &name) {
  const RenderSettings plain;
  s.integrator = name;
  s.radius = plain.radius;
  s.alpha = plain.alpha;
  return s;
}

// A lamp above a glass ball and a matt one, in a matt room: light that the ball gathers on the floor is hard to join.
Scene caustic_room() {
  Scene scene;
  add(scene, box({-1, 0, -1}, {1, 1.6f, 1}, true), matt({0.7f, 0.6f, 0.5f}));
  add(scene, quad({0.2f, 1.5f, 0}, {0.3f, 0, 0}, {0, 0, 0.3f}), lamp({12, 14, 16}));
  add(scene, sphere({-0.3f, 0.5f, 0}, 0.4f, 16), glass({0.3f, 0.1f, 0.2f}));
  add(scene, sphere({0.5f, 0.3f, 0.2f}, 0.25f, 12), metal({0.9f, 0.7f, 0.5f}, 0.5f));
  add_camera(scene, {0, 0.9f, 0.97f}, {0, 0.4f, 0}, 75);
  return scene;
}

// The inside of a white sphere that shines, varnished: closed, without edges, with deltas, and all that lies within a distance of a point has the area of the disk of that
// radius.
Scene round_furnace() {
  Scene scene;
  Material glowing = matt({1, 1, 1});
  glowing.f0 = glm::vec3(0.3f);
  glowing.f90 = 1;
  glowing.roughness = 0;
  glowing.emission = {1, 1, 1};
  add_shape(scene, Shape::Kind::sphere, glowing, scaled({1, 1, 1}));
  add_camera(scene, {0.1f, 0.2f, 0.3f}, {1, 0.1f, -0.4f}, 110);
  return scene;
}

}  // namespace

// In a disk of a thousandth of a millimetre no two vertices meet, and its share of the weights is less than a float holds.
TEST(Vcm, WithoutADiskIsBdptToTheBit) {
  const Case scenes[] = {Case(everything()), Case(caustic_room())};
  for (const Case &scene : scenes) {
    const RenderSettings s = vcm(24, 16, 5, 1e-6f);
    const Film merged = render(scene, s, {0, 3}).film, joined = render(scene, with_integrator(s, "bdpt"), {0, 3}).film;
    ASSERT_EQ(merged.layers.size(), joined.layers.size());
    for (std::size_t i = 0; i < merged.layers.size(); i++) EXPECT_EQ(merged.layers[i].values == joined.layers[i].values, true) << merged.layers[i].name;
  }
}

// Nothing absorbs, so each bounce is 1. Every strategy finds each path, merging in every vertex included, and which share each has changes from path to path.
TEST(Vcm, WeightsAddUpToOne) {
  for (const bool balance : {false, true}) {
    SCOPED_TRACE(balance ? "balance heuristic" : "power heuristic");
    constexpr float radius = 0.06f;
    RenderSettings s = vcm(32, 32, 4, radius);
    s.balance = balance;
    const std::vector<Film> films = render_seeds(Case(round_furnace()), s, 32, 2 * seeds);
    for (int depth = 0; depth <= 4; depth++) {
      const std::string layer = "bounce." + std::to_string(depth);
      // Normals turn within the disk, by the square of its size.
      EXPECT_EQ(differs(films, layer, whole(films[0]), {1, 1, 1}, 1e-4 + 0.2 * static_cast<double>(radius * radius)), "");
      EXPECT_LT(relative_error(films, layer), 0.0015) << layer;
    }
  }
}

// All lobes, sides, lights and null events: within a small disk the picture is that of path.
TEST(Vcm, Everything) {
  const Case scene(everything());
  const RenderSettings s = vcm(24, 16, 4, 0.02f);
  const std::vector<Film> films = render_seeds(scene, s, 64, seeds), reference = render_seeds(scene, with_integrator(s, "path"), 96, seeds);
  const Agreement agree = agreement(reference, films, bounces(0, 4), 8, false_alarms);
  EXPECT_EQ(agree.rejected, 0u) << "of " << agree.means << " means:" << agree.what;
  for (const Film &film : films) ASSERT_EQ(film.nan, 0u);
}

// The error of a caustic goes away with the radius.
TEST(Vcm, ConvergesAsTheRadiusShrinks) {
  const Case scene(caustic_room());
  const RenderSettings s = vcm(24, 16, 4, 0.02f);
  const std::vector<Film> reference = render_seeds(scene, with_integrator(s, "bdpt"), 96, seeds);
  double last = 0;
  for (const float radius : {0.32f, 0.08f, 0.02f}) {
    SCOPED_TRACE("radius " + std::to_string(radius));
    const std::vector<Film> films = render_seeds(scene, vcm(24, 16, 4, radius), 48, seeds);
    double error = 0;
    for (int y = 0; y < 16; y += 4)
      for (int x = 0; x < 24; x += 4) {
        const Window window{x, y, x + 4, y + 4};
        const double there = moments(means(reference, "beauty", window, 1)).mean, here = moments(means(films, "beauty", window, 1)).mean;
        error += std::abs(here / there - 1) / 24;
      }
    RecordProperty("error at " + std::to_string(radius), std::to_string(error));
    if (last > 0) {
      EXPECT_LT(error, 0.5 * last);
    }
    last = error;
    const Agreement agree = agreement(reference, films, bounces(0, 4), 8, false_alarms);
    if (radius > 0.3f) {
      EXPECT_GT(agree.rejected, 0u) << "the test sees nothing";
    } else if (radius < 0.03f) {
      EXPECT_EQ(agree.rejected, 0u) << "of " << agree.means << " means:" << agree.what;
    }
  }
}

// The radius of a sample is that of its number, whoever renders it.
TEST(Vcm, OneHashWhateverTheWays) {
  const Case made(everything());
  RenderSettings s = vcm(40, 32, 5, 0.1f, 2.0f / 3);
  s.layers.albedo = s.layers.normal = true;
  const Film reference = render(made, s, {0, 4}).film;
  EXPECT_EQ(reference.nan, 0u);
  for (const auto &[how, ways] : other_ways()) EXPECT_EQ(film_hash(render(made, s, {0, 4}, ways).film).hex(), film_hash(reference).hex()) << how;
  Film parts = render(made, s, {2, 4}).film;
  add_film(parts, render(made, s, {0, 2}).film);
  EXPECT_EQ(film_hash(parts).hex(), film_hash(reference).hex());
  s.alpha = 0.5f;
  EXPECT_NE(film_hash(render(made, s, {0, 4}).film).hex(), film_hash(reference).hex());
}

TEST(Vcm, CountsItsPaths) {
  const RenderCounts counts = render(Case(everything()), vcm(37, 23, 5, 0.1f), {0, 3}).counts;
  EXPECT_EQ(counts.paths, 37u * 23u * 3u);
  EXPECT_EQ(counts.ended[0] + counts.ended[1] + counts.ended[2] + counts.ended[3], counts.paths);
  EXPECT_GT(counts.shadow_rays, counts.paths / 2);
  EXPECT_EQ(counts.nan + counts.clamped, 0u);
}

// Nothing to see, no light, no scattering: and still a picture.
TEST(Vcm, OfLittle) {
  Scene dark;
  add(dark, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), matt({0.5f, 0.5f, 0.5f}));
  add_camera(dark, {0, 0, 3}, {0, 0, 0}, 40);
  const Film film = render(Case(dark), vcm(8, 8, 3, 0), {0, 2}).film;
  EXPECT_EQ(mean(film, "beauty", whole(film), 0), 0);
  const Film seen = render(Case(round_furnace()), vcm(8, 8, 0, 0), {0, 2}).film;
  EXPECT_EQ(mean(seen, "beauty", whole(seen), 0), 1);
}

TEST(Vcm, RefusesWhatItCannotDo) {
  const Case made(caustic_room());
  const auto refused = [&](const char *what, auto &&change) {
    RenderSettings s = vcm(16, 16, 3, 0.1f);
    change(s);
    EXPECT_NE(refusal(made, s).find(what), std::string::npos) << what;
  };
  refused("--crop", [](RenderSettings &s) { s.x1 = 8; });
  refused("--max-depth", [](RenderSettings &s) { s.max_depth = 65; });
  refused("--radius", [](RenderSettings &s) { s.radius = -1; });
  refused("--radius", [](RenderSettings &s) { s.radius = NAN; });
  refused("--radius", [](RenderSettings &s) { s.radius = 1e7f; });
  refused("--alpha", [](RenderSettings &s) { s.alpha = 0; });
  refused("--alpha", [](RenderSettings &s) { s.alpha = 1.5f; });
  refused("--photons", [](RenderSettings &s) { s.photons = 100; });
  refused("--strategy", [](RenderSettings &s) { s.strategy_t = 2; });
  refused("--light-samples", [](RenderSettings &s) { s.light_samples = 2; });
  refused("--radius", [](RenderSettings &s) { s.integrator = "bdpt"; });
}

// The same where merging in a vertex is about as likely as joining it, where it is likelier by far, and on the first bounce alone, more finely: an error in any of their
// densities moves weight between them.
TEST(Vcm, WeightsAddUpToOneInDisksOfEverySize) {
  struct Disk {
    int size;
    float radius;
    unsigned max_depth;
    std::uint64_t samples;
    double noise;
  };
  for (const Disk &disk : {Disk{32, 0.0175f, 4, 16, 0.0015}, {64, 0.06f, 2, 16, 0.0012}, {32, 0.06f, 1, 96, 0.0004}}) {
    SCOPED_TRACE("radius " + std::to_string(disk.radius) + ", depth " + std::to_string(disk.max_depth));
    const std::vector<Film> films = render_seeds(Case(round_furnace()), vcm(disk.size, disk.size, disk.max_depth, disk.radius), disk.samples, 2 * seeds);
    for (const std::string &layer : bounces(0, disk.max_depth)) {
      EXPECT_EQ(differs(films, layer, whole(films[0]), {1, 1, 1}, 1e-4 + 0.2 * static_cast<double>(disk.radius * disk.radius)), "");
      EXPECT_LT(relative_error(films, layer), disk.noise) << layer;
    }
  }
}

}  // namespace sunstone::test
