// SPDX-License-Identifier: Apache-2.0
// Sides, instances, closed rooms, cameras in odd places.
#include <gtest/gtest.h>

#include <cmath>

#include "support/agree.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace sunstone::test {
namespace {

// A square of side 2 in the plane z = 0, front towards +z, of 2 n^2 triangles: many of them, used twice, are an instance and not baked.
Primitive grid(int n) {
  Primitive p;
  for (int y = 0; y <= n; y++)
    for (int x = 0; x <= n; x++) {
      p.positions.push_back({2 * static_cast<float>(x) / static_cast<float>(n) - 1, 2 * static_cast<float>(y) / static_cast<float>(n) - 1, 0});
      p.normals.push_back({0, 0, 1});
    }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; y++)
    for (int x = 0; x < n; x++) p.indices.insert(p.indices.end(), {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1)});
  return p;
}

constexpr int baked = 2, instanced = 60;  // 2 * 60^2 * 2 triangles

// A lamp of the grid, placed by `transform`, seen from `from`; a second placement of the mesh is out of sight.
Scene placed_lamp(int n, const glm::mat4x3 &transform, glm::vec3 from) {
  Scene scene;
  const int mesh = add(scene, grid(n), lamp({0.5f, 0.25f, 0.125f}), transform);
  place(scene, mesh, scaled({1, 1, 1}, {500, 500, 500}));
  add_camera(scene, from, {0, 0, 0}, 10);
  return scene;
}

double brightness(Scene scene, unsigned max_depth = 0) {
  RenderSettings s = picture(8, 8, max_depth);
  s.filter = box_filter();
  const Film film = render(Case(std::move(scene)), s, {0, 4}).film;
  return mean(film, "beauty", whole(film), 0);
}

}  // namespace

TEST(Geometry, ClosedRoomsAreDarkInside) {
  for (int kind = 0; kind < 4; kind++)
    for (const char *integrator : {"path", "pure"}) {
      Scene scene;
      const Material wall = matt({0.9f, 0.9f, 0.9f});
      const float turn = 0.7f;
      glm::mat4x3 turned(1);
      turned[0] = {std::cos(turn), 0, -std::sin(turn)};
      turned[2] = {std::sin(turn), 0, std::cos(turn)};
      turned[3] = {0.3f, 0.2f, -0.1f};
      if (kind == 0) add(scene, box({-2, -1, -2}, {2, 1, 2}, true), wall);
      if (kind == 1) add(scene, box({-2, -1, -2}, {2, 1, 2}), wall, turned);
      if (kind == 2) add(scene, sphere({0, 0, 0}, 2, 24), wall, turned);
      if (kind == 3) place(scene, add(scene, sphere({0, 0, 0}, 2, 48), wall, turned), scaled({1, 1, 1}, {40, 0, 0}));
      set_sky(scene, {1000, 1000, 1000});
      add(scene, quad({0, 30, 0}, {9, 0, 0}, {0, 0, 9}), lamp({1000, 1000, 1000}));
      if (std::string(integrator) == "path") add_point_light(scene, {4, 0.5f, 0.2f}, {1e5f, 1e5f, 1e5f});
      add_camera(scene, {0.1f, 0.2f, 0.9f}, {0, 0, -1}, 100);
      RenderSettings s = picture(64, 64, 12);
      s.integrator = integrator;
      const Rendered r = render(Case(std::move(scene)), s, {0, 32});
      std::size_t lit = 0;
      for (const FilmLayer &layer : r.film.layers)
        for (const std::int64_t value : layer.values) lit += value != 0;
      EXPECT_EQ(lit, 0u) << "room " << kind << ", " << integrator;
      EXPECT_EQ(r.counts.ended[SUN_ENDED_ESCAPED], 0u) << "room " << kind << ", " << integrator;
    }
}

// Radiance within glass is eta^2 of that outside; what is absorbed is missing, and nothing is infinite.
TEST(Geometry, CameraInsideGlass) {
  for (const float roughness : {0.0f, 0.4f})
    for (const bool clear : {true, false}) {
      Scene scene;
      add(scene, sphere({0, 0, 0}, 1), glass(clear ? glm::vec3(0) : glm::vec3(0.3f, 0.1f, 0.5f), roughness));
      set_sky(scene, {1, 1, 1});
      add_camera(scene, {0.2f, 0.1f, 0.3f}, {0, 0, -1}, 90);
      RenderSettings s = picture(32, 32, 64);
      s.filter = box_filter();
      const std::vector<Film> films = render_seeds(Case(std::move(scene)), s, 16, 16);
      for (int channel = 0; channel < 3; channel++) {
        const Moments m = moments(means(films, "beauty", whole(films[0]), channel));
        EXPECT_GT(m.mean, (clear ? 0.99 : 0.3) * 2.25 - interval(m, 1e-9)) << "roughness " << roughness;
        EXPECT_LT(m.mean, (clear ? 1 : 0.95) * 2.25 + interval(m, 1e-9)) << "roughness " << roughness;
      }
      for (const Film &film : films) EXPECT_EQ(film.nan + film.clamped, 0u);
    }
}

TEST(Geometry, CameraOnASurfaceAndDegenerateTriangles) {
  Scene scene;
  Primitive floor = quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2});
  floor.positions.push_back({0, 0, 0});  // a triangle of no area, and a needle
  floor.positions.push_back({1, 1e-20f, 0});
  floor.normals.resize(6, {0, 1, 0});
  floor.uv[0].resize(6, {0, 0});
  floor.indices.insert(floor.indices.end(), {4, 4, 5, 0, 5, 4});
  add(scene, floor, matt({0.5f, 0.5f, 0.5f}));
  set_sky(scene, {1, 1, 1});
  add_camera(scene, {0, 0, 0}, {0, 0.3f, -1}, 90);
  const Rendered r = render(Case(std::move(scene)), picture(16, 16, 4), {0, 8});
  EXPECT_EQ(r.counts.nan, 0u);
  EXPECT_GT(mean(r.film, "beauty", whole(r.film), 0), 0.3);
}

TEST(Geometry, SingleSidedFacesArePassedFromBehind) {
  Material one_sided = matt({0.5f, 0.5f, 0.5f});
  one_sided.double_sided = false;
  for (const bool from_behind : {false, true}) {
    // Seen by the camera.
    Scene scene;
    add(scene, quad({0, 0, 1}, {from_behind ? -3.0f : 3.0f, 0, 0}, {0, 3, 0}), one_sided);
    add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), lamp({0.75f, 0, 0}));
    add_camera(scene, {0, 0, 5}, {0, 0, 0}, 10);
    EXPECT_NEAR(brightness(std::move(scene)), from_behind ? 0.75 : 0, 1e-6);
    // Shadow rays, from a plane up to a light.
    Scene shadow;
    add(shadow, quad({0, 0, 0}, {3, 0, 0}, {0, 3, 0}), matt({0.5f, 0.5f, 0.5f}));
    add(shadow, quad({0, 0, 1}, {from_behind ? 1.0f : -1.0f, 0, 0}, {0, 1, 0}), one_sided);  // a ray upwards meets its back where it faces up
    add_point_light(shadow, {0, 0, 2}, {4, 4, 4});
    add_camera(shadow, {2.5f, 0, 0.5f}, {0, 0, 0}, 2);
    const double light = brightness(std::move(shadow), 1);
    if (from_behind) EXPECT_NEAR(light, 0.5 / 3.14159265 * 4 / 4, 0.01);
    else EXPECT_EQ(light, 0);
  }
  // Double-sided ones are there from both sides; so is what transmits.
  for (int kind = 0; kind < 2; kind++) {
    Scene scene;
    Material both = kind == 0 ? matt({0, 0, 0}) : glass({50, 50, 50});
    if (kind == 0) add(scene, quad({0, 0, 1}, {-3, 0, 0}, {0, 3, 0}), both);
    else add(scene, box({-3, -3, 1}, {3, 3, 2}), both);
    add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), lamp({0.75f, 0, 0}));
    add_camera(scene, {0, 0, 5}, {0, 0, 0}, 10);
    EXPECT_LT(brightness(std::move(scene), 4), 1e-6) << kind;
  }
}

TEST(Geometry, LampsShineFromTheirFront) {
  for (const bool double_sided : {false, true})
    for (const float side : {1.0f, -1.0f}) {
      Scene scene;
      Material m = lamp({0.75f, 0, 0});
      m.double_sided = double_sided;
      add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), m);
      add_camera(scene, {0, 0, 5 * side}, {0, 0, 0}, 10);
      EXPECT_NEAR(brightness(std::move(scene)), double_sided || side > 0 ? 0.75 : 0, 1e-6);
    }
}

// glTF 2.0, 3.7.4: where a node's determinant is negative, its triangles' winding is clockwise. So the front goes where the transform takes the normal, and a
// mirrored lamp faces the way that its mirrored normal does, baked or not.
TEST(Geometry, MirroredNodesKeepTheirFronts) {
  const struct {
    glm::vec3 scale;
    float front;  // z of the side that it is seen from
  } cases[] = {{{1, 1, 1}, 1}, {{-1, 1, 1}, 1}, {{1, -1, 1}, 1}, {{1, 1, -1}, -1}, {{-1, -1, 1}, 1}, {{-1, -1, -1}, -1}, {{-2, 0.5f, -1}, -1}};
  for (const int n : {baked, instanced})
    for (const auto &c : cases) {
      const glm::mat4x3 transform = scaled(c.scale, {0, 0, 0});
      const Case scene(placed_lamp(n, transform, {0, 0, 5}));
      const FlatScene &flat = scene.flat(Layout::binary);
      if (n == instanced) {
        ASSERT_EQ(flat.instances.size(), 2u) << "not baked";
        EXPECT_EQ((flat.instances[0].flags & SUN_INSTANCE_MIRRORED) != 0, c.scale.x * c.scale.y * c.scale.z < 0);
      }
      const std::string what = std::string(n == baked ? "baked" : "instance") + " of scale " + std::to_string(c.scale.x) + ", " + std::to_string(c.scale.y) + ", " + std::to_string(c.scale.z);
      EXPECT_NEAR(brightness(placed_lamp(n, transform, {0, 0, 5 * c.front})), 0.5, 1e-5) << what << ", from its front";
      EXPECT_EQ(brightness(placed_lamp(n, transform, {0, 0, -5 * c.front})), 0) << what << ", from behind";
    }
}

// The same for its light: a plane below a mirrored lamp gets what it gets from one that was built that way. By shadow rays, and by chance.
TEST(Geometry, MirroredLampsShineWhereTheyFace) {
  for (const char *integrator : {"path", "pure"}) {
    std::vector<std::vector<Film>> films;
    for (const int n : {baked, instanced})
      for (const bool mirrored : {false, true}) {
        Scene scene;
        // The grid faces +z; a rotation turns it to face down, and a mirror at x, where there is one, changes nothing about that.
        glm::mat4x3 down(0);
        down[0] = {mirrored ? -0.5f : 0.5f, 0, 0};
        down[1] = {0, 0, 0.5f};
        down[2] = {0, -0.5f, 0};
        down[3] = {0, 1, 0};
        const int mesh = add(scene, grid(n), lamp({3, 2, 1}), down);
        glm::mat4x3 far_away = down;
        far_away[3] = {500, 1, 0};
        place(scene, mesh, far_away);
        add(scene, quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}), matt({0.5f, 0.6f, 0.7f}));
        add_camera(scene, {0, 0.9f, 3}, {0, 0, 0}, 40);
        RenderSettings s = picture(16, 16, 1);
        s.integrator = integrator;
        films.push_back(render_seeds(Case(std::move(scene)), s, 64, 16));
      }
    for (std::size_t i = 1; i < films.size(); i++)
      for (int channel = 0; channel < 3; channel++) {
        const std::vector<double> a = means(films[0], "bounce.1", whole(films[0][0]), channel), b = means(films[i], "bounce.1", whole(films[0][0]), channel);
        EXPECT_GT(moments(a).mean, 0.02);
        EXPECT_GT(welch(a, b), 1e-8) << integrator << ", kind " << i << ": " << moments(b).mean << " instead of " << moments(a).mean;
      }
  }
}

// Solid glass knows its inside by the front as well: a mirrored glass ball absorbs as the ball does.
TEST(Geometry, MirroredGlassIsGlass) {
  std::vector<std::vector<Film>> films;
  for (const float sign : {1.0f, -1.0f}) {
    Scene scene;
    const int ball = add(scene, sphere({0, 0, 0}, 1, 40), glass({1, 0.5f, 0.25f}), scaled({sign, 1, 1}, {0, 0, 0}));
    place(scene, ball, scaled({sign, 1, 1}, {100, 0, 0}));
    set_sky(scene, {1, 1, 1});
    add_camera(scene, {0, 0, 5}, {0, 0, 0}, 10);
    films.push_back(render_seeds(Case(std::move(scene)), picture(8, 8, 16), 64, 16));
  }
  for (int channel = 0; channel < 3; channel++) {
    const std::vector<double> a = means(films[0], "beauty", whole(films[0][0]), channel), b = means(films[1], "beauty", whole(films[0][0]), channel);
    EXPECT_LT(moments(a).mean, 0.9) << "it absorbs";
    EXPECT_GT(welch(a, b), 1e-8) << moments(a).mean << " and " << moments(b).mean;
  }
}

// A floor of many triangles, in no plane of the axes, under a sun that all but grazes it: none of them shades another, and each pixel has its closed form.
TEST(Geometry, NothingShadesItselfWhereLightGrazes) {
  for (const float degrees : {5.0f, 0.5f, 0.05f}) {
    Scene scene;
    glm::mat4x3 tilted(1);
    const float turn = 0.4f, elevation = glm::radians(degrees);
    tilted[0] = {std::cos(turn), std::sin(turn), 0};
    tilted[1] = {-std::sin(turn), std::cos(turn), 0};
    tilted[2] = {0, 0, 1};
    tilted = glm::mat4x3(glm::mat3(glm::vec3(0.6f, 0, -0.8f), glm::vec3(0, 1, 0), glm::vec3(0.8f, 0, 0.6f)) * glm::mat3(tilted));
    tilted[3] = {0.3f, -0.2f, 0.1f};
    const glm::vec3 along = tilted[0], normal = tilted[2];
    add(scene, grid(40), matt({0.5f, 0.5f, 0.5f}), tilted);
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = glm::normalize(std::cos(elevation) * along - std::sin(elevation) * normal);
    sun.intensity = {1000, 1000, 1000};
    scene.lights.push_back(sun);
    add_camera(scene, tilted[3] + 3.0f * normal, tilted[3], 20);
    RenderSettings s = picture(16, 16, 1);
    s.filter = box_filter();
    const Film film = render(Case(std::move(scene)), s, {0, 4}).film;
    const double expected = 0.5 / M_PI * 1000 * std::sin(elevation);
    for (int y = 0; y < 16; y++)
      for (int x = 0; x < 16; x++) EXPECT_NEAR(mean(film, "beauty", {x, y, x + 1, y + 1}, 0), expected, 1e-3 * expected + 1e-4) << degrees << " degrees, pixel " << x << ", " << y;
  }
}

// Rays within the planes of walls: camera rays go on to the sky, a sun that shines down a wall leaves it black and the floor lit to its foot.
TEST(Geometry, RaysParallelToWalls) {
  Scene scene;
  for (const float x : {-0.5f, 0.0f, 0.5f}) add(scene, quad({x, 0, 0}, {0, 0, 1}, {0, 1, 0}), matt({0.9f, 0.9f, 0.9f}));
  add(scene, quad({0, 0.25f, 0}, {1, 0, 0}, {0, 0, 1}), matt({0.9f, 0.9f, 0.9f}));
  set_sky(scene, {0.75f, 0.5f, 0.25f});
  add_flat_camera(scene, {0, 0, 5}, 1);
  for (const Layout layout : {Layout::binary, Layout::wide8, Layout::wide16}) {
    Ways ways;
    ways.layout = layout;
    const Rendered r = render(Case(scene), picture(16, 16, 2), {0, 16}, ways);
    EXPECT_EQ(r.counts.nan, 0u);
    EXPECT_EQ(r.counts.ended[SUN_ENDED_ESCAPED], r.counts.paths);
    EXPECT_EQ(r.counts.bounce_rays, 0u);
  }
  for (const bool floor : {false, true}) {
    Scene down;
    add(down, quad({0, 1, 0}, {0, 0, 1}, {0, 1, 0}), matt({0.5f, 0.5f, 0.5f}));
    add(down, quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}), matt({0.5f, 0.5f, 0.5f}));
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = {0, -1, 0};
    sun.intensity = {1, 1, 1};
    down.lights.push_back(sun);
    if (floor)
      add_camera(down, {0.5f, 0.6f, 0}, {0.02f, 0, 0}, 1);
    else
      add_camera(down, {2, 1, 0}, {0, 1, 0}, 20);
    RenderSettings s = picture(8, 8, 1);
    s.filter = box_filter();
    const Film film = render(Case(std::move(down)), s, {0, 4}).film;
    for (int y = 0; y < 8; y++)
      for (int x = 0; x < 8; x++) EXPECT_NEAR(mean(film, "beauty", {x, y, x + 1, y + 1}, 0), floor ? 0.5 / M_PI : 0, 1e-6) << (floor ? "floor" : "wall") << ", pixel " << x << ", " << y;
  }
}

// A lamp that stands on the floor, a box of lamps that stands there with a side in the floor's own plane, and one from wall to wall: shadow rays, chance, and both
// from the lamp's side give one picture.
TEST(Geometry, LampsThatTouchSurfaces) {
  for (int kind = 0; kind < 3; kind++) {
    Scene scene;
    if (kind == 0) add(scene, quad({0, 0.25f, -0.2f}, {0.4f, 0, 0}, {0, 0.25f, 0}), lamp({3, 4, 5}));
    if (kind == 1) add(scene, box({-0.2f, 0, -0.4f}, {0.2f, 0.3f, -0.1f}), lamp({3, 4, 5}));
    if (kind == 2) add(scene, quad({0, 1.4f, -0.75f}, {1, 0, 0}, {0, 0, 0.25f}), lamp({3, 4, 5}));
    add(scene, box({-1, 0, -1}, {1, 1.6f, 1}, true), matt({0.7f, 0.6f, 0.5f}));
    add_camera(scene, {0, 0.8f, 0.95f}, {0, 0.6f, 0}, 80);
    const Case room(std::move(scene));
    RenderSettings s = picture(16, 16, 2);
    s.filter = box_filter();
    const std::vector<Film> path = render_seeds(room, s, 32, 16);
    EXPECT_GT(moments(means(path, "bounce.1", whole(path[0]), 0)).mean, 0.05) << "the room is lit";
    for (const char *integrator : {"pure", "bdpt"}) {
      s.integrator = integrator;
      const std::vector<Film> other = render_seeds(room, s, s.integrator == "pure" ? 128 : 16, 16);
      const Agreement a = agreement(path, other, bounces(0, 2), 4, 1e-8);
      EXPECT_EQ(a.rejected, 0u) << integrator << ", lamp " << kind << ": " << a.what;
    }
  }
}

// What is baked and what is an instance look the same.
TEST(Geometry, InstancesAreWhereTheyArePlaced) {
  const glm::mat4x3 transform = [] {
    glm::mat4x3 m(0);
    m[0] = {0.8f, 0.3f, 0.1f};
    m[1] = {-0.2f, 0.9f, 0.2f};
    m[2] = {0.1f, -0.4f, 1.1f};
    m[3] = {0.4f, -0.1f, 0.3f};
    return m;
  }();
  std::vector<Film> films;
  for (const bool own : {false, true}) {
    Scene scene;
    const int mesh = add(scene, sphere({0, 0, 0}, 0.5f, 40), matt({0.5f, 0.6f, 0.7f}), transform);
    if (own) place(scene, mesh, scaled({1, 1, 1}, {300, 0, 0}));
    set_sky(scene, {1, 1, 1});
    add_camera(scene, {0, 0, 5}, {0, 0, 0}, 25);
    RenderSettings s = picture(32, 32, 0);
    s.layers.depth = s.layers.normal = s.layers.position = true;
    s.filter = box_filter();
    const Case made(std::move(scene));
    ASSERT_EQ((made.flat(Layout::binary).instances[0].flags & SUN_INSTANCE_IDENTITY) == 0, own);
    films.push_back(render(made, s, {0, 4}).film);
  }
  for (int y = 0; y < 32; y++)
    for (int x = 0; x < 32; x++)
      for (const char *layer : {"Z", "normal", "position"})
        for (int c = 0; c < 3; c++) {
          const Window pixel{x, y, x + 1, y + 1};
          const double coverage = std::abs(mean(films[0], "bounce.0", pixel, 0) - mean(films[1], "bounce.0", pixel, 0));
          if (coverage == 0) { EXPECT_NEAR(mean(films[0], layer, pixel, c), mean(films[1], layer, pixel, c), 2e-3) << layer << " at " << x << ", " << y; }
        }
}

}  // namespace sunstone::test
