// SPDX-License-Identifier: Apache-2.0
// Photon maps: `sppm` and `photon` against closed forms where a density estimate is exact, against path and bdpt where the radius is small, and by their trend where it
// is not; caustics that no path finds; light that must not leak; and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/light_map.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/statistics.h"
#include "transport/light_map.h"

namespace sunstone::test {
namespace {

constexpr std::uint32_t seeds = 16;
constexpr double standard_errors = 7;  // a mean of 16 is beyond them by chance once in 10^5

RenderSettings sppm(RenderSettings s, std::uint32_t photons, float radius) {
  s.integrator = "sppm";
  s.photons = photons;
  s.radius = radius;
  s.alpha = 1;  // as it is: what is tested is an estimate at a known radius
  return s;
}

RenderSettings photon(RenderSettings s, std::uint32_t photons, float radius, float caustic_radius) {
  s.integrator = "photon";
  s.photons = photons;
  s.radius = radius;
  s.caustic_radius = caustic_radius;
  return s;
}

struct Mean {
  double value, error;
};
Mean mean_of(const std::vector<Film> &films, const std::string &layer, const Window &window, int channel) {
  const Moments m = moments(means(films, layer, window, channel));
  return {m.mean, std::sqrt(m.variance / static_cast<double>(m.count))};
}

// Each bounce of the whole picture and of its blocks, within the noise and `bias`, a share of the bounce' mean.
void expect_close(const std::vector<Film> &films, const std::vector<Film> &reference, unsigned last, double bias, double noise, int block = 8) {
  std::vector<Window> windows{whole(films[0])};
  for (int y = 0; y + block <= films[0].height(); y += block)
    for (int x = 0; x + block <= films[0].width(); x += block) windows.push_back({x, y, x + block, y + block});
  for (unsigned depth = 0; depth <= last; depth++) {
    const std::string layer = "bounce." + std::to_string(depth);
    for (int channel = 0; channel < 3; channel++) {
      const double all = mean_of(reference, layer, windows[0], channel).value;
      for (const Window &w : windows) {
        const Mean a = mean_of(films, layer, w, channel), b = mean_of(reference, layer, w, channel);
        EXPECT_NEAR(a.value, b.value, standard_errors * std::hypot(a.error, b.error) + bias * std::max(all, b.value))
            << layer << " from " << w.x0 << "," << w.y0 << " to " << w.x1 << "," << w.y1 << " channel " << channel << ", errors " << a.error << " and " << b.error;
      }
    }
  }
  // Light that was scattered twice is the photons' own.
  const std::string layer = last >= 2 ? "bounce.2" : "bounce.1";
  const Mean a = mean_of(films, layer, windows[0], 1), b = mean_of(reference, layer, windows[0], 1);
  EXPECT_LT(a.error, noise * a.value) << "too noisy to tell";
  EXPECT_LT(b.error, noise * b.value) << "the reference is too noisy to tell";
  for (const Film &film : films) ASSERT_EQ(film.nan, 0u);
}

// sppm at a radius that is small beside everything in the scene.
void expect_sppm(const Case &scene, const RenderSettings &s, std::uint64_t samples, const std::string &integrator, std::uint64_t reference_samples, double bias, float radius,
                 double noise, std::uint32_t photons) {
  RenderSettings r = s;
  r.integrator = integrator;
  expect_close(render_seeds(scene, sppm(s, photons, radius), samples, seeds), render_seeds(scene, r, reference_samples, seeds), s.max_depth, bias, noise);
}

// Walls that shine and reflect half of it: a photon map has no bias there, but near edges.
Scene shining_box() {
  Scene scene;
  Material wall = matt({0.5f, 0.25f, 0.75f});
  wall.emission = {1, 2, 1};
  add(scene, box({-1, -1, -1}, {1, 1, 1}, true), wall);
  add_camera(scene, {0, 0, 0.9f}, {0, 0, -1}, 20);
  return scene;
}

// Open to the sky: a floor, two walls, a ball that is a rough mirror and one that mirrors almost smoothly.
Scene corner() {
  Scene scene;
  add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}), matt({0.7f, 0.5f, 0.3f}));
  add(scene, quad({0, 1, -1.5f}, {2, 0, 0}, {0, 1, 0}), matt({0.4f, 0.6f, 0.8f}));
  add(scene, quad({-1.5f, 1, 0}, {0, 0, -2}, {0, 1, 0}), matt({0.6f, 0.6f, 0.6f}));
  add(scene, sphere({0.7f, 0.5f, 0}, 0.49f, 12), metal({0.9f, 0.7f, 0.5f}, 0.5f));
  add(scene, sphere({-0.5f, 0.4f, 0.2f}, 0.39f, 12), metal({0.6f, 0.8f, 0.9f}, 0.08f));
  add_camera(scene, {0.3f, 1.4f, 4}, {0, 0.6f, 0}, 40);
  return scene;
}

// A glass ball under a point light: its caustic is for light paths alone to find.
Scene burning_glass() {
  Scene scene;
  add(scene, quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}), matt({0.8f, 0.8f, 0.8f}));
  add(scene, sphere({0, 0.8f, 0}, 0.5f, 24), glass({0.3f, 0.1f, 0}));
  add_point_light(scene, {0.3f, 3, 0.2f}, {8, 8, 8});
  add_camera(scene, {0, 1.8f, 2.6f}, {-0.1f, 0, 0}, 30);
  return scene;
}

// Root mean square difference of a layer over pixels, as a share of its mean.
double distance(const std::vector<Film> &films, const std::vector<Film> &reference, const std::string &layer, int block) {
  double sum = 0, all = 0;
  std::size_t count = 0;
  for (int y = 0; y + block <= films[0].height(); y += block)
    for (int x = 0; x + block <= films[0].width(); x += block, count++) {
      const Window w{x, y, x + block, y + block};
      const double a = mean_of(films, layer, w, 1).value, b = mean_of(reference, layer, w, 1).value;
      sum += (a - b) * (a - b);
      all += b;
    }
  return std::sqrt(sum / static_cast<double>(count)) / (all / static_cast<double>(count));
}

}  // namespace

// Radiance after n scatterings is E a^n everywhere. The walls are in reach of photons all around, so a wrong kernel, count or cosine shows at once.
TEST(Photons, ShiningBoxByBounce) {
  const Case scene(shining_box());
  const RenderSettings s = picture(8, 8, 5);
  const std::vector<Film> progressive = render_seeds(scene, sppm(s, 16384, 0.5f), 12, seeds), mapped = render_seeds(scene, photon(s, 65536, 0.02f, 0.02f), 64, seeds);
  glm::vec3 expected{1, 2, 1};
  for (unsigned depth = 0; depth <= 5; depth++, expected *= glm::vec3(0.5f, 0.25f, 0.75f)) {
    const std::string layer = "bounce." + std::to_string(depth);
    EXPECT_EQ(differs(progressive, layer, whole(progressive[0]), expected), "") << "sppm, " << layer;
    EXPECT_EQ(differs(mapped, layer, whole(mapped[0]), expected, 0.01), "") << "photon, " << layer;  // its final gather sees edges
    if (depth < 2 || depth > 4) continue;
    for (const auto &[films, name] : {std::pair{&progressive, "sppm"}, std::pair{&mapped, "photon"}}) {
      const Mean m = mean_of(*films, layer, whole((*films)[0]), 1);
      EXPECT_LT(m.error, 0.005 * m.value) << name << " is too noisy to tell 2 per cent, " << layer;
    }
  }
}

TEST(Photons, SppmInARoom) { expect_sppm(Case(matt_room()), picture(24, 24, 4), 8, "path", 32, 0.03, 0.04f, 0.01, 16384); }

TEST(Photons, SppmUnderEachLight) {
  const RenderSettings s = picture(24, 16, 3);
  Scene point = corner();
  add_point_light(point, {-1, 2, 1.5f}, {6, 5, 4});
  expect_sppm(Case(point), s, 8, "bdpt", 32, 0.03, 0.04f, 0.015, 16384);
  Scene spot = corner();
  spot.lights.push_back(spot_light({1.2f, 2.2f, 1.5f}));
  expect_sppm(Case(spot), s, 8, "bdpt", 32, 0.03, 0.04f, 0.015, 16384);
  Scene sun = corner();
  sun.lights.push_back(sun_light());
  // Light from afar has to cover all of the scene, and most of it misses.
  expect_sppm(Case(sun), s, 8, "bdpt", 32, 0.03, 0.04f, 0.025, 32768);
  Scene sky = corner();
  set_sky(sky, {0.8f, 0.9f, 1});
  expect_sppm(Case(sky), s, 8, "path", 32, 0.03, 0.04f, 0.025, 32768);
  // A map whose chances leave its dim parts to rays that meet them: photons have to bring their light all the same.
  Scene map = corner();
  set_sky_map(map, sky_map(16, 8, {6, 5, 4}));
  expect_sppm(Case(map), s, 8, "path", 48, 0.03, 0.04f, 0.025, 32768);
}

// Glass, rough glass, thin glass, alpha of both kinds, textures and normal maps, instances (one mirrored), and every kind of light at once.
TEST(Photons, SppmWithEverything) { expect_sppm(Case(everything()), picture(24, 16, 4), 32, "bdpt", 64, 0.05, 0.03f, 0.12, 8192); }

// A coarse ball with smooth normals, lit from the side by a spot light that a mirror turns to it, or by the spot light's image alone. The true normals of a photon and of
// the place that looks at it differ: flux is of the area where the photon arrived, so its own true normal turns it into light; by that of the other place the ball would
// be 3 per cent too bright, and its pixels 10 per cent off.
TEST(Photons, ABallLitFromTheSide) {
  const auto ball = [](bool mirrored) {
    Scene scene;
    add(scene, sphere({0, 0, 0}, 1, 8), matt({0.8f, 0.8f, 0.8f}));
    Light spot = spot_light({mirrored ? -1.0f : -3.0f, 1.5f, 1});
    spot.direction = glm::normalize(glm::vec3(mirrored ? -3 : 3, -1.5f, -1));
    spot.inner_angle = 0.33f;  // the ball is 0.29 in half
    spot.outer_angle = 0.36f;
    scene.lights.push_back(spot);
    if (mirrored) add(scene, quad({-2, 0, 0}, {0, 0, -3}, {0, 3, 0}), metal({1, 1, 1}, 0));
    add_flat_camera(scene, {0, 0, 5}, 1);
    return scene;
  };
  RenderSettings s = picture(24, 24, 2);
  s.filter = box_filter();
  const std::vector<Film> films = render_seeds(Case(ball(true)), sppm(s, 16384, 0.1f), 8, seeds), reference = render_seeds(Case(ball(false)), s, 64, seeds);
  const Mean a = mean_of(films, "beauty", whole(films[0]), 1), b = mean_of(reference, "beauty", whole(reference[0]), 1);
  EXPECT_NEAR(a.value / b.value, 1, 0.01);
  EXPECT_LT(std::hypot(a.error, b.error), 0.003 * b.value) << "too noisy to tell";
  EXPECT_LT(distance(films, reference, "beauty", 2), 0.05);
}

// A veil that is there by chance, in front of a wall: photons on it have tossed its coin, and so have the paths that look at them.
TEST(Photons, Veil) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}), matt({0.8f, 0.8f, 0.8f}));
  Material veil = matt({0.8f, 0.8f, 0.8f});
  veil.alpha_mode = AlphaMode::blend;
  veil.alpha = 0.4f;
  add(scene, quad({0, 0.5f, -0.5f}, {1, 0, 0}, {0, 0.5f, 0}), veil);
  add_point_light(scene, {0.2f, 1.5f, 1}, {4, 4, 4});
  add_camera(scene, {0.3f, 0.9f, 3}, {0, 0.4f, 0}, 40);
  expect_sppm(Case(std::move(scene)), picture(24, 16, 3), 48, "path", 32, 0.03, 0.04f, 0.025, 16384);
}

// Panes that scatter and let rays straight through: a light path may leave a vertex on each of them without having scattered.
TEST(Photons, ManyPanes) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}), matt({0.7f, 0.6f, 0.5f}));
  add(scene, quad({0, 0.5f, -1}, {1, 0, 0}, {0, 0.5f, 0}), matt({0.5f, 0.6f, 0.7f}));
  Material pane = thin_glass({0.9f, 0.95f, 0.9f});
  pane.transmission = 0.8f;
  for (int i = 0; i < 8; i++) add(scene, quad({0, 1 + 0.05f * static_cast<float>(i), 0}, {1, 0, 0}, {0, 0, -1}), pane);
  add(scene, quad({0, 1.6f, 0}, {0.7f, 0, 0}, {0, 0, 0.7f}), lamp({8, 8, 8}));
  add_camera(scene, {0.3f, 0.7f, 3}, {0, 0.5f, 0}, 40);
  const Case made(std::move(scene));
  RenderSettings s = picture(24, 16, 3);
  expect_sppm(made, s, 8, "path", 64, 0.04, 0.04f, 0.025, 16384);
  const std::vector<Film> reference = (s.integrator = "path", render_seeds(made, s, 64, seeds));
  expect_close((s.integrator = "bdpt", render_seeds(made, s, 64, seeds)), reference, 3, 0, 0.025);
}

// The bias goes with the radius.
TEST(Photons, SppmConvergesAsTheRadiusShrinks) {
  const Case scene(matt_room());
  RenderSettings s = picture(24, 24, 3);
  s.integrator = "path";
  const std::vector<Film> reference = render_seeds(scene, s, 128, seeds);
  std::vector<double> distances;
  for (const float radius : {0.6f, 0.3f, 0.15f, 0.06f}) distances.push_back(distance(render_seeds(scene, sppm(s, radius > 0.2f ? 2048 : 8192, radius), 8, seeds), reference, "bounce.2", 4));
  for (std::size_t i = 1; i < distances.size(); i++) EXPECT_LT(distances[i], 0.75 * distances[i - 1]) << "step " << i;
  EXPECT_GT(distances.front(), 0.1) << "the first radius is to be far too large";
  EXPECT_LT(distances.back(), 0.06);
  // And so it does by itself, sample by sample.
  RenderSettings shrinking = sppm(s, 2048, 0.6f);
  shrinking.alpha = 2.0f / 3;
  EXPECT_LT(distance(render_seeds(scene, shrinking, 48, seeds), reference, "bounce.2", 4), 0.75 * distances[0]);
}

TEST(Photons, PhotonMapConverges) {
  const Case scene(matt_room());
  RenderSettings s = picture(24, 24, 3);
  s.integrator = "path";
  const std::vector<Film> reference = render_seeds(scene, s, 128, seeds);
  std::vector<double> two, three;
  for (const auto &[photons, radius] : {std::pair{1000u, 0.6f}, std::pair{10000u, 0.25f}, std::pair{100000u, 0.05f}}) {
    const std::vector<Film> films = render_seeds(scene, photon(s, photons, radius, radius), 64, seeds);
    two.push_back(distance(films, reference, "bounce.2", 4));
    three.push_back(distance(films, reference, "bounce.3", 4));
    if (photons == 100000u) expect_close(films, reference, 3, 0.03, 0.01);
  }
  for (std::size_t i = 1; i < three.size(); i++) EXPECT_LT(three[i], 0.7 * three[i - 1]) << "step " << i;
  // What one bounce more brings is gathered over the map; what two bring is direct light at the gather rays' ends, and has no bias but noise.
  EXPECT_LT(*std::max_element(two.begin(), two.end()), 0.02);
}

// No path from the eye meets a point light through glass; paths from the light find its caustic.
TEST(Photons, CausticsOfAPointLight) {
  const Case scene(burning_glass());
  RenderSettings s = picture(24, 16, 4);
  s.integrator = "bdpt";
  const std::vector<Film> reference = render_seeds(scene, s, 256, seeds);
  const double caustic = mean_of(reference, "bounce.3", whole(reference[0]), 1).value;
  s.integrator = "path";
  EXPECT_LT(mean_of(render_seeds(scene, s, 16, seeds), "bounce.3", whole(reference[0]), 1).value, 0.3 * caustic) << "the rest is the floor, seen through the ball";
  const auto check = [&](const std::vector<Film> &films) {
    // Of four scatterings photons see more than bdpt can: what the ball mirrors onto the floor, through the ball.
    for (const char *layer : {"bounce.1", "bounce.2", "bounce.3"})
      for (const Window &w : {whole(films[0]), Window{8, 4, 16, 12}})
        for (int channel = 0; channel < 3; channel++) {
          const Mean a = mean_of(films, layer, w, channel), b = mean_of(reference, layer, w, channel);
          EXPECT_NEAR(a.value, b.value, standard_errors * std::hypot(a.error, b.error) + 0.02 * b.value) << layer << ", channel " << channel;
        }
    const Mean m = mean_of(films, "bounce.3", whole(films[0]), 1);
    EXPECT_LT(m.error, 0.035 * m.value) << "too noisy to tell";
  };
  check(render_seeds(scene, sppm(s, 4096, 0.03f), 144, seeds));
  check(render_seeds(scene, photon(s, 200000, 0.06f, 0.03f), 256, seeds));
}

// Of a lamp, paths find it too: it must not count twice, where gather rays meet the lamp through the ball and the map of caustics has the same light.
TEST(Photons, CausticsOfALamp) {
  Scene scene = burning_glass();
  scene.lights.clear();
  add(scene, quad({0.3f, 3, 0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}), lamp({20, 20, 20}));
  const Case made(std::move(scene));
  RenderSettings s = picture(24, 16, 4);
  s.integrator = "bdpt";
  const std::vector<Film> reference = render_seeds(made, s, 240, seeds);
  expect_close(render_seeds(made, sppm(s, 4096, 0.04f), 96, seeds), reference, 4, 0.04, 0.03);
  expect_close(render_seeds(made, photon(s, 100000, 0.06f, 0.04f), 96, seeds), reference, 4, 0.04, 0.03);
}

// A dark room with thin walls in bright surroundings, photons all around it within the radius.
TEST(Photons, DoNotLeakThroughThinWalls) {
  Scene scene;
  add(scene, box({-1, 0, -1}, {1, 2, 1}), matt({0.8f, 0.8f, 0.8f}));
  add(scene, box({-0.99f, 0.01f, -0.99f}, {0.99f, 1.99f, 0.99f}, true), matt({0.8f, 0.8f, 0.8f}));
  add(scene, quad({0, -0.5f, 0}, {4, 0, 0}, {0, 0, -4}), matt({0.8f, 0.8f, 0.8f}));
  set_sky(scene, {1, 1, 1});
  add_camera(scene, {0, 1, 0.9f}, {0, 1, -1}, 60);
  const Case made(std::move(scene));
  const RenderSettings s = picture(16, 16, 3);
  for (const RenderSettings &settings : {sppm(s, 4096, 0.2f), photon(s, 20000, 0.2f, 0.2f)}) {
    const Rendered r = render(made, settings, {0, 2});
    for (const FilmLayer &layer : r.film.layers) EXPECT_EQ(mean(r.film, layer.name, whole(r.film), 1), 0.0) << settings.integrator << ", " << layer.name;
    EXPECT_EQ(r.counts.paths, 512u);
  }
}

// A pixel is a function of scene, sample and photons: a window shows what the whole picture does there.
TEST(Photons, CropsAreWindowsOfTheWhole) {
  const Case scene(matt_room());
  const RenderSettings s = picture(24, 16, 3);
  for (const RenderSettings &settings : {sppm(s, 2000, 0.2f), photon(s, 3000, 0.2f, 0.1f)}) {
    RenderSettings window = settings;
    window.x0 = 5;
    window.y0 = 3;
    window.x1 = 18;
    window.y1 = 13;
    const Film all = render(scene, settings, {1, 3}).film, part = render(scene, window, {1, 3}).film;
    for (const FilmLayer &layer : part.layers)
      for (int channel = 0; channel < 3; channel++)
        EXPECT_EQ(mean(part, layer.name, {5, 3, 18, 13}, channel), mean(all, layer.name, {5, 3, 18, 13}, channel)) << settings.integrator << ", " << layer.name;
  }
}

TEST(Photons, RefuseWhatMeansNothing) {
  const Case scene(matt_room());
  const auto refuses = [&](const RenderSettings &s, const std::string &what) { EXPECT_NE(refusal(scene, s).find(what), std::string::npos) << what; };
  const RenderSettings s = picture(16, 16, 3);
  refuses(sppm(s, 100, -1.0f), "--radius");
  refuses(sppm(s, 100, 1e-9f), "--radius");
  refuses(sppm(s, 100, std::numeric_limits<float>::infinity()), "--radius");
  refuses(sppm(s, 100, std::numeric_limits<float>::quiet_NaN()), "--radius");
  refuses(photon(s, 100, 1, -2), "--caustic-radius");
  refuses(sppm(picture(16, 16, 65), 100, 1), "--max-depth");
  refuses(sppm(s, SUN_MOST_PHOTONS + 1u, 1), "--photons");
  RenderSettings alpha = sppm(s, 100, 1);
  alpha.alpha = 0;
  refuses(alpha, "--alpha");
  RenderSettings elsewhere = s;
  elsewhere.photons = 100;
  refuses(elsewhere, "--photons");
}

// A slab of rough glass that lets nothing through, thinner than the radius: photons on one side of it are none of the other's.
TEST(Photons, StayOnTheirSideOfASlab) {
  Scene scene;
  add(scene, box({-1, -0.01f, -1}, {1, 0.01f, 1}), glass({1000, 1000, 1000}, 0.6f));
  add(scene, quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), matt({0.8f, 0.8f, 0.8f}));
  add_point_light(scene, {0, 0.5f, 0}, {4, 4, 4});
  double seen[2];
  for (const bool below : {false, true}) {
    scene.cameras.clear();
    add_camera(scene, {0.1f, below ? -1.5f : 0.8f, 0}, {0, 0, 0}, 20);
    const Film film = render(Case(scene), sppm(picture(16, 16, 3), 20000, 0.1f), {0, 2}).film;
    seen[below] = mean(film, "bounce.2", whole(film), 1);
  }
  EXPECT_GT(seen[0], 1e-3) << "the test sees nothing";
  EXPECT_LT(seen[1], 1e-4 * seen[0]);
}

// A place whose photons stand in two cells that share a bucket, whatever the number of buckets: each is found in its own cell alone, and counts once.
TEST(Photons, CellsThatShareABucket) {
  constexpr float radius = 0.25f;
  constexpr kernel::uint mask = 0xffff;  // of as many buckets as 16384 photons of three bounces may have
  int cell[3] = {0, 0, 0}, next[3] = {1, 0, 0};
  for (int i = 0; kernel::map_bucket(cell, mask) != kernel::map_bucket(next, mask); i++) {
    ASSERT_LT(i, 1 << 20);
    cell[0] = i / 512;
    next[0] = cell[0] + 1;
    cell[2] = next[2] = i % 512;
  }
  // A floor half way up a layer of cells, looked at where these two meet the two beside them.
  const glm::vec3 at = 2 * radius * glm::vec3(next[0], 0.5f, cell[2] + 1);
  for (const float beside : {-0.1f, 0.1f}) {
    ASSERT_EQ(kernel::map_cell(at.x + beside, radius), beside < 0 ? cell[0] : next[0]);
    ASSERT_EQ(kernel::map_cell(at.y + beside, radius), 0);
    ASSERT_EQ(kernel::map_cell(at.z + beside, radius), beside < 0 ? cell[2] : cell[2] + 1);
  }
  Scene scene;
  Material wall = matt({0.5f, 0.25f, 0.75f});
  wall.emission = {1, 2, 1};
  add(scene, box(at + glm::vec3(-1, 0, -1), at + glm::vec3(1, 2, 1), true), wall);
  add_camera(scene, at + glm::vec3(0, 1.5f, 0.1f), at, 2);
  const std::vector<Film> films = render_seeds(Case(std::move(scene)), sppm(picture(8, 8, 3), 16384, radius), 8, seeds);
  EXPECT_EQ(differs(films, "bounce.2", whole(films[0]), {0.25f, 0.125f, 0.5625f}, 1e-3), "");
  const Mean m = mean_of(films, "bounce.2", whole(films[0]), 1);
  EXPECT_LT(m.error, 0.03 * m.value) << "too noisy to tell";
}

// A map of caustics is the same for all samples, so what its photons leave in gloss stays: a varnished board that a glass ball and a lamp stand on is dotted by them, unless its
// gloss goes on as a path.
TEST(Photons, GlossIsNotDottedByCaustics) {
  Scene scene;
  Material board = matt({0.1f, 0.06f, 0.04f});
  board.f0 = glm::vec3(0.04f);
  board.f90 = 1;
  board.roughness = 0.42f;
  add(scene, quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}), board);
  add(scene, sphere({0.2f, 0.4f, -0.5f}, 0.4f, 24), glass({0.3f, 0.1f, 0}));
  add(scene, quad({0, 0.8f, -2.5f}, {1.5f, 0, 0}, {0, 0.6f, 0}), lamp({3, 3, 3}));
  add_camera(scene, {0, 0.8f, 3}, {0, 0.1f, 0}, 30);
  const Case made(std::move(scene));
  RenderSettings s = picture(32, 24, 4);
  s.filter = box_filter();
  const std::vector<Film> films = render_seeds(made, photon(s, 20000, 0.08f, 0.04f), 64, seeds);
  // The board before the ball, and beside it.
  double variance = 0, all = 0;
  for (int y = 12; y < 24; y++)
    for (int x = 0; x < 32; x++) {
      const Mean m = mean_of(films, "beauty", {x, y, x + 1, y + 1}, 1);
      variance += m.error * m.error * seeds;
      all += m.value;
    }
  const double count = 12 * 32;
  EXPECT_LT(std::sqrt(variance / count), 0.4 * all / count);
}

// The eye looks into a room from behind its wall, and light falls through that wall on the floor before it: few photons take that way, but not so few that each weighs too much.
TEST(Photons, BehindWallsOfOneSide) {
  Scene scene = room_of_one_side();
  add_camera(scene, {0.5f, 1.1f, 6}, {0, 0.5f, 0}, 40);
  const Case made(std::move(scene));
  const std::vector<Film> films = render_seeds(made, sppm(picture(24, 16, 4), 4096, 0.15f), 4, 2 * seeds);
  const Mean floor = mean_of(films, "bounce.2", {0, 12, 24, 16}, 1);
  EXPECT_LT(floor.error, 0.095 * floor.value);
}

// A lamp that shines to both sides hangs a hundredth below a ceiling: light is caught between the two, and the photons that it leaves there are none of the lamp's lower side,
// though they lie within the radius and face as it does.
TEST(Photons, WhatHangsCloseToASurfaceIsNotIt) {
  Scene scene;
  Material shining = matt({0.8f, 0.8f, 0.8f});
  shining.emission = {1, 1, 1};
  add(scene, quad({0, 1, 0}, {2, 0, 0}, {0, 0, 2}), matt({0.8f, 0.8f, 0.8f}));
  add(scene, quad({0, 0.99f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}), shining);
  add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}), matt({0.8f, 0.8f, 0.8f}));
  add_camera(scene, {0, 0.3f, 0.8f}, {0, 0.99f, 0}, 30);
  const Case made(std::move(scene));
  RenderSettings s = picture(16, 16, 4);
  RenderSettings of_vcm = s;
  of_vcm.integrator = "vcm";
  of_vcm.radius = 0.04f;
  of_vcm.alpha = 1;
  const double right = mean_of(render_seeds(made, s, 64, seeds), "beauty", {4, 4, 12, 12}, 1).value;
  for (const RenderSettings &looking : {sppm(s, 16384, 0.04f), of_vcm}) {
    const Mean m = mean_of(render_seeds(made, looking, 16, seeds), "beauty", {4, 4, 12, 12}, 1);
    EXPECT_NEAR(m.value / right, 1, 0.03) << looking.integrator;
    EXPECT_LT(m.error, 0.01 * right) << "too noisy to tell";
  }
}

// Brushed metal, in balls no larger than the radius: photons around a place of it are those of all of its sides, so it goes on as a path.
TEST(Photons, SmallThingsOfGlossAreNotBlurred) {
  Scene scene;
  add(scene, quad({0, 0, 0}, {2, 0, 0}, {0, 0, -2}), matt({0.7f, 0.5f, 0.3f}));
  for (int i = 0; i < 4; i++) add(scene, sphere({-0.6f + 0.4f * static_cast<float>(i), 0.15f, 0}, 0.15f, 12), metal({0.9f, 0.7f, 0.5f}, 0.3f + 0.04f * static_cast<float>(i)));
  add(scene, quad({0, 1.5f, 0}, {0.6f, 0, 0}, {0, 0, 0.6f}), lamp({4, 4, 4}));
  add_camera(scene, {0, 0.5f, 3}, {0, 0.15f, 0}, 18);
  const Case made(std::move(scene));
  const RenderSettings s = picture(24, 16, 4);
  const Window balls{4, 6, 20, 10};
  const Mean a = mean_of(render_seeds(made, sppm(s, 4096, 0.2f), 48, seeds), "bounce.2", balls, 1), b = mean_of(render_seeds(made, s, 128, seeds), "bounce.2", balls, 1);
  EXPECT_NEAR(a.value / b.value, 1, 0.04);
  EXPECT_LT(std::hypot(a.error, b.error), 0.02 * b.value) << "too noisy to tell";
}

}  // namespace sunstone::test
