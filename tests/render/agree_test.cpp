// SPDX-License-Identifier: Apache-2.0
// Two unbiased ways to the same picture: `path` (shadow rays, weights, roulette) and `pure` (chance alone) agree at every bounce. Welch's test on means of
// blocks and of the whole picture, over independent seeds; all tests of this file together are Holm-corrected to a false alarm in 10^6 runs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "support/agree.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace sunstone::test {
namespace {

constexpr double false_alarms = 1e-6;  // a run of this program
constexpr int tests_here = 15;         // each takes its share
constexpr std::uint32_t seeds = 48;    // of few samples each: more degrees of freedom for the same work

struct Work {
  std::uint64_t path_samples, pure_samples;
  int block = 8;  // side in pixels: light must reach nearly every seed's block by chance, as Welch's test wants means that are nearly normal
};

void expect_agreement(const Case &scene, RenderSettings settings, const Work &work, const char *const integrators[2], std::uint32_t seeds = sunstone::test::seeds) {
  std::vector<Film> films[2];
  for (int i = 0; i < 2; i++) {
    settings.integrator = integrators[i];
    films[i] = render_seeds(scene, settings, i == 0 ? work.path_samples : work.pure_samples, seeds);
  }
  const Agreement agree = agreement(films[0], films[1], bounces(0, settings.max_depth), work.block, false_alarms / tests_here);
  EXPECT_EQ(agree.rejected, 0u) << integrators[0] << " and " << integrators[1] << ", of " << agree.means << " means:" << agree.what;
  // A test that sees nothing cannot fail: there has to be light at every depth, and noise small enough to tell 5 per cent.
  for (unsigned depth = 1; depth <= settings.max_depth; depth++) {
    const std::string layer = "bounce." + std::to_string(depth);
    for (int i = 0; i < 2; i++) {
      EXPECT_GT(mean(films[i][0], layer, whole(films[i][0]), 1), 0) << layer;
      if (depth == 1) {
        EXPECT_LT(relative_error(films[i], layer), 0.006) << layer << " of " << integrators[i] << " is too noisy";
      }
    }
  }
}

constexpr const char *path_and_pure[2] = {"path", "pure"};

}  // namespace

TEST(Agree, CornellBox) {
  expect_agreement(Case::file(scene_file("cornell/cornell.gltf")), picture(64, 64, 5), {12, 64}, path_and_pure);
}

// The whole picture, to depth 8, over 16 seeds: minutes, and 5 GB. SUNSTONE_LONG=1 asks for it. As many blocks as above: those of 8 pixels at the walls' far
// ends are found by light a few times in all, and Welch's test means nothing there.
TEST(Agree, CornellBoxAtFullSize) {
  if (!std::getenv("SUNSTONE_LONG")) GTEST_SKIP() << "SUNSTONE_LONG is not set";
  expect_agreement(Case::file(scene_file("cornell/cornell.gltf")), picture(512, 512, 8), {4, 40, 64}, path_and_pure, 16);
}

// A bright map, glossy and rough surfaces, alpha of both kinds, thin glass, solid glass, textured emitters, instances: all but punctual lights, which no
// path meets by chance.
TEST(Agree, Everything) {
  Scene scene = everything();
  scene.lights.clear();
  set_sky_map(scene, sky_map(16, 8, {4, 3.5f, 3}));
  expect_agreement(Case(std::move(scene)), picture(48, 32, 5), {32, 64}, path_and_pure);
}

// A sky alone, over a glossy and a matt surface: the environment's pdf and the bsdf's carry all of it.
TEST(Agree, SkyOverGlossAndMatt) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}), matt({0.7f, 0.5f, 0.3f}));
  add(scene, sphere({-0.7f, 0.6f, 0}, 0.6f), metal({0.9f, 0.7f, 0.5f}, 0.45f));
  Material gloss = metal({0.2f, 0.3f, 0.8f}, 0.3f);
  gloss.metallic = 0;
  add(scene, sphere({0.7f, 0.6f, 0}, 0.6f), gloss);
  set_sky_map(scene, sky_map(32, 16, {8, 7, 5}));
  scene.environment.rotation = 0.3f;
  add_camera(scene, {0, 1.4f, 4}, {0, 0.5f, 0}, 40);
  expect_agreement(Case(std::move(scene)), picture(48, 32, 4), {32, 64}, path_and_pure);
}

// Two emitters of very different power and size, so that the chance of being chosen matters; one is an instance, and one lies behind thin glass.
TEST(Agree, LampsOfDifferentPower) {
  Scene scene;
  add(scene, box({-2, 0, -2}, {2, 3, 2}, true), matt({0.6f, 0.6f, 0.6f}));
  const int small = add(scene, quad({0, 0, 0}, {0.15f, 0, 0}, {0, 0, 0.15f}), lamp({20, 4, 2}), scaled({1, 1, 1}, {-1.2f, 1.5f, 0}));
  place(scene, small, scaled({2, 1, 2}, {1.2f, 2.5f, 0.5f}));
  add(scene, quad({0, 2.9f, 0}, {1.2f, 0, 0}, {0, 0, 1.2f}), lamp({0.5f, 0.8f, 1.5f}));
  add(scene, quad({-1.2f, 1.2f, 0}, {0.5f, 0, 0}, {0, 0, -0.5f}), thin_glass({0.5f, 0.9f, 0.6f}));
  add_camera(scene, {0, 1.5f, 1.9f}, {0, 1.0f, 0}, 70);
  expect_agreement(Case(std::move(scene)), picture(48, 32, 4), {16, 80}, path_and_pure);
}

// A lamp as wide as the room: shadow rays and chance have about equal shares, so that a wrong weight on either side shows.
TEST(Agree, LampAsWideAsTheRoom) {
  Scene scene;
  add(scene, box({-2, 0, -2}, {2, 1.5f, 2}, true), matt({0.7f, 0.6f, 0.5f}));
  add(scene, quad({0, 1.4f, 0}, {1.9f, 0, 0}, {0, 0, 1.9f}), lamp({1, 1.5f, 2}));
  add(scene, quad({0, 0.01f, 0.5f}, {0.8f, 0, 0}, {0, 0, -0.8f}), metal({0.9f, 0.8f, 0.7f}, 0.5f));
  add_camera(scene, {0, 1.0f, 1.9f}, {0, 0, 0}, 60);
  expect_agreement(Case(std::move(scene)), picture(48, 32, 3), {16, 24}, path_and_pure);
}

// A small sun in a map over a matt plane: nearly all of its light comes by shadow rays, so the pdf by which a map is sampled carries it.
TEST(Agree, SunOverMatt) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {40, 0, 0}, {0, 0, -40}), matt({0.8f, 0.6f, 0.4f}));
  set_sky_map(scene, sky_map(32, 16, {150, 120, 100}));
  add_camera(scene, {0, 3, 0}, {0, 0, 0}, 40);
  expect_agreement(Case(std::move(scene)), picture(24, 16, 1), {64, 384}, path_and_pure);
}

// A lamp over a rough metal that fills the picture: the density of the glossy lobe stands in the weight of every shadow ray.
TEST(Agree, LampOverGloss) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {40, 0, 0}, {0, 0, -40}), metal({0.9f, 0.7f, 0.5f}, 0.6f));
  add(scene, quad({0, 1.2f, -0.6f}, {0.7f, 0, 0}, {0, 0, 0.5f}), lamp({4, 5, 6}));
  add_camera(scene, {0, 1.1f, 1.6f}, {0, 0, -0.2f}, 30);
  expect_agreement(Case(std::move(scene)), picture(24, 16, 1), {64, 256}, path_and_pure);
}

// Lamps that are analytic shapes, of unequal power, one an ellipsoid and one seen from both sides, over a plane: shadow rays and chance have about equal
// shares.
TEST(Agree, ShapesThatShine) {
  Scene scene;
  add_shape(scene, Shape::Kind::plane, matt({0.7f, 0.6f, 0.5f}), scaled({1, 1, 1}, {0, 0, 0}));
  add_shape(scene, Shape::Kind::sphere, metal({0.9f, 0.8f, 0.7f}, 0.5f), scaled({0.4f, 0.4f, 0.4f}, {0, 0.4f, 0.3f}));
  add_shape(scene, Shape::Kind::sphere, lamp({2, 1.5f, 1}), scaled({0.5f, 0.8f, 0.3f}, {-1, 1, 0}));
  add_shape(scene, Shape::Kind::disk, lamp({1, 2, 3}), {{0.5f, 0.5f, 0}, {0.5f, -0.5f, 0}, {0, 0, -0.7f}, {1.2f, 1.2f, 0}});
  Material both = lamp({1.5f, 1.5f, 3});
  both.double_sided = true;
  add_shape(scene, Shape::Kind::quad, both, {{0.5f, 0, 0}, {0, 0.1f, 0.5f}, {0, 0.5f, -0.1f}, {0, 0.8f, -0.9f}});
  add_camera(scene, {0, 1.6f, 3.2f}, {0, 0.4f, 0}, 45);
  expect_agreement(Case(std::move(scene)), picture(48, 32, 3), {32, 64}, path_and_pure);
}

// Ways of the same integrator, beside `path`.
struct Way {
  const char *name;
  std::function<void(RenderSettings &)> set;
  std::uint64_t samples;
};

// Films of `path` and of each way over the same seeds.
void expect_ways_agree(const Case &scene, const RenderSettings &settings, std::uint64_t path_samples, const std::vector<Way> &ways, bool expected = true) {
  const std::vector<Film> reference = render_seeds(scene, settings, path_samples, seeds);
  for (const Way &way : ways) {
    RenderSettings with = settings;
    way.set(with);
    const std::vector<Film> films = render_seeds(scene, with, way.samples, seeds);
    const Agreement agree = agreement(reference, films, bounces(0, settings.max_depth), 8, false_alarms / tests_here / static_cast<double>(ways.size()));
    EXPECT_EQ(agree.rejected == 0, expected) << way.name << ": " << agree.rejected << " of " << agree.means << " means differ" << agree.what;
    EXPECT_LT(relative_error(films, "bounce.1"), 0.02) << way.name << " is too noisy to tell";
  }
}

Way hybrid(const char *name, std::uint64_t samples, const std::function<void(RenderSettings &)> &set) {
  return {name, [set](RenderSettings &s) { s.integrator = "hybrid", set(s); }, samples};
}

Way pure(const char *name, std::uint64_t samples, const std::function<void(RenderSettings &)> &set) {
  return {name, [set](RenderSettings &s) { s.integrator = "pure", set(s); }, samples};
}

// The lecture's speed-up in both forms; glossy and clear surfaces, alpha, a map, instances.
TEST(Agree, HybridInEveryForm) {
  Scene scene = everything();
  expect_ways_agree(Case(scene), picture(48, 32, 4), 32,
                    {hybrid("every", 32, [](RenderSettings &) {}), hybrid("five shadow rays", 16, [](RenderSettings &s) { s.light_samples = 5; }),
                     hybrid("absorption", 48, [](RenderSettings &s) { s.absorption = 0.3f; })});
}

// A tree of rays a sample, where it is full, and where chance prunes it.
TEST(Agree, HybridThatBranches) {
  Scene scene = everything();
  expect_ways_agree(Case(scene), picture(48, 32, 4), 32,
                    {hybrid("three rays a vertex", 8, [](RenderSettings &s) { s.indirect_samples = 3, s.absorption = 0; }),
                     hybrid("five, half of them absorbed", 12, [](RenderSettings &s) { s.indirect_samples = 5, s.absorption = 0.5f, s.light_samples = 2; })});
  scene.lights.clear();
  set_sky_map(scene, sky_map(16, 8, {4, 3.5f, 3}));
  expect_ways_agree(Case(std::move(scene)), picture(48, 32, 4), 32,
                    {hybrid("two rays a vertex, shadow rays from the first", 32, [](RenderSettings &s) { s.indirect_samples = 2, s.nee_first = true; })});
}

// Panes that are half matt and half clear: rays branch at each and go straight on through many at one depth, more often than the depth limit has room on the stack.
TEST(Agree, HybridThatBranchesThroughPanes) {
  Scene scene;
  add(scene, quad({0, 0, -2}, {3, 0, 0}, {0, 3, 0}), matt({0.7f, 0.6f, 0.5f}));
  Material pane = thin_glass({0.9f, 0.95f, 0.9f});
  pane.transmission = 0.6f;
  for (int i = 0; i < 5; i++) add(scene, quad({0, 0, 0.3f * static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0}), pane);
  add_point_light(scene, {1.5f, 1, 1}, {6, 6, 6});
  add_camera(scene, {0, 0, 3}, {0, 0, 0}, 40);
  expect_ways_agree(Case(std::move(scene)), picture(24, 16, 2), 64, {hybrid("three rays a vertex", 24, [](RenderSettings &s) { s.indirect_samples = 3, s.absorption = 0; })});
}

Way distribution(const char *name, std::uint64_t samples, unsigned rays) {
  return {name, [rays](RenderSettings &s) { s.integrator = "distribution", s.indirect_samples = rays; }, samples};
}

// Where nothing is matt, following what facets reflect and transmit is all there is; and what is direct is that of any integrator.
TEST(Agree, DistributionOfWhatItFollows) {
  Scene scene;
  add(scene, box({-2, 0, -2}, {2, 2.4f, 2}, true), metal({0.8f, 0.7f, 0.6f}, 0));
  add(scene, sphere({-0.6f, 0.7f, 0}, 0.6f), glass({0.4f, 0.1f, 0.1f}));
  add(scene, quad({0.7f, 0.8f, 0.2f}, {0.6f, 0, 0.2f}, {0, 0.6f, 0}), thin_glass({0.6f, 0.9f, 0.7f}));
  add(scene, quad({0, 2.3f, 0}, {0.8f, 0, 0}, {0, 0, 0.8f}), lamp({3, 4, 5}));
  add_camera(scene, {0, 1.2f, 1.9f}, {0, 0.8f, 0}, 70);
  expect_ways_agree(Case(std::move(scene)), picture(48, 32, 5), 48, {distribution("one ray an effect", 24, 1), distribution("three rays an effect", 24, 3)});
  expect_ways_agree(Case(everything()), picture(48, 32, 1), 48, {distribution("what is direct", 48, 1)});
}

// Gloss: a rough plate shows a lit wall. Only what facets lose among themselves is missing, a few hundredths at this roughness.
TEST(Agree, DistributionOfGloss) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}), metal({0.9f, 0.8f, 0.7f}, 0.35f));
  add(scene, quad({0, 1.5f, -2}, {3, 0, 0}, {0, 1.5f, 0}), matt({0.7f, 0.7f, 0.7f}));
  add_point_light(scene, {0, 2, 2}, {20, 20, 20});
  add_camera(scene, {0, 1.0f, 2.5f}, {0, 0, 0}, 30);
  const Case made(std::move(scene));
  const RenderSettings s = picture(24, 16, 2);
  for (const unsigned rays : {1u, 4u}) {
    RenderSettings with = s;
    with.integrator = "distribution";
    with.indirect_samples = rays;
    const std::vector<Film> films = render_seeds(made, with, 256, 8), reference = render_seeds(made, s, 256, 8);
    const Window floor{0, 8, 24, 16};
    const double here = moments(means(films, "bounce.2", floor, 1)).mean, there = moments(means(reference, "bounce.2", floor, 1)).mean;
    EXPECT_GT(there, 0);
    EXPECT_LT(here, 1.002 * there) << rays;
    EXPECT_GT(here, 0.95 * there) << rays;
  }
}

TEST(Agree, HybridFromTheFirstHitAlone) {
  Scene scene = everything();
  scene.lights.clear();
  set_sky_map(scene, sky_map(16, 8, {4, 3.5f, 3}));
  expect_ways_agree(Case(std::move(scene)), picture(48, 32, 4), 32,
                    {hybrid("first", 48, [](RenderSettings &s) { s.nee_first = true; }), hybrid("first, three shadow rays", 48, [](RenderSettings &s) {
                       s.nee_first = true;
                       s.light_samples = 3;
                     })});
}

// The classic mistake is seen to be one.
TEST(Agree, CountingTwiceDoesNot) {
  expect_ways_agree(Case::file(scene_file("cornell/cornell.gltf")), picture(32, 32, 3), 12,
                    {hybrid("double count", 48, [](RenderSettings &s) { s.double_count = true; })}, false);
}

// Whatever the density that directions are drawn with, what is expected stays: over matt, glossy, mirroring and clear surfaces, and a base coat on matt.
// None is so glossy that even directions hardly ever find the highlight, as that is what they are bad at.
TEST(Agree, PureByAnyDensity) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}), matt({0.7f, 0.5f, 0.3f}));
  Material coat = metal({0.2f, 0.3f, 0.8f}, 0.6f);
  coat.metallic = 0;
  add(scene, sphere({-1.2f, 0.5f, 0}, 0.5f, 12), coat);
  Material varnish = coat;
  varnish.roughness = 0;
  add(scene, sphere({0, 0.5f, 0}, 0.5f, 12), varnish);
  add(scene, sphere({1.2f, 0.5f, 0}, 0.5f, 12), metal({0.9f, 0.7f, 0.5f}, 0.7f));
  add(scene, quad({-0.8f, 0.5f, 1}, {0.4f, 0, 0}, {0, 0.5f, 0}), thin_glass({0.6f, 0.9f, 0.7f}, 0.7f));
  add(scene, quad({0.1f, 0.5f, 1}, {0.4f, 0, 0}, {0, 0.5f, 0}), thin_glass({0.6f, 0.7f, 0.9f}));
  add(scene, sphere({0.9f, 0.4f, 1.2f}, 0.4f, 12), glass({0.2f, 0.5f, 0.9f}, 0.8f));
  set_sky_map(scene, sky_map(16, 8, {3, 2.5f, 2}));
  add_camera(scene, {0, 1.2f, 4.5f}, {0, 0.5f, 0}, 38);
  expect_ways_agree(Case(std::move(scene)), picture(48, 32, 2), 64,
                    {pure("cosine", 96, [](RenderSettings &s) { s.sampling = Sampling::cosine; }),
                     pure("uniform", 96, [](RenderSettings &s) { s.sampling = Sampling::uniform; })});
}

// Where every surface shines, a path that ends on light ends at once: all it brings is the first surface's own, and it is counted as ended on light.
TEST(Agree, EndingOnLight) {
  Scene scene;
  Material glowing = matt({0.5f, 0.5f, 0.5f});
  glowing.emission = {1, 1, 1};
  add(scene, box({-1, -1, -1}, {1, 1, 1}, true), glowing);
  add_camera(scene, {0, 0, 0}, {0, 0, -1}, 60);
  const Case made(std::move(scene));
  RenderSettings s = picture(16, 16, 6);
  s.filter = box_filter();
  s.integrator = "pure";
  const Rendered on = render(made, s, {0, 8});
  s.end_on_light = true;
  const Rendered ended = render(made, s, {0, 8});
  const Film &film = ended.film;
  EXPECT_DOUBLE_EQ(mean(film, "beauty", whole(film), 0), 1.0);
  EXPECT_NEAR(mean(on.film, "beauty", whole(film), 0), 2.0, 0.05) << "1 + a + a^2 ... to depth 6";
  EXPECT_EQ(ended.counts.ended[SUN_ENDED_LIGHT], ended.counts.paths);
}

// The sampler makes no difference to what is expected; neither does the seed.
TEST(Agree, SobolAndIndependent) {
  const Case scene = Case::file(scene_file("cornell/cornell.gltf"));
  RenderSettings settings = picture(32, 32, 3);
  const std::vector<Film> independent = render_seeds(scene, settings, 32, seeds);
  std::vector<Film> sobol;
  for (std::uint32_t seed = 1; seed <= seeds; seed++) {
    settings.seed = seed;
    sobol.push_back(render(scene, settings, {0, 32}).film);
  }
  for (int channel = 0; channel < 3; channel++) {
    const std::vector<double> a = means(independent, "beauty", whole(sobol[0]), channel), b = means(sobol, "beauty", whole(sobol[0]), channel);
    EXPECT_GT(welch(a, b), false_alarms / tests_here / 3) << moments(a).mean << " and " << moments(b).mean;
    EXPECT_LT(moments(b).variance, moments(a).variance) << "Sobol' points ought to be less noisy";
  }
}

}  // namespace sunstone::test
