// SPDX-License-Identifier: Apache-2.0
// Bidirectional path tracing estimates what path tracing does: with all its strategies together, over every kind of light, surface and camera, and with each of
// them alone and unweighted. All tests of this file together are Holm-corrected to a false alarm in 10^6 runs.
#include <gtest/gtest.h>

#include <cmath>

#include "support/agree.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace sunstone::test {
namespace {

constexpr double false_alarms = 1e-6 / 60;  // of one comparison: there are fewer than 60
constexpr std::uint32_t seeds = 40;

struct Work {
  std::uint64_t path_samples, bdpt_samples;
  int block = 8;
  double noise = 0.01;  // relative standard error of the first bounce, at most: else the test could not tell 5 per cent
};

void expect_agreement(const Case &scene, RenderSettings settings, const Work &work, const std::string &integrator = "path") {
  settings.integrator = integrator;
  const std::vector<Film> reference = render_seeds(scene, settings, work.path_samples, seeds);
  settings.integrator = "bdpt";
  const std::vector<Film> films = render_seeds(scene, settings, work.bdpt_samples, seeds);
  const Agreement agree = agreement(reference, films, bounces(0, settings.max_depth), work.block, false_alarms);
  EXPECT_EQ(agree.rejected, 0u) << "of " << agree.means << " means:" << agree.what;
  EXPECT_LT(relative_error(reference, "bounce.1"), work.noise) << integrator << " is too noisy to tell";
  EXPECT_LT(relative_error(films, "bounce.1"), work.noise) << "bdpt is too noisy to tell";
  for (const Film &film : films) ASSERT_EQ(film.nan, 0u);
}

// One strategy alone and unweighted holds all light of its bounce: against `reference`, films of path.
void expect_alone(const Case &scene, RenderSettings settings, const std::vector<Film> &reference, unsigned s, unsigned t, std::uint64_t samples, double noise = 0.008, int block = 8) {
  settings.integrator = "bdpt";
  settings.unweighted = true;
  settings.strategy_s = s;
  settings.strategy_t = t;
  SCOPED_TRACE("strategy " + std::to_string(s) + "," + std::to_string(t));
  const std::vector<Film> films = render_seeds(scene, settings, samples, seeds);
  const std::string layer = "bounce." + std::to_string(s + t - 2);
  const Agreement agree = agreement(reference, films, {layer}, block, false_alarms);
  EXPECT_EQ(agree.rejected, 0u) << "of " << agree.means << " means:" << agree.what;
  EXPECT_LT(relative_error(films, layer), noise) << "is too noisy to tell";
  for (unsigned depth = 0; depth <= settings.max_depth; depth++)
    EXPECT_EQ(mean(films[0], "bounce." + std::to_string(depth), whole(films[0]), 1) != 0.0, depth == s + t - 2) << "bounce " << depth;
}

// A floor, a wall, a matt box and a glossy ball.
Scene still_life() {
  Scene scene;
  add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}), matt({0.7f, 0.5f, 0.3f}));
  add(scene, quad({0, 1.5f, -2}, {2, 0, 0}, {0, 1.5f, 0}), matt({0.4f, 0.6f, 0.8f}));
  add(scene, box({-1.3f, 0.01f, -0.9f}, {-0.5f, 0.9f, -0.1f}), matt({0.6f, 0.6f, 0.6f}));
  add(scene, sphere({0.7f, 0.5f, 0}, 0.49f, 12), metal({0.9f, 0.7f, 0.5f}, 0.5f));
  add_camera(scene, {0.3f, 1.4f, 4}, {0, 0.6f, 0}, 40);
  return scene;
}

}  // namespace

TEST(Bdpt, CornellBox) { expect_agreement(Case::file(scene_file("cornell/cornell.gltf")), picture(32, 32, 4), {16, 16}); }

TEST(Bdpt, MattRoomAgainstPathAndPure) {
  expect_agreement(Case(matt_room()), picture(24, 24, 4), {16, 16});
  expect_agreement(Case(matt_room()), picture(24, 24, 4), {48, 16}, "pure");
}

// Glass, rough glass, thin glass, alpha of both kinds, textures and normal maps, instances (one mirrored), and every kind of light at once.
TEST(Bdpt, Everything) { expect_agreement(Case(everything()), picture(24, 16, 4), {64, 64}); }

TEST(Bdpt, PointLight) {
  Scene scene = still_life();
  add_point_light(scene, {-1, 2, 1.5f}, {6, 5, 4});
  expect_agreement(Case(std::move(scene)), picture(24, 16, 3), {24, 24});
}

TEST(Bdpt, SpotLight) {
  Scene scene = still_life();
  scene.lights.push_back(spot_light());
  expect_agreement(Case(std::move(scene)), picture(24, 16, 3), {24, 24});
}

TEST(Bdpt, DirectionalLight) {
  Scene scene = still_life();
  scene.lights.push_back(sun_light());
  expect_agreement(Case(std::move(scene)), picture(24, 16, 3), {24, 24});
}

TEST(Bdpt, ConstantSky) {
  Scene scene = still_life();
  set_sky(scene, {0.8f, 0.9f, 1});
  expect_agreement(Case(std::move(scene)), picture(24, 16, 3), {24, 24});
}

TEST(Bdpt, SkyMap) {
  Scene scene = still_life();
  set_sky_map(scene, sky_map(16, 8, {20, 18, 15}));
  scene.environment.rotation = 0.2f;
  expect_agreement(Case(std::move(scene)), picture(24, 16, 3), {48, 48});
}

TEST(Bdpt, ThinLens) {
  Scene scene = still_life();
  add_point_light(scene, {-1, 2, 1.5f}, {6, 5, 4});
  add(scene, quad({0, 2.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}), lamp({3, 4, 5}));
  scene.cameras[0].lens_radius = 0.2f;
  scene.cameras[0].focus_distance = 3.2f;
  expect_agreement(Case(std::move(scene)), picture(24, 16, 3), {32, 32});
}

TEST(Bdpt, OrthographicCamera) {
  Scene scene = still_life();
  scene.lights.push_back(sun_light());
  add(scene, quad({0, 2.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}), lamp({3, 4, 5}));
  scene.cameras.clear();
  add_flat_camera(scene, {0, 1, 5}, 1.3f);
  expect_agreement(Case(std::move(scene)), picture(24, 24, 3), {24, 24});
}

// Filters that overlap pixels, and one that is negative at its edge: a splat counts where a camera ray would.
TEST(Bdpt, EveryFilter) {
  Scene scene = still_life();
  add_point_light(scene, {-1, 2, 1.5f}, {6, 5, 4});
  const Case made(std::move(scene));
  for (const char *name : {"box", "tent", "gaussian", "mitchell"}) {
    SCOPED_TRACE(name);
    RenderSettings s = picture(12, 8, 1);
    s.filter = filter_from_name(name);
    expect_alone(made, s, render_seeds(made, s, 128, seeds), 2, 1, 192, 0.008, 2);
  }
}

// Curved surfaces of few triangles, a normal map, and a mirror that bends by smooth normals: what light does has to be asked in the eye's order.
TEST(Bdpt, ShadingNormals) {
  Scene scene;
  Material floor = matt({0.7f, 0.6f, 0.5f});
  floor.normal_texture = use_picture(scene, bumps(8, 8));
  floor.normal_texture.transform = glm::mat3x2(4, 0, 0, 4, 0, 0);
  add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}), floor);
  add(scene, sphere({-0.8f, 0.6f, 0}, 0.6f, 4), matt({0.5f, 0.7f, 0.4f}));
  add(scene, sphere({0.8f, 0.6f, 0}, 0.6f, 5), metal({0.9f, 0.8f, 0.7f}, 0.4f));
  add(scene, quad({0, 2.2f, 0.5f}, {0.7f, 0, 0}, {0, 0, 0.7f}), lamp({4, 4, 4}));
  add_camera(scene, {0, 1.2f, 4}, {0, 0.5f, 0}, 38);
  expect_agreement(Case(std::move(scene)), picture(24, 16, 3), {32, 32});
}

// A solid that absorbs, smooth and rough, with a lamp and an object within: on light's way each segment takes what the eye would find on its own.
TEST(Bdpt, SolidsThatAbsorb) {
  Scene scene;
  add(scene, box({-2, 0, -2}, {2, 2.5f, 2}, true), matt({0.7f, 0.7f, 0.7f}));
  add(scene, sphere({-0.7f, 0.7f, 0}, 0.6f, 12), glass({0.3f, 1.0f, 2.0f}, 0.5f));
  add(scene, sphere({-0.7f, 0.7f, 0}, 0.2f, 8), matt({0.8f, 0.8f, 0.8f}));
  add(scene, sphere({0.8f, 0.7f, 0}, 0.6f, 12), glass({1.0f, 0.3f, 0.2f}));
  add(scene, sphere({0.8f, 0.7f, 0}, 0.2f, 8), matt({0.8f, 0.8f, 0.8f}));
  add(scene, quad({0, 2.4f, 0}, {1.2f, 0, 0}, {0, 0, 1.2f}), lamp({2, 2, 2}));
  add_camera(scene, {0, 1.2f, 1.9f}, {0, 0.7f, 0}, 70);
  expect_agreement(Case(std::move(scene)), picture(24, 16, 5), {64, 64});
}

// Eye and floor within a block of glass, a lamp there and one outside: light that was bent once is met by either walk.
TEST(Bdpt, WithinGlass) {
  Scene scene;
  add(scene, box({-2, -0.5f, -2}, {2, 1, 2}), glass({0, 0, 0}));
  add(scene, quad({0, 0, 0}, {1.5f, 0, 0}, {0, 0, -1.5f}), matt({0.7f, 0.6f, 0.5f}));
  add(scene, quad({0, 0.9f, -0.8f}, {0.3f, 0, 0}, {0, 0, 0.3f}), lamp({1, 1, 1}));
  add(scene, quad({0, 1.3f, 0}, {1.5f, 0, 0}, {0, 0, 1.5f}), lamp({2, 3, 4}));
  add_camera(scene, {0, 0.8f, 1.4f}, {0, 0, -0.2f}, 50);
  expect_agreement(Case(std::move(scene)), picture(16, 12, 3), {96, 64}, "path");
}

// Triangles of one side: the eye looks into the room from behind its wall, the sky does not shine through it, and what stands behind the wall is lit from within.
TEST(Bdpt, SurfacesOfOneSide) {
  Scene scene = room_of_one_side();
  Material wall = matt({0.7f, 0.6f, 0.5f});
  wall.double_sided = false;
  add(scene, quad({0, 0.5f, 1.3f}, {0.4f, 0, 0}, {0, 0.3f, 0}), wall);
  set_sky(scene, {0.2f, 0.2f, 0.3f});
  add_camera(scene, {0.5f, 1.1f, 4}, {0, 0.6f, 0}, 42);
  expect_agreement(Case(std::move(scene)), picture(24, 16, 3), {48, 96});
}

// Panes that are half matt and half clear: a walk goes straight on through many at one depth, more often than a slot has room for vertices.
TEST(Bdpt, PanesThatScatterAndPass) {
  Scene scene;
  add(scene, quad({0, 0, -2}, {3, 0, 0}, {0, 3, 0}), matt({0.7f, 0.6f, 0.5f}));
  Material pane = thin_glass({0.9f, 0.95f, 0.9f});
  pane.transmission = 0.6f;
  for (int i = 0; i < 8; i++) add(scene, quad({0, 0, 0.3f * static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0}), pane);
  add(scene, quad({0.5f, 1.4f, 3}, {-0.6f, 0, 0}, {0, 0.4f, -0.4f}), lamp({4, 5, 6}));
  add_camera(scene, {0.8f, 0.5f, 4}, {0, 0, 0}, 40);
  expect_agreement(Case(std::move(scene)), picture(24, 16, 2), {64, 96});
}

TEST(Bdpt, BalanceHeuristic) {
  const Case made(matt_room());
  RenderSettings s = picture(24, 24, 3);
  const std::vector<Film> power = [&] {
    s.integrator = "bdpt";
    return render_seeds(made, s, 16, seeds);
  }();
  s.balance = true;
  const std::vector<Film> balance = render_seeds(made, s, 16, seeds);
  const Agreement agree = agreement(power, balance, bounces(0, 3), 8, false_alarms);
  EXPECT_EQ(agree.rejected, 0u) << agree.what;
  EXPECT_NE(film_hash(power[0]), film_hash(balance[0]));
}

// Each strategy by itself, unweighted, finds all light of its bounce: in a room where none is blind.
TEST(Bdpt, EachStrategyAlone) {
  const Case made(matt_room());
  const RenderSettings s = picture(16, 16, 2);
  const std::vector<Film> reference = render_seeds(made, s, 128, seeds);
  for (unsigned depth = 1; depth <= 2; depth++)
    for (unsigned from_light = 0; from_light <= depth + 1; from_light++) expect_alone(made, s, reference, from_light, depth + 2 - from_light, 96, 0.01);
}

// The light subpath's half alone, unweighted, of every kind of light: what it emits, and where, has to be all there is. (Of a sky map the dim half is left to
// chance [Karlik19].)
TEST(Bdpt, EachLightAlone) {
  const std::pair<const char *, void (*)(Scene &)> lights[] = {
      {"point", [](Scene &s) { add_point_light(s, {-1, 2, 1.5f}, {6, 5, 4}); }},
      {"spot", [](Scene &s) { s.lights.push_back(spot_light()); }},
      {"sun", [](Scene &s) { s.lights.push_back(sun_light()); }},
      {"constant sky", [](Scene &s) { set_sky(s, {0.8f, 0.9f, 1}); }},
      {"lamp of two sides", [](Scene &s) {
         Material both = lamp({2, 3, 4});
         both.double_sided = true;
         add(s, quad({0.2f, 1.6f, 0.3f}, {0.4f, 0, 0}, {0, 0.3f, 0.3f}), both);
       }}};
  for (const auto &[name, shine] : lights) {
    SCOPED_TRACE(name);
    Scene scene = still_life();
    shine(scene);
    const Case made(std::move(scene));
    const RenderSettings s = picture(16, 12, 2);
    const std::vector<Film> reference = render_seeds(made, s, 96, seeds);
    expect_alone(made, s, reference, 2, 1, 192);
    expect_alone(made, s, reference, 2, 2, 64, 0.05);
  }
}

// And by every camera.
TEST(Bdpt, EachCameraAlone) {
  for (const bool flat : {false, true}) {
    SCOPED_TRACE(flat ? "orthographic" : "thin lens");
    Scene scene = still_life();
    add(scene, quad({0, 2.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}), lamp({3, 4, 5}));
    if (flat) {
      scene.cameras.clear();
      add_flat_camera(scene, {0, 1, 5}, 1.3f);
    } else {
      scene.cameras[0].lens_radius = 0.2f;
      scene.cameras[0].focus_distance = 3.2f;
    }
    const Case made(std::move(scene));
    const RenderSettings s = picture(16, 12, 1);
    expect_alone(made, s, render_seeds(made, s, 96, seeds), 2, 1, 96);
  }
}

// The weighted strategies one by one add up to the whole, in integers.
TEST(Bdpt, StrategiesAddUp) {
  const Case made(everything());
  RenderSettings s = picture(16, 12, 3);
  s.integrator = "bdpt";
  const Film all = render(made, s, {0, 2}).film;
  std::vector<std::int64_t> sum(all.layers[0].values.size());
  int strategies = 0;
  for (unsigned depth = 0; depth <= 3; depth++)
    for (unsigned from_light = 0; from_light <= depth + 1; from_light++) {
      if (depth == 0 && from_light == 1) continue;
      s.strategy_s = from_light;
      s.strategy_t = depth + 2 - from_light;
      const Film one = render(made, s, {0, 2}).film;
      for (const std::size_t half : {0u, 1u})
        for (std::size_t i = 0; i < sum.size(); i++) sum[i] += one.layers[half].values[i];
      strategies++;
    }
  EXPECT_EQ(strategies, 13);
  std::size_t different = 0;
  for (std::size_t i = 0; i < sum.size(); i++) different += sum[i] != all.layers[0].values[i] + all.layers[1].values[i];
  EXPECT_EQ(different, 0u);
}

// A closed room that shines everywhere, by closed form: bounce k is albedo^k.
TEST(Bdpt, Furnace) {
  RenderSettings s = picture(16, 16, 5);
  s.integrator = "bdpt";
  const std::vector<Film> films = render_seeds(Case::file(scene_file("furnace/furnace.gltf")), s, 32, seeds);
  for (int depth = 0; depth <= 5; depth++) {
    const float k = static_cast<float>(depth);
    EXPECT_EQ(differs(films, "bounce." + std::to_string(depth), whole(films[0]), {std::pow(0.5f, k), std::pow(0.25f, k), std::pow(0.75f, k)}, 1e-4), "");
    EXPECT_LT(relative_error(films, "bounce." + std::to_string(depth)), 0.01);
  }
}

// Walls that shine and absorb nothing, matt, coated, rough and mirroring: each bounce is 1, whichever way a path was found. Paths turn at deltas whose chances differ
// from either side.
TEST(Bdpt, WhiteFurnace) {
  Scene scene;
  Material coat = matt({1, 1, 1});
  coat.f0 = glm::vec3(0.3f);
  coat.f90 = 1;
  coat.roughness = 0;
  Material satin = coat;
  satin.roughness = 0.5f;
  const Material kinds[6] = {matt({1, 1, 1}), coat, metal({1, 1, 1}, 0), satin, metal({1, 1, 1}, 0.6f), coat};
  for (int face = 0; face < 6; face++) {
    Material wall = kinds[face];
    wall.emission = {1, 1, 1};
    wall.double_sided = false;
    glm::vec3 out(0), a(0), b(0);
    const int axis = face / 2;
    out[axis] = face % 2 ? 1.0f : -1.0f;
    a[(axis + 1) % 3] = 1;
    b[(axis + 2) % 3] = 1;
    add(scene, face % 2 ? quad(out, b, a) : quad(out, a, b), wall);
  }
  add_camera(scene, {0.2f, 0.1f, 0.3f}, {-1, -0.3f, -1}, 80);
  RenderSettings s = picture(16, 16, 4);
  s.integrator = "bdpt";
  const std::vector<Film> films = render_seeds(Case(std::move(scene)), s, 48, seeds);
  for (const std::string &layer : bounces(0, 4)) {
    EXPECT_EQ(differs(films, layer, whole(films[0]), {1, 1, 1}, 1e-3), "");
    EXPECT_LT(relative_error(films, layer), 0.002) << layer;
  }
}

TEST(Bdpt, CountsItsPaths) {
  RenderSettings s = picture(37, 23, 5);
  s.integrator = "bdpt";
  const RenderCounts counts = render(Case(everything()), s, {0, 3}).counts;
  EXPECT_EQ(counts.paths, 37u * 23u * 3u);
  EXPECT_EQ(counts.ended[0] + counts.ended[1] + counts.ended[2] + counts.ended[3], counts.paths);
  EXPECT_GE(counts.camera_rays, 2 * counts.paths) << "each sample sends a ray from the camera and one from a light";
  EXPECT_GT(counts.shadow_rays, counts.paths / 2);
  EXPECT_EQ(counts.nan + counts.clamped, 0u);
}

TEST(Bdpt, RefusesWhatItCannotDo) {
  const Case made(matt_room());
  const auto refused = [&](const char *what, auto &&change) {
    RenderSettings s = picture(16, 16, 3);
    s.integrator = "bdpt";
    change(s);
    EXPECT_NE(refusal(made, s).find(what), std::string::npos) << what;
  };
  refused("--crop", [](RenderSettings &s) { s.x1 = 8; });
  refused("--max-depth", [](RenderSettings &s) { s.max_depth = 65; });
  refused("--strategy", [](RenderSettings &s) { s.strategy_s = 4, s.strategy_t = 2; });
  refused("--strategy", [](RenderSettings &s) { s.strategy_s = 1, s.strategy_t = 1; });
  refused("--unweighted", [](RenderSettings &s) { s.unweighted = true; });
  refused("--light-samples", [](RenderSettings &s) { s.light_samples = 2; });
  refused("--strategy", [](RenderSettings &s) { s.integrator = "path", s.strategy_t = 2; });
}

// The eye within rough glass that absorbs: what light paths send from the glass' inner side to the lens, or to another place there, is absorbed on that way, as the eye's ray is.
TEST(Bdpt, EyeWithinGlassThatAbsorbs) {
  Scene scene;
  add(scene, box({-1, -1, -1}, {1, 1, 1}), glass({0.3f, 0.6f, 0.1f}, 0.6f));
  add(scene, quad({0, 0, -2}, {1.5f, 0, 0}, {0, 1.5f, 0}), lamp({2, 3, 4}));
  add_camera(scene, {0, 0, 0.6f}, {0, 0, -1}, 50);
  const Case made(std::move(scene));
  const RenderSettings s = picture(16, 16, 2);
  const std::vector<Film> reference = render_seeds(made, s, 128, seeds);
  expect_alone(made, s, reference, 2, 1, 256, 0.01);
  expect_alone(made, s, reference, 2, 2, 128, 0.03);
}

// Stripes on the edges of pixels, where a filter that is negative at its end takes more than in the middle: light that falls there counts as camera rays from there do.
TEST(Bdpt, StripesOnTheEdgesOfPixels) {
  Scene scene;
  Image stripes;
  stripes.name = "stripes";
  stripes.width = 80;
  stripes.height = 1;
  stripes.channels = 3;
  std::vector<std::uint8_t> bytes;
  for (int x = 0; x < 80; x++) bytes.insert(bytes.end(), 3, x % 4 == 0 || x % 4 == 3 ? 255 : 0);
  stripes.pixels = std::move(bytes);
  Material wall = matt({0.8f, 0.8f, 0.8f});
  wall.base_color_texture = use_picture(scene, std::move(stripes), false);
  add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), wall);
  Light light = sun_light();
  light.direction = {0, 0, -1};
  scene.lights.push_back(light);
  add_flat_camera(scene, {0, 0, 2}, 0.8f);  // a pixel is four texels wide
  const Case made(std::move(scene));
  RenderSettings s = picture(16, 16, 1);
  s.filter = filter_from_name("mitchell");
  expect_alone(made, s, render_seeds(made, s, 64, seeds), 2, 1, 128, 0.004, 16);
}

// A mirror and a slab of glass whose smooth normals lean away from the true ones, so that light leaves a surface at another angle than it came: light
// paths alone, against what the eye finds through them.
TEST(Bdpt, SmoothNormalsThatBendDeltas) {
  const auto lean = [](Primitive p, int axis, glm::vec3 by) {  // faces across the axis, here more than there
    for (std::size_t i = 0; i < p.normals.size(); i++)
      if (p.normals[i][axis] != 0) p.normals[i] = glm::normalize(p.normals[i] + by + 0.1f * p.positions[i]);
    return p;
  };
  for (const bool mirror : {true, false}) {
    SCOPED_TRACE(mirror ? "mirror" : "glass");
    Scene scene;
    add(scene, quad({0, 0, 0}, {1.5f, 0, 0}, {0, 0, -1.5f}), matt({0.7f, 0.6f, 0.5f}));
    if (mirror) {
      add(scene, lean(quad({-1.5f, 1, 0}, {0, 0, -1}, {0, 1, 0}), 0, {0.15f, 0.2f, 0}), metal({0.9f, 0.8f, 0.7f}, 0));
      add(scene, quad({-0.5f, 2.6f, 0}, {0.7f, 0, 0}, {0, 0, 0.7f}), lamp({4, 4, 4}));
    } else {
      add(scene, lean(box({-1, 1.6f, -1}, {1, 1.8f, 1}), 1, {0.25f, 0, 0}), glass({0, 0, 0}));
      add(scene, quad({0, 2.4f, 0}, {0.6f, 0, 0}, {0, 0, 0.6f}), lamp({4, 4, 4}));
    }
    add_camera(scene, {0, 1.3f, 1.8f}, {0, 0, 0.1f}, 38);  // it sees the floor alone
    const Case made(std::move(scene));
    const RenderSettings s = picture(16, 16, 3);
    expect_alone(made, s, render_seeds(made, s, 96, seeds), mirror ? 3 : 4, 1, 96, 0.012);
  }
}

// A small bright square out of focus: it is drawn as wide as the lens, to the eye and to light paths, along both axes. The distance from the middle,
// squared, is on the mean a quarter of the blur's radius squared, what the square itself adds, and a twelfth of a pixel.
TEST(Bdpt, ALensIsAsWideToLightAsToTheEye) {
  constexpr int size = 24;
  constexpr double half = 0.15, distance = 4, focus = 1.5, lens = 0.5;
  const double pixel = 2 * std::tan(20 * M_PI / 180) / size;  // at a metre
  const double blur = lens * (1 / focus - 1 / distance) / pixel, square = half / distance / pixel;
  Scene scene;
  add(scene, quad({0, 0, 0}, {half, 0, 0}, {0, half, 0}), matt({0.8f, 0.8f, 0.8f}));
  Light light = sun_light();
  light.direction = {0, 0, -1};
  scene.lights.push_back(light);
  add_camera(scene, {0, 0, distance}, {0, 0, 0}, 40);
  scene.cameras[0].lens_radius = lens;
  scene.cameras[0].focus_distance = focus;
  const Case made(std::move(scene));
  RenderSettings s = picture(size, size, 1);
  s.filter = box_filter();
  for (const bool by_light : {false, true}) {
    if (by_light) s.integrator = "bdpt", s.strategy_s = 2, s.strategy_t = 1, s.unweighted = true;
    std::vector<double> wide, high;
    for (const Film &film : render_seeds(made, s, by_light ? 32 : 256, seeds)) {
      double all = 0, x2 = 0, y2 = 0;
      for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
          const double value = mean(film, "bounce.1", {x, y, x + 1, y + 1}, 1), dx = x + 0.5 - size / 2.0, dy = y + 0.5 - size / 2.0;
          all += value;
          x2 += value * dx * dx;
          y2 += value * dy * dy;
        }
      wide.push_back(x2 / all);
      high.push_back(y2 / all);
    }
    const double expected = blur * blur / 4 + square * square / 3 + 1.0 / 12;
    for (const auto &[axis, values] : {std::pair("across", &wide), std::pair("up", &high)}) {
      SCOPED_TRACE(std::string(by_light ? "light, " : "eye, ") + axis);
      const Moments m = moments(*values);
      EXPECT_NEAR(m.mean, expected, interval(m, 1e-9) + 2e-3 * expected);
      EXPECT_LT(interval(m, 1e-9), 0.04 * expected) << "is too noisy to tell";
    }
  }
}

}  // namespace sunstone::test
