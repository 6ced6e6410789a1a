// SPDX-License-Identifier: Apache-2.0
// Pictures that are known beforehand. What is random is held against an interval that a right renderer leaves once in 10^9 (support/render.h: differs).
#include <gtest/gtest.h>

#include <cmath>

#include "scene/default_view.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace sunstone::test {
namespace {

constexpr float pi = 3.14159265f;

RenderSettings sharp(int width, int height, unsigned max_depth) {
  RenderSettings s = picture(width, height, max_depth);
  s.filter = box_filter();
  return s;
}

Case with_sky(const std::string &file, glm::vec3 radiance) {
  Scene scene = Case::file(scene_file(file)).scene();
  set_sky(scene, radiance);
  return Case(std::move(scene));
}

// An orthographic camera with the given direction of view: every ray is the same but for its place.
void look_flat(Scene &scene, glm::vec3 from, glm::vec3 at, float half_height) {
  Camera camera = look_camera(from, at, std::abs(glm::normalize(at - from).y) > 0.9f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0), 1.0f);
  camera.orthographic = true;
  camera.half_height = camera.half_width = half_height;
  scene.cameras = {camera};
}

// A plane z = 0 of albedo `albedo`, seen from straight above about (x, y).
Scene plane_seen_at(float x, float y, glm::vec3 albedo) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {20, 0, 0}, {0, 20, 0}), matt(albedo));
  look_flat(scene, {x, y, 30}, {x, y, 0}, 0.005f);
  return scene;
}

std::string seen(Scene scene, glm::vec3 expected, unsigned max_depth = 4, double rounding = 1e-5, std::uint64_t samples = 64, const char *integrator = "path") {
  RenderSettings s = sharp(4, 4, max_depth);
  s.integrator = integrator;
  const std::vector<Film> films = render_seeds(Case(std::move(scene)), s, samples, 16);
  return differs(films, "beauty", whole(films[0]), expected, rounding);
}

}  // namespace

TEST(Oracle, FurnaceByBounce) {
  const Case furnace = Case::file(scene_file("furnace/furnace.gltf"));
  for (const char *integrator : {"path", "pure"}) {
    RenderSettings s = sharp(16, 16, 6);
    s.integrator = integrator;
    const std::vector<Film> films = render_seeds(furnace, s, 16, 16);
    for (unsigned depth = 0; depth <= s.max_depth; depth++) {
      const float k = static_cast<float>(depth);
      EXPECT_EQ(differs(films, "bounce." + std::to_string(depth), whole(films[0]), {std::pow(0.5f, k), std::pow(0.25f, k), std::pow(0.75f, k)}), "") << integrator;
    }
    EXPECT_EQ(differs(films, "beauty", whole(films[0]), {1.984375f, 1.333252f, 3.466064f}, 1e-6), "") << integrator;
  }
}

// By chance alone a path in the furnace has no variance before roulette begins: every pixel of every sample is exact.
TEST(Oracle, PureFurnaceIsExactInEveryPixel) {
  RenderSettings s = sharp(16, 16, 4);
  s.integrator = "pure";
  s.roulette_depth = 5;
  const Film film = render(Case::file(scene_file("furnace/furnace.gltf")), s, {0, 2}).film;
  for (int y = 0; y < 16; y++)
    for (int x = 0; x < 16; x++)
      for (int depth = 0; depth <= 4; depth++)
        ASSERT_NEAR(mean(film, "bounce." + std::to_string(depth), {x, y, x + 1, y + 1}, 2), std::pow(0.75, depth), 2e-6) << x << ", " << y << " at depth " << depth;
}

TEST(Oracle, LambertSphereShowsItsAlbedo) {
  const Case sphere = with_sky("furnace/lambert-sphere.gltf", {1, 1, 1});
  for (const char *integrator : {"path", "pure"}) {
    RenderSettings s = sharp(40, 40, 3);
    s.integrator = integrator;
    const std::vector<Film> films = render_seeds(sphere, s, 16, 16);
    EXPECT_EQ(differs(films, "bounce.1", {9, 9, 31, 31}, {0.8f, 0.5f, 0.2f}), "") << integrator;
    EXPECT_EQ(differs(films, "bounce.0", {0, 0, 40, 2}, {1, 1, 1}), "") << integrator;
    EXPECT_EQ(differs(films, "bounce.0", {9, 9, 31, 31}, {0, 0, 0}), "") << integrator;
    EXPECT_EQ(differs(films, "bounce.2", whole(films[0]), {0, 0, 0}), "") << integrator << ": a convex body does not light itself";
  }
}

TEST(Oracle, CornellDirectLight) {
  const Case cornell = Case::file(scene_file("cornell/cornell.gltf"));
  const struct {
    int x, y;
    glm::vec3 radiance;
  } pixels[] = {{158, 473, {0.163471f, 0.085376f, 0.022196f}}, {190, 480, {0.161358f, 0.084272f, 0.021909f}}, {324, 335, {0.344151f, 0.179738f, 0.046729f}}};
  for (const auto &pixel : pixels) {
    RenderSettings s = sharp(512, 512, 1);
    s.x0 = pixel.x;
    s.y0 = pixel.y;
    s.x1 = pixel.x + 1;
    s.y1 = pixel.y + 1;
    const std::vector<Film> films = render_seeds(cornell, s, 2048, 16);
    EXPECT_EQ(differs(films, "bounce.1", whole(films[0]), pixel.radiance, 1e-3), "") << "pixel " << pixel.x << ", " << pixel.y;
  }
}

// Bodies that absorb nothing vanish in a uniform sky: at most 1 per cent is missing, and never more comes out than goes in.
TEST(Oracle, WhiteSpheresVanish) {
  const Case spheres = with_sky("furnace/white-spheres.gltf", {1, 1, 1});
  RenderSettings s = sharp(160, 128, 64);
  const std::vector<Film> films = render_seeds(spheres, s, 8, 16);
  for (const Instance &instance : spheres.scene().instances) {
    const glm::vec3 at = instance.transform[3];
    const int x = static_cast<int>(std::lround((at.x / 2.75f + 1) * 80)), y = static_cast<int>(std::lround((1 - at.y / 2.2f) * 64));
    for (const int half : {14, 7}) {
      const Window window{x - half, y - half, x + half, y + half};
      for (int channel = 0; channel < 3; channel++) {
        const Moments m = moments(means(films, "beauty", window, channel));
        const double noise = interval(m, 1e-9);
        EXPECT_GT(m.mean, 0.99 - noise) << instance.name << " loses energy (window " << 2 * half << ")";
        EXPECT_LT(m.mean, 1 + noise + 1e-4) << instance.name << " makes energy (window " << 2 * half << ")";
      }
    }
  }
}

TEST(Oracle, PointLightFallsWithTheSquare) {
  const glm::vec3 albedo(0.8f, 0.4f, 0.2f), intensity(10, 20, 30);
  for (const float height : {1.0f, 2.0f, 4.0f})
    for (const float aside : {0.0f, 1.5f}) {
      Scene scene = plane_seen_at(aside, 0, albedo);
      add_point_light(scene, {0, 0, height}, intensity);
      const float distance2 = height * height + aside * aside;
      EXPECT_EQ(seen(std::move(scene), albedo / pi * intensity * (height / (distance2 * std::sqrt(distance2))), 4, 1e-4), "") << "height " << height << ", aside " << aside;
    }
}

TEST(Oracle, SpotAndDirectionalLights) {
  const glm::vec3 albedo(0.5f, 0.6f, 0.7f), intensity(3, 2, 1);
  Light spot;
  spot.kind = Light::Kind::spot;
  spot.position = {0, 0, 2};
  spot.direction = {0, 0, -1};
  spot.intensity = intensity;
  spot.inner_angle = 0.3f;
  spot.outer_angle = 0.6f;
  for (const float angle : {0.0f, 0.25f, 0.45f, 0.55f, 0.65f}) {
    Scene scene = plane_seen_at(2 * std::tan(angle), 0, albedo);
    scene.lights = {spot};
    const float ramp = std::clamp((std::cos(angle) - std::cos(0.6f)) / (std::cos(0.3f) - std::cos(0.6f)), 0.0f, 1.0f);
    const float distance = 2 / std::cos(angle);
    EXPECT_EQ(seen(std::move(scene), albedo / pi * intensity * (ramp * ramp * std::cos(angle) / (distance * distance)), 4, 1e-3), "") << "angle " << angle;
  }
  Light sun;
  sun.kind = Light::Kind::directional;
  sun.direction = glm::normalize(glm::vec3(1, 0, -2));
  sun.intensity = intensity;
  Scene scene = plane_seen_at(0, 0, albedo);
  scene.lights = {sun};
  EXPECT_EQ(seen(std::move(scene), albedo / pi * intensity * -sun.direction.z), "");
}

// A disc of light from a rectangle far larger than high is nearly a hemisphere; the exact form factor of a square parallel to the plane tells.
TEST(Oracle, SquareLampOverAPlane) {
  const glm::vec3 albedo(0.9f, 0.6f, 0.3f), radiance(2, 3, 4);
  Scene scene = plane_seen_at(0, 0, albedo);
  add(scene, quad({0, 0, 1.5f}, {0, 1, 0}, {1, 0, 0}), lamp(radiance));  // faces down
  scene.cameras.clear();
  look_flat(scene, {0, 2, 1.4f}, {0, 0, 0}, 0.002f);
  const float a = 1 / 1.5f, factor = 4 * 2 / (2 * pi) * a / std::sqrt(1 + a * a) * std::atan(a / std::sqrt(1 + a * a));
  for (const char *integrator : {"path", "pure"}) {
    RenderSettings s = sharp(4, 4, 1);
    s.integrator = integrator;
    const std::vector<Film> films = render_seeds(Case(scene), s, 256, 16);
    EXPECT_EQ(differs(films, "bounce.1", whole(films[0]), albedo * radiance * factor, 1e-4), "") << integrator;
  }
}

// Straight through a slab: what two surfaces let in and out, with all the reflections in between, and what is absorbed on each passage.
TEST(Oracle, BeersLawThroughASlab) {
  const glm::vec3 absorption(0.5f, 1, 2), radiance(3, 2, 1);
  for (const float thickness : {0.5f, 1.0f}) {
    Scene scene;
    add(scene, box({-5, -5, 0}, {5, 5, thickness}), glass(absorption));
    add(scene, quad({0, 0, -1}, {4, 0, 0}, {0, 4, 0}), lamp(radiance));
    look_flat(scene, {0, 0, 5}, {0, 0, 0}, 0.5f);
    glm::vec3 expected;
    for (int c = 0; c < 3; c++) {
      const float left = std::exp(-absorption[c] * thickness), f = 0.04f;
      expected[c] = (1 - f) * (1 - f) * left / (1 - f * f * left * left) * radiance[c];
    }
    EXPECT_EQ(seen(std::move(scene), expected, 24, 1e-4, 256), "") << "thickness " << thickness;
  }
}

TEST(Oracle, LampInAMirrorIsExact) {
  const glm::vec3 color(0.9f, 0.6f, 0.3f), radiance(0.5f, 0.7f, 0.9f);  // below 1, where the film's quantum is finest
  for (const float degrees : {0.0f, 45.0f, 70.0f}) {
    const float angle = degrees * pi / 180;
    Scene scene;
    add(scene, quad({0, 0, 0}, {5, 0, 0}, {0, 5, 0}), metal(color, 0));
    const glm::vec3 towards(std::sin(angle), 0, std::cos(angle)), away(-towards.x, 0, towards.z);
    const glm::vec3 lamp_at = away * 8.0f, side(towards.z, 0, towards.x);
    if (degrees > 0) {
      add(scene, quad(lamp_at, side * 2.0f, {0, 2, 0}), lamp(radiance));
      const glm::vec3 front = glm::cross(side, glm::vec3(0, 1, 0));
      if (glm::dot(front, away) > 0) std::swap(scene.meshes.back().primitives[0].indices[1], scene.meshes.back().primitives[0].indices[2]),
          std::swap(scene.meshes.back().primitives[0].indices[4], scene.meshes.back().primitives[0].indices[5]);
      for (glm::vec3 &n : scene.meshes.back().primitives[0].normals) n = -away;
    } else {
      set_sky(scene, radiance);
    }
    look_flat(scene, towards * 6.0f, {0, 0, 0}, 0.3f);
    const float schlick = std::pow(1 - std::cos(angle), 5.0f);
    const Film film = render(Case(std::move(scene)), sharp(4, 4, 2), {0, 1}).film;
    for (int y = 0; y < 4; y++)
      for (int x = 0; x < 4; x++)
        for (int c = 0; c < 3; c++)
          EXPECT_NEAR(mean(film, "bounce.1", {x, y, x + 1, y + 1}, c), radiance[c] * (color[c] + (1 - color[c]) * schlick), 3e-6 * static_cast<double>(radiance[c])) << degrees << " degrees";
  }
}

// The surface of a smooth dielectric over black sends back what Schlick's Fresnel says.
// A white mirror with a strong normal map shows a white sky whole, however it is looked at: no mirrored direction goes into the surface.
TEST(Oracle, BumpyMirrorsHaveNoBlackRings) {
  for (const float degrees : {0.0f, 60.0f, 85.0f}) {
    const float angle = degrees * pi / 180;
    Scene scene;
    Material mirror = metal({1, 1, 1}, 0);
    mirror.normal_texture = use_picture(scene, bumps(16, 16));
    mirror.normal_scale = 4;
    add(scene, quad({0, 0, 0}, {5, 0, 0}, {0, 5, 0}), mirror);
    set_sky(scene, {0.75f, 0.5f, 0.25f});
    look_flat(scene, glm::vec3(std::sin(angle), 0, std::cos(angle)) * 6.0f, {0, 0, 0}, 0.3f);
    const Film film = render(Case(std::move(scene)), sharp(16, 16, 1), {0, 1}).film;
    for (int y = 0; y < 16; y++)
      for (int x = 0; x < 16; x++) EXPECT_NEAR(mean(film, "bounce.1", {x, y, x + 1, y + 1}, 0), 0.75, 1e-5) << degrees << " degrees, pixel " << x << ", " << y;
  }
}

TEST(Oracle, FresnelOfADielectric) {
  for (const float degrees : {0.0f, 60.0f, 80.0f}) {
    const float angle = degrees * pi / 180;
    Scene scene;
    Material black;
    black.base_color = glm::vec3(0);
    black.roughness = 0;
    add(scene, quad({0, 0, 0}, {50, 0, 0}, {0, 50, 0}), black);
    set_sky(scene, {1, 2, 3});
    look_flat(scene, glm::vec3(std::sin(angle), 0, std::cos(angle)) * 6.0f, {0, 0, 0}, 0.3f);
    const float reflected = 0.04f + 0.96f * std::pow(1 - std::cos(angle), 5.0f);
    EXPECT_EQ(seen(std::move(scene), glm::vec3(1, 2, 3) * reflected, 2, 1e-4, 256), "") << degrees << " degrees";
  }
}

TEST(Oracle, HalfAVeil) {
  Material veil = lamp({2, 4, 6});
  veil.alpha_mode = AlphaMode::blend;
  veil.alpha = 0.5f;
  Scene scene;
  add(scene, quad({0, 0, 1}, {2, 0, 0}, {0, 2, 0}), veil);
  add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), lamp({1, 1, 0}));
  look_flat(scene, {0, 0, 5}, {0, 0, 0}, 0.5f);
  EXPECT_EQ(seen(scene, {1.5f, 2.5f, 3}, 0, 1e-5, 256), "") << "light seen directly, at depth 0";

  // A shadow ray through it keeps the rest; two veils keep the rest of the rest.
  for (const int veils : {1, 2}) {
    Scene shaded = plane_seen_at(1, 0, {0.5f, 0.5f, 0.5f});
    Material cloth = matt({0, 0, 0});
    cloth.alpha_mode = AlphaMode::blend;
    cloth.alpha = 0.25f;
    for (int i = 0; i < veils; i++) add(shaded, quad({0, 0, 1 + 0.1f * static_cast<float>(i)}, {0.8f, 0, 0}, {0, 0.8f, 0}), cloth);
    add_point_light(shaded, {0, 0, 2}, {8, 8, 8});
    const float direct = 0.5f / pi * 8 * 2 / (5 * std::sqrt(5.0f)) * std::pow(0.75f, static_cast<float>(veils));
    EXPECT_EQ(seen(std::move(shaded), glm::vec3(direct), 2, 1e-4, 1024), "") << veils << " veils";
  }
  // A mask is there, or it is not.
  for (const float alpha : {0.4f, 0.6f}) {
    Material cut = lamp({2, 4, 6});
    cut.alpha_mode = AlphaMode::mask;
    cut.alpha = alpha;
    Scene masked;
    add(masked, quad({0, 0, 1}, {2, 0, 0}, {0, 2, 0}), cut);
    set_sky(masked, {1, 1, 0});
    look_flat(masked, {0, 0, 5}, {0, 0, 0}, 0.5f);
    EXPECT_EQ(seen(std::move(masked), alpha < 0.5f ? glm::vec3(1, 1, 0) : glm::vec3(2, 4, 6), 2, 1e-6, 2), "");
  }
}

// Going straight on through alpha or smooth thin glass is no scattering: light seen directly is there at --max-depth 0, and so at every limit.
TEST(Oracle, NullEventsTakeNoDepth) {
  for (const char *integrator : {"path", "pure"}) {
    Scene scene;
    Material veil = matt({0, 0, 0});
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.25f;
    for (int i = 0; i < 3; i++) {
      add(scene, quad({0, 0, 1 + 0.2f * static_cast<float>(i)}, {2, 0, 0}, {0, 2, 0}), thin_glass({0.8f, 0.9f, 1}));
      add(scene, quad({0, 0, 1.1f + 0.2f * static_cast<float>(i)}, {2, 0, 0}, {0, 2, 0}), veil);
    }
    add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), lamp({0.5f, 0.6f, 0.7f}));
    look_flat(scene, {0, 0, 5}, {0, 0, 0}, 0.5f);
    const Case behind_glass(std::move(scene));
    std::vector<Film> films;
    for (const unsigned max_depth : {0u, 1u, 5u}) {
      RenderSettings s = sharp(8, 8, max_depth);
      s.integrator = integrator;
      films.push_back(render(behind_glass, s, {0, 16}).film);
    }
    EXPECT_GT(mean(films[0], "bounce.0", whole(films[0]), 1), 0.1) << integrator;
    for (const Film &film : films) EXPECT_EQ(layer_hash(film, *film.find("bounce.0")), layer_hash(films[0], *films[0].find("bounce.0"))) << integrator;
  }
}

TEST(Oracle, SkyMapIsWhereConventionsSay) {
  constexpr int width = 8, height = 4;
  Image map = sky_map(width, height, {0, 0, 0});
  std::vector<float> &values = std::get<std::vector<float>>(map.pixels);
  for (std::size_t i = 0; i < values.size(); i++) values[i] = 0.25f + static_cast<float>(i);
  for (const float rotation : {0.0f, 0.25f})
    for (const auto &[column, row] : {std::pair{0, 0}, std::pair{3, 1}, std::pair{5, 2}, std::pair{7, 3}}) {
      Scene scene;
      add(scene, quad({0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}), matt({1, 1, 1}));
      set_sky_map(scene, map);
      scene.environment.rotation = rotation;
      const float u = (static_cast<float>(column) + 0.5f) / width - rotation, v = (static_cast<float>(row) + 0.5f) / height;
      const float across = (u - 0.5f) * 2 * pi;
      const glm::vec3 direction(std::sin(v * pi) * std::cos(across), std::cos(v * pi), std::sin(v * pi) * std::sin(across));
      look_flat(scene, direction * 10.0f, direction * 20.0f, 0.01f);
      const std::size_t at = static_cast<std::size_t>(row * width + column) * 3;
      EXPECT_EQ(seen(std::move(scene), {values[at], values[at + 1], values[at + 2]}, 0, 1e-4, 2), "") << "texel " << column << ", " << row << ", turned by " << rotation;
    }
}

TEST(Oracle, PicturesOnSurfacesStandUpright) {
  Scene scene;
  Image picture;
  picture.name = "four";
  picture.width = picture.height = 2;
  picture.channels = 3;
  picture.pixels = std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 188, 188, 188};  // red green / blue grey, rows from the top
  Material shown;
  shown.unlit = true;
  shown.base_color_texture = use_picture(scene, picture, false);
  add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), shown);
  look_flat(scene, {0, 0, 5}, {0, 0, 0}, 1);
  const Film film = render(Case(std::move(scene)), sharp(4, 4, 2), {0, 4}).film;
  const double grey = std::pow((188 / 255.0 + 0.055) / 1.055, 2.4);
  const double expected[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {grey, grey, grey}};
  for (int i = 0; i < 4; i++)
    for (int c = 0; c < 3; c++) EXPECT_NEAR(mean(film, "bounce.0", {i % 2 * 2, i / 2 * 2, i % 2 * 2 + 2, i / 2 * 2 + 2}, c), expected[i][c], 1e-5) << "quarter " << i;
}

TEST(Oracle, BlackSkiesAndNoLightAreBlack) {
  Image black = sky_map(8, 4, {0, 0, 0});
  std::fill(std::get<std::vector<float>>(black.pixels).begin(), std::get<std::vector<float>>(black.pixels).end(), 0.0f);
  for (int kind = 0; kind < 3; kind++) {
    Scene scene;
    add(scene, sphere({0, 0, 0}, 1), matt({0.5f, 0.5f, 0.5f}));
    if (kind == 1) set_sky(scene, {0, 0, 0});
    if (kind == 2) set_sky_map(scene, black);
    add_camera(scene, {0, 0, 4}, {0, 0, 0}, 40);
    const Rendered r = render(Case(std::move(scene)), sharp(16, 16, 4), {0, 4});
    for (const FilmLayer &layer : r.film.layers)
      for (const std::int64_t value : layer.values) ASSERT_EQ(value, 0) << layer.name;
    EXPECT_EQ(r.counts.nan, 0u);
  }
}

TEST(Oracle, LayersOfTheFirstHit) {
  Scene scene;
  Material veil = matt({0.1f, 0.1f, 0.1f});
  veil.alpha_mode = AlphaMode::blend;
  veil.alpha = 0;
  add(scene, quad({0, 0, 2}, {9, 0, 0}, {0, 9, 0}), veil);  // not there: the layers are those of what is behind it
  add(scene, quad({-1, 0, 0.5f}, {1, 0, 0}, {0, 9, 0}), matt({0.2f, 0.4f, 0.8f}));
  set_sky(scene, {1, 1, 1});
  look_flat(scene, {0, 0, 5}, {0, 0, 0}, 1);
  RenderSettings s = sharp(8, 8, 2);
  s.layers.albedo = s.layers.normal = s.layers.depth = s.layers.position = s.layers.object = s.layers.material = s.layers.alpha = true;
  const Film film = render(Case(std::move(scene)), s, {0, 16}).film;
  const Window left{0, 0, 4, 8}, right{4, 0, 8, 8};
  for (int c = 0; c < 3; c++) {
    EXPECT_NEAR(mean(film, "albedo", left, c), (glm::vec3(0.2f, 0.4f, 0.8f)[c]), 1e-6);
    EXPECT_NEAR(mean(film, "normal", left, c), c == 2 ? 1 : 0, 1e-6);
    EXPECT_NEAR(mean(film, "Z", left, c), 4.5, 1e-5);
    EXPECT_NEAR(mean(film, "alpha", left, c), 1, 1e-6);
    for (const char *layer : {"albedo", "normal", "Z", "alpha", "position", "object_id", "material_id"}) EXPECT_EQ(mean(film, layer, right, c), 0) << layer;
  }
  EXPECT_NEAR(mean(film, "position", left, 0), -0.5, 0.01);
  EXPECT_NEAR(mean(film, "position", left, 2), 0.5, 1e-6);
  EXPECT_EQ(mean(film, "object_id", {0, 0, 1, 1}, 0), mean(film, "object_id", left, 0)) << "sample 0's, not an average";
  EXPECT_EQ(mean(film, "material_id", left, 0), std::floor(mean(film, "material_id", left, 0)));
  EXPECT_GT(mean(film, "material_id", left, 0), 0);
}

// Colours of vertices multiply the base colour and the alpha, in a scene that has no texture too, and what unlit surfaces show.
TEST(Oracle, ColoursOfVerticesWithoutTextures) {
  for (const bool unlit : {false, true}) {
    Scene scene;
    Material material = matt({0.5f, 1, 1});
    material.unlit = unlit;
    Primitive coloured = quad({0, 0, 0}, {9, 0, 0}, {0, 9, 0});
    coloured.colors.assign(coloured.positions.size(), {0.8f, 0.25f, 0.5f, 1});
    add(scene, coloured, material);
    set_sky(scene, {1, 1, 1});
    look_flat(scene, {0, 0, 5}, {0, 0, 0}, 1);
    const Case made(std::move(scene));
    EXPECT_TRUE(made.flat(Layout::binary).texture_refs.empty());
    Ways trimmed;
    trimmed.trimmed = true;
    const std::vector<Film> films = render_seeds(made, sharp(8, 8, 1), 64, 16, trimmed);
    EXPECT_EQ(differs(films, "beauty", whole(films[0]), {0.4f, 0.25f, 0.5f}), "") << (unlit ? "unlit" : "lit");
  }
}

// Objects are the scene's instances, whether their mesh is baked with others (used once) or kept (used often).
TEST(Oracle, ObjectsAreTheScenesInstances) {
  Scene scene;
  add(scene, quad({-3, 0, 0}, {1, 0, 0}, {0, 9, 0}), matt({1, 1, 1}));
  add(scene, quad({-1, 0, 0}, {1, 0, 0}, {0, 9, 0}), matt({1, 1, 1}));
  const int often = add(scene, sphere({2, 0, 0}, 1.5f, 200), matt({1, 1, 1}));
  place(scene, often, scaled({1, 1, 1}, {20, 0, 0}));
  look_flat(scene, {0, 0, 5}, {0, 0, 0}, 4);
  set_sky(scene, {1, 1, 1});
  RenderSettings s = sharp(8, 8, 0);
  s.layers.object = true;
  Case made(std::move(scene));
  ASSERT_EQ(made.flat(Layout::binary).instances.size(), 3u) << "two kept, and one for what is baked";
  const Film film = render(made, s, {0, 1}).film;
  EXPECT_EQ(mean(film, "object_id", {0, 0, 2, 8}, 0), 1);
  EXPECT_EQ(mean(film, "object_id", {2, 0, 4, 8}, 0), 2);
  EXPECT_EQ(mean(film, "object_id", {5, 3, 7, 5}, 0), 3);
  EXPECT_EQ(mean(film, "object_id", {7, 0, 8, 1}, 0), 0);
}

TEST(Oracle, TransparentBackground) {
  Scene scene;
  add(scene, quad({-1, 0, 0}, {1, 0, 0}, {0, 9, 0}), matt({0.5f, 0.5f, 0.5f}));
  set_sky(scene, {1, 1, 1});
  look_flat(scene, {0, 0, 5}, {0, 0, 0}, 1);
  RenderSettings s = sharp(8, 8, 2);
  s.transparent_background = true;
  const std::vector<Film> films = render_seeds(Case(std::move(scene)), s, 64, 16);
  EXPECT_EQ(differs(films, "beauty", {0, 0, 4, 8}, {0.5f, 0.5f, 0.5f}), "") << "still lit by the sky";
  EXPECT_EQ(differs(films, "beauty", {4, 0, 8, 8}, {0, 0, 0}), "");
  EXPECT_EQ(differs(films, "alpha", {4, 0, 8, 8}, {0, 0, 0}), "");
  EXPECT_EQ(differs(films, "alpha", {0, 0, 4, 8}, {1, 1, 1}), "");
}

// Filters: a constant stays a constant under each, Mitchell's negative lobes included.
TEST(Oracle, FiltersKeepAConstant) {
  for (const char *name : {"box", "tent", "gaussian", "mitchell", "blackman-harris"}) {
    Scene scene;
    add(scene, quad({0, 0, -50}, {0.1f, 0, 0}, {0, 0.1f, 0}), matt({1, 1, 1}));
    set_sky(scene, {1, 0.5f, 2});
    look_flat(scene, {0, 0, 5}, {0, 0, 6}, 1);
    RenderSettings s = picture(8, 8, 1);
    s.filter = filter_from_name(name);
    const std::vector<Film> films = render_seeds(Case(std::move(scene)), s, 64, 16);
    EXPECT_EQ(differs(films, "beauty", whole(films[0]), {1, 0.5f, 2}), "") << name;
  }
}

}  // namespace sunstone::test
