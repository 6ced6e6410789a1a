// SPDX-License-Identifier: Apache-2.0
// The integrator `whitted` against closed forms: directions and Fresnel's shares of mirrors and glass, total reflection, point lights and their shadows,
// both children of a surface, and one hash whatever the ways.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "support/render.h"
#include "support/scenes.h"

namespace sunstone::test {
namespace {

using Kind = Shape::Kind;

RenderSettings whitted(unsigned max_depth) {
  RenderSettings s = picture(4, 4, max_depth);
  s.integrator = "whitted";
  s.filter = box_filter();
  s.cutoff = 0;
  return s;
}

// The picture's mean; cameras here look through a hundredth of a degree.
double seen(Scene scene, const RenderSettings &settings, int channel = 0) {
  const Film film = render(Case(std::move(scene)), settings, {0, 4}).film;
  EXPECT_EQ(film.nan, 0u);
  return mean(film, "beauty", whole(film), channel);
}

constexpr float narrow = 0.01f;
constexpr double degree = 3.14159265358979 / 180;

// Unpolarised, from the laws of Fresnel and Snell as textbooks have them.
double fresnel(double angle, double n) {
  const double sine = std::sin(angle) / n;
  if (sine >= 1) return 1;
  const double far = std::asin(sine);
  if (angle == 0) return (n - 1) * (n - 1) / ((n + 1) * (n + 1));
  const double s = std::sin(angle - far) / std::sin(angle + far), p = std::tan(angle - far) / std::tan(angle + far);
  return 0.5 * (s * s + p * p);
}

}  // namespace

TEST(Whitted, AMirrorShowsWhatStandsWhereTheLawSays) {
  for (const double degrees : {0.5, 30.0, 60.0, 80.0}) {
    Scene scene;
    const float angle = static_cast<float>(degrees * degree), s = std::sin(angle), c = std::cos(angle);
    add_shape(scene, Kind::plane, metal({0.5f, 0.5f, 0.5f}, 0), scaled({1, 1, 1}, {0, 0, 0}));
    // A disk across the mirrored direction, its front towards the mirror.
    add_shape(scene, Kind::disk, lamp({2, 2, 2}), {{0.01f * c, -0.01f * s, 0}, {-0.01f * s, -0.01f * c, 0}, {0, 0, 0.01f}, {3 * s, 3 * c, 0}});
    add_camera(scene, {-2 * s, 2 * c, 0}, {0, 0, 0}, narrow);
    const double schlick = 0.5 + 0.5 * std::pow(1 - std::cos(degrees * degree), 5);
    EXPECT_NEAR(seen(scene, whitted(2)), 2 * schlick, 2e-4) << degrees;
    EXPECT_EQ(seen(scene, whitted(0)), 0.0) << "a mirrored ray is a scattering";
  }
}

// Into a half space of glass: the refracted ray meets a lamp where Snell says, with Fresnel's share, over n^2 as it ends within.
TEST(Whitted, GlassBendsAndSplitsLight) {
  for (const double degrees : {0.5, 30.0, 60.0, 85.0}) {
    Scene scene;
    const double angle = degrees * degree, far = std::asin(std::sin(angle) / 1.5);
    add_shape(scene, Kind::plane, glass({0, 0, 0}), scaled({1, 1, 1}, {0, 0, 0}));
    add_shape(scene, Kind::disk, lamp({2, 2, 2}), scaled({0.01f, 0.01f, 0.01f}, {static_cast<float>(std::tan(far)), -1, 0}));
    add_shape(scene, Kind::disk, lamp({0, 3, 0}), {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 5, 0}});  // over all that mirrored rays find, but for the last
    add_camera(scene, {static_cast<float>(-std::sin(angle)), static_cast<float>(std::cos(angle)), 0}, {0, 0, 0}, narrow);
    const double f = fresnel(angle, 1.5);
    EXPECT_NEAR(seen(scene, whitted(2)), 2 * (1 - f) / 2.25, 1e-3) << degrees;
  }
}

// Within glass, under a sky of radiance 1 all around: what is mirrored keeps it, what comes in from outside brings n^2 of it; beyond the critical angle all
// is mirrored.
TEST(Whitted, TotalReflection) {
  for (const double degrees : {10.0, 35.0, 41.0, 42.5, 60.0, 80.0}) {
    Scene scene;
    const float angle = static_cast<float>(degrees * degree);
    add_shape(scene, Kind::plane, glass({0, 0, 0}), scaled({1, 1, 1}, {0, 0, 0}));
    set_sky(scene, {1, 1, 1});
    add_camera(scene, {-std::sin(angle), -std::cos(angle), 0}, {0, 0, 0}, narrow);
    const double f = fresnel(degrees * degree, 1 / 1.5);
    EXPECT_NEAR(seen(scene, whitted(2)), f + (1 - f) * 2.25, 2e-3) << degrees;
    if (degrees > 41.9) {
      EXPECT_EQ(f, 1.0);
    }
  }
}

// A ball of glass and a pane of it in a furnace: with both children of each hit followed to the end nothing is lost.
TEST(Whitted, BothChildrenAreFollowed) {
  Scene scene;
  add_shape(scene, Kind::sphere, glass({0, 0, 0}), scaled({1, 1, 1}, {0, 0, 0}));
  for (int pane = 0; pane < 2; pane++)
    add_shape(scene, Kind::quad, thin_glass({1, 1, 1}), {{3, 0.2f, 0}, {-0.2f, 0, 1}, {0, 3, 0}, {0, 0, 2 + 0.1f * static_cast<float>(pane)}});
  set_sky(scene, {1, 0.5f, 0.25f});
  add_camera(scene, {0, 0, 5}, {0, 0, 0}, 40);
  RenderSettings s = whitted(7);
  s.width = s.height = s.x1 = s.y1 = 8;
  const Film film = render(Case(scene), s, {0, 4}).film;
  for (int channel = 0; channel < 3; channel++) {
    const double full = channel == 0 ? 1 : channel == 1 ? 0.5 : 0.25;
    EXPECT_NEAR(mean(film, "beauty", whole(film), channel), full, 3e-3 * full);
  }
  EXPECT_GT(mean(film, "bounce.5", whole(film), 0), 0.0) << "no deep ray was followed";
  // Cut off, trees lose light, and only a little.
  s.cutoff = 0.05f;
  const Film cut = render(Case(scene), s, {0, 4}).film;
  EXPECT_LT(mean(cut, "beauty", whole(cut), 0), mean(film, "beauty", whole(film), 0));
  EXPECT_GT(mean(cut, "beauty", whole(cut), 0), 0.8);
}

TEST(Whitted, PointLightsAmbientLightAndShadows) {
  Scene scene;
  add_shape(scene, Kind::plane, matt({0.5f, 0.25f, 0.75f}), scaled({1, 1, 1}, {0, 0, 0}));
  add_point_light(scene, {1, 2, 0}, {10, 20, 30});
  Light sun;
  sun.kind = Light::Kind::directional;
  sun.direction = {0, -1, 0};
  sun.intensity = {2, 2, 2};
  scene.lights.push_back(sun);
  add_camera(scene, {0, 0.5f, 0.5f}, {0, 0, 0}, narrow);
  RenderSettings s = whitted(1);
  s.ambient = {0.1f, 0.2f, 0.3f};
  const float albedo[3] = {0.5f, 0.25f, 0.75f}, intensity[3] = {10, 20, 30};
  for (int c = 0; c < 3; c++) {
    const double cosine = 2 / std::sqrt(5.0), of_lights = intensity[c] * cosine / 5 + 2;
    EXPECT_NEAR(seen(scene, s, c), albedo[c] * (of_lights / 3.14159265358979 + s.ambient[static_cast<std::size_t>(c)]), 1e-4 * of_lights);
  }
  // A ball before the point light, a disk of glass before the sun that lets through what it does.
  add_shape(scene, Kind::sphere, matt({1, 1, 1}), scaled({0.2f, 0.2f, 0.2f}, {0.5f, 1, 0}));
  EXPECT_NEAR(seen(scene, s), 0.5 * (2 / 3.14159265358979 + 0.1), 1e-4);
  add_shape(scene, Kind::disk, thin_glass({1, 1, 1}), scaled({0.1f, 0.1f, 0.1f}, {0, 2, 0}));
  EXPECT_NEAR(seen(scene, s), 0.5 * (2 * 0.96 / 3.14159265358979 + 0.1), 1e-3);
}

// scenes/whitted, where its README says what it gives.
TEST(Whitted, TheSceneGivesItsNumbers) {
  Scene scene = Case::file(scene_file("whitted/whitted.gltf")).scene();
  ASSERT_EQ(scene.shapes.size(), 3u);
  scene.cameras.clear();
  add_camera(scene, {-3.5f, 1, 4}, {-3.5f, 0, 3.5f}, narrow);
  RenderSettings s = whitted(4);
  const double lit[3] = {1.2852, 1.0074, 0.0098};
  for (int c = 0; c < 3; c++) EXPECT_NEAR(seen(scene, s, c), lit[c], 1e-3 * lit[c] + 5e-5);
  scene.cameras.clear();
  add_camera(scene, {0.09f, 0.1f, 0.32f}, {0.09f, 0, 0.22f}, narrow);
  EXPECT_EQ(seen(scene, s), 0.0);
  s.ambient = {0.5f, 0.5f, 0.5f};
  EXPECT_NEAR(seen(scene, s), 0.5 * 0.8308, 1e-4);
}

// What only paths find is not there: a lamp lights nothing, and no wall lights another.
TEST(Whitted, NoLightBetweenMattSurfaces) {
  Scene scene;
  add_shape(scene, Kind::plane, matt({0.9f, 0.9f, 0.9f}), scaled({1, 1, 1}, {0, 0, 0}));
  add_shape(scene, Kind::sphere, lamp({5, 5, 5}), scaled({0.3f, 0.3f, 0.3f}, {0, 1, 0}));
  add_camera(scene, {1, 1, 0}, {0.5f, 0, 0}, narrow);
  EXPECT_EQ(seen(scene, whitted(4)), 0.0);
}

TEST(Whitted, OneHashWhateverTheWays) {
  Scene all = everything();
  add_shape(all, Kind::sphere, glass({0.3f, 0.1f, 0.2f}), scaled({0.4f, 0.4f, 0.4f}, {0, 0.6f, 1}));
  const Case made(std::move(all));
  RenderSettings s = picture(40, 32, 6);
  s.integrator = "whitted";
  s.ambient = {0.2f, 0.3f, 0.4f};
  s.layers.albedo = s.layers.normal = s.layers.depth = s.layers.position = s.layers.object = s.layers.material = s.layers.alpha = true;
  const Rendered whole_picture = render(made, s, {0, 4});
  const Film &reference = whole_picture.film;
  EXPECT_EQ(reference.nan, 0u);
  for (const char *layer : {"beauty", "bounce.0", "bounce.1", "bounce.2", "albedo", "Z", "object_id"}) EXPECT_NE(mean(reference, layer, whole(reference), 1), 0.0) << layer;
  std::vector<std::pair<std::string, Ways>> ways(7);
  ways[0] = {"binary", {}}, ways[0].second.layout = Layout::binary;
  ways[1] = {"wide8, lanes 8", {}}, ways[1].second.layout = Layout::wide8, ways[1].second.lanes = 8;
  ways[2] = {"lanes 1", {}}, ways[2].second.lanes = 1;
  ways[3] = {"pool 16", {}}, ways[3].second.pool = 16;
  ways[4] = {"pool 1000", {}}, ways[4].second.pool = 1000;
  ways[5] = {"work-groups of 1", {}}, ways[5].second.work_group = 1;
  ways[6] = {"trimmed", {}}, ways[6].second.trimmed = true;
  for (const auto &[how, way] : ways) EXPECT_EQ(film_hash(render(made, s, {0, 4}, way).film).hex(), film_hash(reference).hex()) << how;
  // The layers of what is seen first are those of the wavefront.
  RenderSettings path = s;
  path.integrator = "path";
  path.ambient = {};
  const Film other = render(made, path, {0, 4}).film;
  for (const char *layer : {"albedo", "normal", "Z", "position", "object_id", "material_id", "alpha"})
    for (int channel = 0; channel < 3; channel++) EXPECT_EQ(mean(reference, layer, whole(reference), channel), mean(other, layer, whole(other), channel)) << layer;
  const RenderCounts &counts = whole_picture.counts;
  EXPECT_EQ(counts.paths, 40u * 32u * 4u);
  EXPECT_EQ(counts.ended[SUN_ENDED_LIGHT] + counts.ended[SUN_ENDED_DEPTH] + counts.ended[SUN_ENDED_ESCAPED] + counts.ended[SUN_ENDED_ABSORBED], counts.paths);
  EXPECT_GT(counts.bounce_rays, counts.paths / 20);
  EXPECT_GT(counts.shadow_rays, counts.paths / 2);
}

// Few shapes are asked one by one, each for all lanes, which are then shaded shape by shape; many stand in the tree. With and without triangles and panes:
// one hash.
TEST(Whitted, OneHashHoweverShapesAreFound) {
  for (const int count : {9, 40}) {
    Scene scene;
    add_shape(scene, Kind::plane, matt({0.5f, 0.6f, 0.7f}), scaled({1, 1, 1}, {0, -0.3f, 0}));
    for (int i = 0; i < count; i++) {
      const float x = static_cast<float>(i % 8) - 3.5f, z = -static_cast<float>(i / 8), size = 0.3f + 0.05f * static_cast<float>(i % 3);
      const Material material = i % 4 == 0 ? glass({0.2f, 0.1f, 0}) : i % 4 == 1 ? metal({0.8f, 0.7f, 0.6f}, 0) : i % 4 == 2 ? metal({0.6f, 0.7f, 0.8f}, 0.3f) : matt({0.7f, 0.3f, 0.2f});
      if (i % 3) add_shape(scene, Kind::sphere, material, scaled({size, size, size}, {x, 0, z}));
      else add_shape(scene, i % 2 ? Kind::disk : Kind::quad, material, {{size, 0.1f, 0}, {-0.1f, 0.2f, size}, {0, -size, 0.2f}, {x, 0.1f, z}});
    }
    add_point_light(scene, {1, 4, 2}, {30, 30, 30});
    set_sky(scene, {0.3f, 0.4f, 0.5f});
    add_camera(scene, {0, 1.5f, 4}, {0, 0, -1}, 50);
    const Case made(std::move(scene));
    RenderSettings s = whitted(5);
    s.width = s.x1 = 40;
    s.height = s.y1 = 28;
    s.ambient = {0.1f, 0.1f, 0.1f};
    const Film reference = render(made, s, {0, 2}).film;
    std::vector<std::pair<std::string, Ways>> ways(4);
    ways[0] = {"as the command does", {}}, ways[0].second.trimmed = true;
    ways[1] = {"asked", {}}, ways[1].second.trimmed = true, ways[1].second.few_shapes = true;
    ways[2] = {"asked, lanes 1", {}}, ways[2].second.trimmed = true, ways[2].second.few_shapes = true, ways[2].second.lanes = 1;
    ways[3] = {"asked, the tree for triangles", {}}, ways[3].second.few_shapes = true;
    for (const auto &[how, way] : ways) EXPECT_EQ(film_hash(render(made, s, {0, 2}, way).film).hex(), film_hash(reference).hex()) << how << ", " << count;
    EXPECT_GT(mean(reference, "beauty", whole(reference), 0), 0.05);
  }
}

TEST(Whitted, RefusesTreesThatAreTooDeep) {
  Scene scene;
  add_camera(scene, {0, 0, 1}, {0, 0, 0}, 40);
  EXPECT_THROW(render(Case(scene), whitted(SUN_WHITTED_DEPTH + 1), {0, 1}), UsageError);
}

}  // namespace sunstone::test
