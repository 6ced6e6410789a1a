// SPDX-License-Identifier: Apache-2.0
// Pictures of analytic shapes: closed forms, the lamps among them, and one hash whatever the ways.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "base/error.h"
#include "scene/validate.h"
#include "support/agree.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace sunstone::test {
namespace {

using Kind = Shape::Kind;

glm::mat4x3 turned(glm::vec3 scale, float angle, glm::vec3 at) {  // about z
  const float c = std::cos(angle), s = std::sin(angle);
  return {scale.x * glm::vec3(c, s, 0), scale.y * glm::vec3(-s, c, 0), glm::vec3(0, 0, scale.z), at};
}

// All kinds, some with pictures on them, a mesh, and lamps of three kinds.
Scene many_shapes() {
  Scene scene;
  Material checkered = matt({0.9f, 0.8f, 0.7f});
  checkered.base_color_texture = use_picture(scene, pattern(4, 4, 3, 1), false);
  add_shape(scene, Kind::plane, checkered, scaled({1, 1, 1}, {0, -1, 0}));
  add_shape(scene, Kind::sphere, glass({0.1f, 0.2f, 0.3f}), scaled({0.7f, 0.7f, 0.7f}, {-0.8f, 0, 0.4f}));
  add_shape(scene, Kind::sphere, metal({0.9f, 0.8f, 0.6f}, 0.0f), scaled({0.6f, 0.5f, 0.6f}, {0.7f, -0.3f, 0}));
  Material globe = matt({1, 1, 1});
  globe.base_color_texture = use_picture(scene, pattern(8, 4, 3, 2));
  globe.alpha_mode = AlphaMode::blend;
  globe.alpha = 0.7f;
  add_shape(scene, Kind::sphere, globe, scaled({0.3f, 0.3f, -0.3f}, {0.1f, 0.5f, 0.9f}));
  add_shape(scene, Kind::disk, thin_glass({0.6f, 0.9f, 0.7f}), turned({0.5f, 0.5f, 0.5f}, 1.3f, {1.6f, 0.2f, 0.6f}));
  add_shape(scene, Kind::quad, matt({0.8f, 0.3f, 0.2f}), turned({1, 1, 1}, -1.4f, {-2, 0.3f, -0.5f}));
  Material picture_lamp = lamp({3, 3, 3});
  picture_lamp.emission_texture = use_picture(scene, pattern(4, 2, 3, 3));
  add_shape(scene, Kind::sphere, picture_lamp, scaled({0.25f, 0.25f, 0.25f}, {-1.2f, 1.6f, -0.6f}));
  add_shape(scene, Kind::disk, lamp({4, 3, 2}), turned({0.4f, 0.4f, 0.4f}, 3.14159265f, {1, 2, 0}));
  Material both = lamp({2, 2, 4});
  both.double_sided = true;
  add_shape(scene, Kind::quad, both, turned({0.3f, 1, 0.2f}, 0.6f, {0, 1.6f, -1}));
  add(scene, box({-0.3f, -1, -1.5f}, {0.3f, -0.4f, -0.9f}), matt({0.3f, 0.5f, 0.8f}));
  set_sky_map(scene, sky_map(16, 8, {4, 3.5f, 3}));
  add_camera(scene, {0, 0.6f, 4}, {0, 0.1f, 0}, 45);
  return scene;
}

}  // namespace

TEST(Shapes, OneHashWhateverTheWays) {
  const Case made(many_shapes());
  const FlatScene &flat = made.flat(Layout::binary);
  ASSERT_TRUE(flat.has_passable && flat.has_textures && flat.plane_count == 1 && flat.shape_count == 9);
  RenderSettings s = picture(40, 32, 6);
  s.layers.albedo = s.layers.normal = s.layers.depth = s.layers.position = s.layers.object = s.layers.material = s.layers.alpha = true;
  for (const char *integrator : {"path", "hybrid", "pure"}) {
    s.integrator = integrator;
    const Film reference = render(made, s, {0, 4}).film;
    EXPECT_EQ(reference.nan, 0u);
    EXPECT_GT(mean(reference, "beauty", whole(reference), 1), 0.1);
    for (const auto &[how, ways] : other_ways()) EXPECT_EQ(film_hash(render(made, s, {0, 4}, ways).film).hex(), film_hash(reference).hex()) << integrator << ", " << how;
  }
}

// Scenes without shapes run without their code, and with it: the same picture.
TEST(Shapes, WithoutThemTheirCodeChangesNothing) {
  const Case made(everything());
  const RenderSettings s = picture(32, 24, 5);
  Ways trimmed;
  trimmed.trimmed = true;
  EXPECT_EQ(film_hash(render(made, s, {0, 4}).film), film_hash(render(made, s, {0, 4}, trimmed).film));
}

// A white sphere in a white furnace cannot be seen: radiance 1 everywhere, whatever its shape, beside a plane that reflects half.
TEST(Shapes, AWhiteSphereInAWhiteFurnace) {
  for (const glm::vec3 scale : {glm::vec3(1, 1, 1), glm::vec3(0.5f, 1.2f, 0.8f), glm::vec3(-1, 1, 1)}) {
    Scene scene;
    add_shape(scene, Kind::sphere, matt({1, 1, 1}), turned(scale, 0.5f, {0.2f, -0.1f, 0}));
    set_sky(scene, {1, 1, 1});
    add_camera(scene, {0, 0, 5}, {0, 0, 0}, 40);
    const Case made(std::move(scene));
    RenderSettings s = picture(16, 16, 4);
    const std::vector<Film> films = render_seeds(made, s, 64, 16);
    EXPECT_EQ(differs(films, "beauty", whole(films[0]), {1, 1, 1}), "");
    EXPECT_GT(mean(films[0], "bounce.1", whole(films[0]), 0), 0.1) << "the sphere is not in the picture";
  }
}

// Within a solid of index n radiance is n^2 times that outside. Seen from within a ball of glass, off its centre but where nothing is totally reflected.
TEST(Shapes, CameraInsideAGlassBall) {
  Scene scene;
  add_shape(scene, Kind::sphere, glass({0, 0, 0}), scaled({2, 2, 2}, {0, 0, 0}));
  set_sky(scene, {1, 0.5f, 0.25f});
  add_camera(scene, {0.4f, 0.3f, -0.2f}, {2, 1, -3}, 100);
  const Case made(std::move(scene));
  const std::vector<Film> films = render_seeds(made, picture(16, 16, 16), 64, 16);
  EXPECT_EQ(differs(films, "beauty", whole(films[0]), glm::vec3(2.25f) * glm::vec3(1, 0.5f, 0.25f), 1e-4), "");
}

// Lamps above a matt floor, seen from straight below at distance h: the share of the half space that each takes, by the cosine. A sphere of radius r takes (r / h)^2 to its
// centre, a disk r^2 / (r^2 + h^2), a rectangle four times what a corner of it takes. By shadow rays and by chance.
TEST(Shapes, LampsOverAPlane) {
  constexpr float r = 0.6f, a = 0.5f, b = 0.8f;  // h is 1
  const auto corner = [](double x, double y) { return x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)); };
  const std::tuple<Kind, glm::vec3, double> lamps[] = {{Kind::sphere, {r, r, r}, r * r}, {Kind::disk, {r, r, r}, r * r / (r * r + 1)},
                                                       {Kind::quad, {a, 1, b}, 2 / M_PI * (corner(a, b) + corner(b, a))}};
  for (const auto &[kind, scale, share] : lamps)
    for (const char *integrator : {"path", "hybrid", "pure", "bdpt"}) {
      Scene scene;
      add_shape(scene, Kind::plane, matt({0.5f, 0.5f, 0.5f}), glm::mat4x3(1));
      add_shape(scene, kind, lamp({4, 2, 1}), turned(scale, static_cast<float>(M_PI), {0, 1, 0}));
      add_camera(scene, {0.002f, 0.35f, 0}, {0.002f, 0, 0.001f}, 0.5f);
      const Case made(std::move(scene));
      RenderSettings s = picture(4, 4, 1);
      s.integrator = integrator;
      s.filter = box_filter();
      const std::vector<Film> films = render_seeds(made, s, 512, 64);
      EXPECT_EQ(differs(films, "bounce.1", whole(films[0]), glm::vec3(0.5f * static_cast<float>(share)) * glm::vec3(4, 2, 1), 1e-3), "") << integrator << ", shape " << static_cast<int>(kind);
      const Moments m = moments(means(films, "bounce.1", whole(films[0]), 1));
      EXPECT_LT(interval(m, 1e-9), 0.04 * m.mean) << integrator << ", shape " << static_cast<int>(kind) << " is too noisy to tell";
    }
}

// Shapes of one side are passed from behind by eyes, so light passes them from the front and is stopped behind: a ball casts its shadow by light subpaths as it does by shadow
// rays, and so do a disk and a quad whose fronts are towards the floor.
TEST(Shapes, OfOneSideCastShadowsOfLight) {
  Scene scene;
  add_shape(scene, Kind::plane, matt({0.7f, 0.6f, 0.5f}), glm::mat4x3(1));
  Material one_sided = matt({0.2f, 0.4f, 0.6f});
  one_sided.double_sided = false;
  add_shape(scene, Kind::sphere, one_sided, scaled({0.4f, 0.4f, 0.4f}, {0.2f, 0.4f, 0.1f}));
  add_shape(scene, Kind::disk, one_sided, turned({0.3f, 0.3f, 0.3f}, 3.14159265f, {-0.6f, 0.3f, -0.2f}));
  add_shape(scene, Kind::quad, one_sided, turned({0.3f, 0.3f, 0.3f}, 3.14159265f, {-0.4f, 0.2f, 0.6f}));
  add_shape(scene, Kind::quad, lamp({20, 18, 16}), turned({0.2f, 0.2f, 0.2f}, 3.14159265f, {0, 2, 0}));
  add_camera(scene, {0, 1.9f, 2.2f}, {-0.1f, 0, 0.1f}, 40);
  const Case made(std::move(scene));
  RenderSettings s = picture(24, 16, 3);
  const std::vector<Film> reference = render_seeds(made, s, 64, 24);
  s.integrator = "bdpt";
  const Agreement weighted = agreement(reference, render_seeds(made, s, 48, 24), bounces(0, 3), 8, 1e-8);
  EXPECT_EQ(weighted.rejected, 0u) << "of " << weighted.means << " means:" << weighted.what;
  s.strategy_s = 2, s.strategy_t = 1, s.unweighted = true;  // what light subpaths alone make of direct light
  const Agreement alone = agreement(reference, render_seeds(made, s, 96, 24), {"bounce.1"}, 4, 1e-8);
  EXPECT_EQ(alone.rejected, 0u) << "of " << alone.means << " means:" << alone.what;
}

// Shadow rays leave a plane and reach a lamp that touches it; a far plane that the camera grazes casts no shadow on itself.
TEST(Shapes, NoSurfaceShadowsItself) {
  Scene scene;
  add_shape(scene, Kind::plane, matt({1, 1, 1}), turned({1, 1, 1}, 0.3f, {1000, -300, 77}));
  add_shape(scene, Kind::sphere, matt({1, 1, 1}), scaled({3, 3, 3}, {0, 40, 900}));
  set_sky(scene, {1, 1, 1});
  add_camera(scene, {-200, 20, 1000}, {0, 10, 0}, 60);
  const Case made(std::move(scene));
  RenderSettings s = picture(16, 16, 8);
  const std::vector<Film> films = render_seeds(made, s, 64, 16);
  EXPECT_EQ(differs(films, "beauty", whole(films[0]), {1, 1, 1}, 1e-3), "") << "white under a white sky is white";
}

TEST(Shapes, AnInfinitePlaneCannotShine) {
  Scene scene;
  add_shape(scene, Kind::plane, lamp({1, 1, 1}), glm::mat4x3(1));
  Notices notices;
  try {
    validate(scene, "test", notices);
    FAIL() << "it was let through";
  } catch (const Error &error) {
    EXPECT_NE(std::string(error.what()).find("infinite plane cannot emit"), std::string::npos) << error.what();
  }
}

TEST(Shapes, BadOnesAreDropped) {
  Scene scene;
  add_shape(scene, Kind::sphere, matt({1, 1, 1}), scaled({1, 0, 1}, {0, 0, 0}));
  add_shape(scene, Kind::sphere, matt({1, 1, 1}), scaled({1, NAN, 1}, {0, 0, 0}));
  add_shape(scene, Kind::disk, matt({1, 1, 1}), scaled({1e-12f, 1e-12f, 1e-12f}, {0, 0, 0}));
  add_shape(scene, Kind::quad, matt({1, 1, 1}), scaled({1, 1, 1}, {0, 0, 0}));
  Notices notices;
  validate(scene, "test", notices);
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(scene.shapes[0].kind, Kind::quad);
  EXPECT_EQ(notices.all().size(), 1u);
}

}  // namespace sunstone::test
