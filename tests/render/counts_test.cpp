// SPDX-License-Identifier: Apache-2.0
// What is counted adds up.
#include <gtest/gtest.h>

#include <numeric>

#include "support/render.h"
#include "support/scenes.h"

namespace sunstone::test {
namespace {

void expect_whole(const Rendered &r, const RenderSettings &s, std::uint64_t samples, const std::string &what) {
  const std::uint64_t pixels = static_cast<std::uint64_t>(s.x1 - s.x0) * static_cast<std::uint64_t>(s.y1 - s.y0);
  EXPECT_EQ(r.counts.paths, pixels * samples) << what;
  EXPECT_EQ(std::accumulate(std::begin(r.counts.ended), std::end(r.counts.ended), std::uint64_t{0}), r.counts.paths) << what;
  EXPECT_EQ(std::accumulate(r.counts.ended_by_depth.begin(), r.counts.ended_by_depth.end(), std::uint64_t{0}), r.counts.paths) << what;
  EXPECT_GE(r.counts.camera_rays, r.counts.paths) << what;
  EXPECT_EQ(r.counts.nan, 0u) << what;
  EXPECT_EQ(r.counts.clamped, 0u) << what;
  EXPECT_EQ(r.film.nan, 0u) << what;
  EXPECT_EQ(r.film.sample_count(), samples) << what;
  for (std::size_t depth = s.max_depth + 1; depth < r.counts.ended_by_depth.size(); depth++) EXPECT_EQ(r.counts.ended_by_depth[depth], 0u) << what << ", depth " << depth;
  // A ray for every scattering, but for the last one of a path that roulette ended.
  std::uint64_t scatterings = 0;
  for (std::size_t depth = 0; depth < r.counts.ended_by_depth.size(); depth++) scatterings += depth * r.counts.ended_by_depth[depth];
  EXPECT_LE(scatterings, r.counts.bounce_rays + r.counts.ended[SUN_ENDED_ABSORBED]) << what;
}

}  // namespace

TEST(Counts, AddUpOverScenesPoolsAndCrops) {
  const Case all(everything());
  for (const unsigned pool : {0u, 64u, 1008u}) {
    Ways ways;
    ways.pool = pool;
    RenderSettings s = picture(37, 23, 8);
    expect_whole(render(all, s, {0, 3}, ways), s, 3, "pool " + std::to_string(pool));
    s.x0 = 5;
    s.y0 = 7;
    s.x1 = 18;
    s.y1 = 9;
    expect_whole(render(all, s, {4, 9}, ways), s, 5, "crop, pool " + std::to_string(pool));
  }
}

TEST(Counts, DoNotDependOnTheWays) {
  const Case all(everything());
  const RenderSettings s = picture(32, 32, 8);
  const RenderCounts reference = render(all, s, {0, 4}).counts;
  for (const unsigned pool : {16u, 500u, 65536u}) {
    Ways ways;
    ways.pool = pool;
    const RenderCounts counts = render(all, s, {0, 4}, ways).counts;
    EXPECT_EQ(counts.ended_by_depth, reference.ended_by_depth);
    EXPECT_TRUE(std::equal(std::begin(counts.ended), std::end(counts.ended), std::begin(reference.ended)));
    EXPECT_EQ(counts.camera_rays, reference.camera_rays);
    EXPECT_EQ(counts.bounce_rays, reference.bounce_rays);
    EXPECT_EQ(counts.shadow_rays, reference.shadow_rays);
  }
}

TEST(Counts, ReasonsOfKnownScenes) {
  // A convex body under a sky: a path escapes at depth 0 or 1, or is absorbed.
  Scene sphere_scene;
  add(sphere_scene, sphere({0, 0, 0}, 1), matt({0.5f, 0.5f, 0.5f}));
  set_sky(sphere_scene, {1, 1, 1});
  add_camera(sphere_scene, {0, 0, 4}, {0, 0, 0}, 60);
  RenderCounts counts = render(Case(std::move(sphere_scene)), picture(32, 32, 5), {0, 4}).counts;
  EXPECT_EQ(counts.ended[SUN_ENDED_LIGHT], 0u);
  EXPECT_EQ(counts.ended[SUN_ENDED_DEPTH], 0u);
  EXPECT_EQ(counts.ended[SUN_ENDED_ESCAPED], counts.paths);
  EXPECT_GT(counts.ended_by_depth[0], 0u);
  EXPECT_GT(counts.ended_by_depth[1], 0u);
  EXPECT_EQ(counts.ended_by_depth[0] + counts.ended_by_depth[1], counts.paths);
  EXPECT_EQ(counts.bounce_rays, counts.ended_by_depth[1]);

  // A closed room that emits everywhere: every path ends on light, nothing escapes.
  RenderSettings s = picture(16, 16, 3);
  counts = render(Case::file(scene_file("furnace/furnace.gltf")), s, {0, 4}).counts;
  EXPECT_EQ(counts.ended[SUN_ENDED_LIGHT], counts.paths) << "its last hit emits, though the depth limit ends it";
  EXPECT_EQ(counts.ended_by_depth[3], counts.paths);

  // A closed dark room: the depth limit, or roulette.
  Scene room;
  add(room, box({-1, -1, -1}, {1, 1, 1}, true), matt({0.9f, 0.9f, 0.9f}));
  add_point_light(room, {0.5f, 0.5f, 0}, {1, 1, 1});
  add_camera(room, {0, 0, 0.9f}, {0, 0, 0}, 60);
  counts = render(Case(std::move(room)), picture(16, 16, 12), {0, 4}).counts;
  EXPECT_EQ(counts.ended[SUN_ENDED_ESCAPED], 0u);
  EXPECT_EQ(counts.ended[SUN_ENDED_LIGHT], 0u);
  EXPECT_GT(counts.ended[SUN_ENDED_DEPTH], 0u);
  EXPECT_GT(counts.ended[SUN_ENDED_ABSORBED], 0u);
}

TEST(Counts, HugeRadianceIsClampedAndCounted) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {3, 0, 0}, {0, 3, 0}), lamp({1e9f, 1, 1}));
  add_camera(scene, {0, 0, 3}, {0, 0, 0}, 30);
  const Rendered r = render(Case(std::move(scene)), picture(8, 8, 1), {0, 2});
  EXPECT_EQ(r.counts.clamped, 128u) << "one a contribution, though beauty and bounce.0 both take it";
  EXPECT_EQ(r.counts.nan, 0u);
  EXPECT_EQ(mean(r.film, "beauty", whole(r.film), 0), double(SUN_FILM_LIMIT));
}

// A tree of rays in a closed room of which nothing is lost: each vertex sends what it is told to, down to the depth limit.
TEST(Counts, RaysOfATree) {
  Scene room;
  add(room, box({-1, -1, -1}, {1, 1, 1}, true), matt({0.5f, 0.5f, 0.5f}));
  add_point_light(room, {0.3f, 0.4f, 0}, {1, 1, 1});
  add_camera(room, {0, 0, 0.5f}, {0, 0, -1}, 60);
  const Case made(std::move(room));
  RenderSettings s = picture(16, 16, 3);
  s.integrator = "hybrid";
  s.indirect_samples = 4;
  s.absorption = 0;
  for (const unsigned pool : {0u, 48u}) {
    Ways ways;
    ways.pool = pool;
    const RenderCounts counts = render(made, s, {0, 2}, ways).counts;
    const std::uint64_t paths = 16 * 16 * 2;
    EXPECT_EQ(counts.paths, paths);
    EXPECT_EQ(counts.camera_rays, paths);
    EXPECT_EQ(counts.bounce_rays, paths * (4 + 16 + 64));
    EXPECT_EQ(counts.shadow_rays, paths * (1 + 4 + 16));
    EXPECT_EQ(counts.ended[SUN_ENDED_DEPTH], paths * 64);
    const std::vector<std::uint64_t> rays = rays_by_depth(counts);
    for (std::size_t depth = 0; depth <= 3; depth++) EXPECT_EQ(rays[depth], paths << (2 * depth)) << depth;
    EXPECT_EQ(rays[4], 0u);
  }
}

// What the film holds already is refused before a path begins: it stays as it was, and goes on with what it does not hold.
TEST(Counts, SamplesThatAreThereAreRefusedAndNotAdded) {
  const Case scene(matt_room());
  RenderSettings s = picture(16, 12, 3);
  for (const char *integrator : {"path", "vcm"}) {
    s.integrator = integrator;
    for (const SampleRange &again : {SampleRange{0, 2}, {1, 2}, {1, 5}, {3, 8}}) {
      const Twice twice = render_more(scene, s, {0, 4}, again);
      EXPECT_NE(twice.refused.find("are there already"), std::string::npos) << twice.refused;
      EXPECT_EQ(film_hash(twice.then).hex(), film_hash(twice.first).hex()) << integrator << " " << again.first << ":" << again.last;
      EXPECT_EQ(twice.counted_then.paths, twice.counted_first.paths) << integrator;
    }
    const Twice twice = render_more(scene, s, {0, 4}, {4, 6});
    EXPECT_EQ(twice.refused, "");
    EXPECT_EQ(film_hash(twice.then).hex(), film_hash(render(scene, s, {0, 6}).film).hex()) << integrator;
  }
}

}  // namespace sunstone::test
