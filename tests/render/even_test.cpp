// SPDX-License-Identifier: Apache-2.0
// Light whose mean is known whatever casts it, a map of the sky too, by closed form or quadrature, for every integrator.
// A floor seen from above: what it scatters once is the flux that it gets. Paths from the eye and from the light are about as likely.
// A bowl, half of a hollow sphere, lit through its opening: what one point of a sphere sends to another is the same everywhere, so from the second bounce on radiance is even
// and depends on the flux that comes in alone. Photons lie evenly in it, so that a density estimate is exact away from the rim.
// Each mean misses its interval by chance once in 10^9 runs, and there are fewer than 600.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "support/agree.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace sunstone::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t seeds = 48;
constexpr glm::vec3 albedo{0.9f, 0.8f, 0.6f};

using Flux = glm::dvec3;

// The lower half of a unit sphere about the origin: its upper half is cut away.
Scene bowl() {
  Scene scene;
  Material clay = matt(albedo);
  Image cut;
  cut.name = "cut";
  cut.width = 1;
  cut.height = 2;
  cut.channels = 4;
  cut.pixels = std::vector<std::uint8_t>{255, 255, 255, 0, 255, 255, 255, 255};
  clay.base_color_texture = use_picture(scene, std::move(cut), false);
  clay.alpha_mode = AlphaMode::mask;
  scene.materials.push_back(clay);
  scene.shapes.push_back({Shape::Kind::sphere, "bowl", 0, scaled({1, 1, 1})});
  add_camera(scene, {0.1f, 0, 0.05f}, {0.25f, -1, -0.1f}, 90);
  return scene;
}

// Light of another colour from all sides, with a sun, a bright horizon and a dark north.
Image stormy_sky(int width, int height) {
  Image image;
  image.name = "stormy sky";
  image.width = width;
  image.height = height;
  image.channels = 3;
  std::vector<float> values;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const bool sun = y == height / 4 && x == width / 3, glow = y == height / 2 - 1 && x > width / 2;
      const float wave = 1.2f + std::sin(static_cast<float>(3 * x + y)), north = x < width / 4 ? 0.1f : 1.0f;
      const glm::vec3 value = sun ? glm::vec3(60, 50, 35) : glow ? glm::vec3(4, 2, 1) * wave : glm::vec3(0.3f, 0.5f, 0.9f) * wave * north;
      for (int c = 0; c < 3; c++) values.push_back(value[c]);
    }
  image.pixels = std::move(values);
  return image;
}

// Calls visit(v, u, radiance, solid angle) all over the sky above the horizon: places of the map, as docs/conventions.md reads it.
template <class Visit>
void over_the_sky(const Image &map, const Visit &visit) {
  const auto &values = std::get<1>(map.pixels);
  const auto texel = [&](int x, int y) {
    x = (x % map.width + map.width) % map.width;
    y = std::clamp(y, 0, map.height - 1);
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x));
    return Flux(values[at], values[at + 1], values[at + 2]);
  };
  constexpr int columns = 1024, rows = 512;
  for (int row = 0; row < rows; row++) {
    const double v = (row + 0.5) / rows / 2, y = v * map.height - 0.5;
    const int y0 = static_cast<int>(std::floor(y));
    for (int column = 0; column < columns; column++) {
      const double u = (column + 0.5) / columns, x = u * map.width - 0.5;
      const int x0 = static_cast<int>(std::floor(x));
      const Flux top = glm::mix(texel(x0, y0), texel(x0 + 1, y0), x - x0), bottom = glm::mix(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), x - x0);
      visit(v, u, glm::mix(top, bottom, y - y0), 2 * pi / columns * std::sin(pi * v) * (pi / 2 / rows));
    }
  }
}

// Of a surface that faces up.
Flux sky_irradiance(const Environment &sky) {
  Flux sum(0);
  over_the_sky(*sky.map, [&](double v, double, const Flux &radiance, double solid_angle) { sum += radiance * std::cos(pi * v) * solid_angle; });
  return sum;
}

// What a rectangle of radiance 1 that faces down at height h sends to the unit disk about the origin, or to the square of half side `half`.
double flux_of_quad(double x, double z, double half_x, double half_z, double h, double half = 0) {
  constexpr int n = 24;
  double sum = 0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int k = 0; k < n; k++)
        for (int l = 0; l < 2 * n; l++) {
          const double u = (k + 0.5) / n, v = (l + 0.5) / (2 * n);
          const double to_x = half > 0 ? half * (2 * u - 1) : std::sqrt(u) * std::cos(2 * pi * v), to_z = half > 0 ? half * (2 * v - 1) : std::sqrt(u) * std::sin(2 * pi * v);
          const double dx = x + half_x * (2 * (i + 0.5) / n - 1) - to_x, dz = z + half_z * (2 * (j + 0.5) / n - 1) - to_z;
          const double squared = dx * dx + dz * dz + h * h;
          sum += h * h / (squared * squared);
        }
  return sum * (4 * half_x * half_z) * (half > 0 ? 4 * half * half : pi) / (n * n * n * 2.0 * n);
}

// Each light adds itself to the scene and says what comes through the opening of area pi, or falls on the floor that is seen.
constexpr double opening = pi, half_floor = 0.9, floor_area = 4 * half_floor * half_floor;
constexpr double disk = 2 * pi;  // as wide as the floor's diagonal: what far lights shine through

Flux constant_sky(Scene &scene, double area = opening) {
  set_sky(scene, {0.8f, 1, 1.5f});
  return Flux(0.8, 1, 1.5) * pi * area;
}
Flux sky_of_many_colours(Scene &scene, double area = opening) {
  set_sky_map(scene, stormy_sky(16, 8));
  scene.environment.rotation = 0.3f;
  return sky_irradiance(scene.environment) * area;
}
Flux sun(Scene &scene, double area = opening) {
  Light light;
  light.kind = Light::Kind::directional;
  light.direction = glm::normalize(glm::vec3(0.3f, -1, 0.4f));
  light.intensity = {3, 4, 5};
  scene.lights.push_back(light);
  return Flux(3, 4, 5) * area / std::sqrt(1.25);
}
Flux point(Scene &scene) {
  add_point_light(scene, {0, 0.5f, 0}, {4, 3, 2});
  return Flux(4, 3, 2) * 2.0 * pi * (1 - 0.5 / std::sqrt(1.25));
}
Flux spot(Scene &scene) {
  Light light;
  light.kind = Light::Kind::spot;
  light.position = {0.2f, 1, 0};
  light.direction = glm::normalize(glm::vec3(-0.1f, -1, 0.1f));
  light.intensity = {9, 12, 15};
  light.inner_angle = 0.2f;
  light.outer_angle = 0.6f;
  scene.lights.push_back(light);
  const double inner = std::cos(static_cast<double>(light.inner_angle)), outer = std::cos(static_cast<double>(light.outer_angle));
  return Flux(9, 12, 15) * 2.0 * pi * (1 - inner + (inner - outer) / 3);  // the ramp, squared
}
Flux disk_lamp(Scene &scene) {
  scene.materials.push_back(lamp({5, 4, 6}));
  scene.shapes.push_back({Shape::Kind::disk, "lamp", static_cast<int>(scene.materials.size()) - 1, {{0.6f, 0, 0}, {0, -0.6f, 0}, {0, 0, -0.6f}, {0, 0.4f, 0}}});
  const double ratio = 1 / 0.36, x = 1 + 1.16 * ratio;  // of parallel disks: area of the larger, and 1 + (h^2 + R^2) / r^2
  return Flux(5, 4, 6) * (pi * pi * 0.36) * 0.5 * (x - std::sqrt(x * x - 4 * ratio));
}
Flux quad_lamp(Scene &scene) {
  add(scene, quad({-0.2f, 0.5f, 0.1f}, {0.5f, 0, 0}, {0, 0, 0.7f}), lamp({3, 5, 4}));
  return Flux(3, 5, 4) * flux_of_quad(-0.2, 0.1, 0.5, 0.7, 0.5);
}
// Lamps side by side, of unequal power, one of them with two sides, and a spot below them: what each is chosen with matters.
Flux many(Scene &scene) {
  Material both = lamp({1, 1, 8});
  both.double_sided = true;
  add(scene, quad({0.6f, 0.5f, 0}, {0.1f, 0, 0}, {0, 0, 0.3f}), both);
  const Flux lamps = quad_lamp(scene) + Flux(1, 1, 8) * flux_of_quad(0.6, 0, 0.1, 0.3, 0.5), all = lamps + spot(scene) * 0.3;
  scene.lights[0].position = {0.1f, 0.4f, 0};
  scene.lights[0].intensity *= 0.3f;
  return all;
}

struct Work {
  const char *integrator;
  std::uint64_t samples;
  double noise = 0.0025;  // relative standard error of the first bounce looked at, at most; of the next half more
  double bias = 3e-4;     // of what is no estimate of a density: of floats, of cuts at the rim, of the quadrature
  int size = 16;
  std::uint32_t photons = 0;
  float radius = 0;
  unsigned s = 0, t = 0;  // of bdpt: this strategy alone
};
// Merging is about as likely as joining; of photons, normals turn within the radius, by the square of its size; where a final gather may look at the rim it is small.
Work vcm(std::uint64_t samples) { return {"vcm", samples, 0.0025, 1e-3, 16, 0, 0.035f}; }
Work sppm(std::uint64_t samples, std::uint32_t photons) { return {"sppm", samples, 0.004, 2e-3, 16, photons, 0.1f}; }
Work photon(std::uint64_t samples) { return {"photon", samples, 0.004, 2e-3, 16, 65536, 0.01f}; }

std::vector<Film> films_of(const Case &scene, const Work &run, unsigned max_depth) {
  RenderSettings s = picture(run.size, run.size, max_depth);
  s.integrator = run.integrator;
  s.filter = box_filter();
  s.photons = run.photons;
  s.radius = run.radius;
  s.strategy_s = run.s;
  s.strategy_t = run.t;
  if (run.integrator == std::string("photon")) s.caustic_radius = run.radius;
  if (run.integrator == std::string("vcm") || run.integrator == std::string("sppm")) s.alpha = 1;
  std::vector<Film> films = render_seeds(scene, s, run.samples, seeds);
  for (const Film &film : films) {
    EXPECT_EQ(film.nan, 0u);
    double sum = 0;  // nothing beyond the depth limit
    for (const std::string &layer : bounces(0, max_depth)) sum += mean(film, layer, whole(film), 1);
    EXPECT_NEAR(mean(film, "beauty", whole(film), 1), sum, 1e-6 * sum);
  }
  return films;
}

// Bounces 2 and 3.
void expect_even(const std::function<Flux(Scene &)> &light, const std::vector<Work> &runs) {
  Scene scene = bowl();
  const Flux flux = light(scene);
  const Case made(std::move(scene));
  for (const Work &run : runs) {
    SCOPED_TRACE(run.integrator);
    const std::vector<Film> films = films_of(made, run, 3);
    glm::vec3 expected = glm::vec3(flux / (4 * pi * pi)) * albedo * albedo;
    for (const auto &[layer, noise] : {std::pair{"bounce.2", run.noise}, {"bounce.3", 1.5 * run.noise}}) {
      EXPECT_EQ(differs(films, layer, whole(films[0]), expected, run.bias), "");
      EXPECT_LT(relative_error(films, layer), noise) << layer << " is too noisy to tell";
      expected *= albedo * 0.5f;
    }
  }
}

Camera from_above(double half) {
  Camera camera;
  camera.orthographic = true;
  camera.half_width = camera.half_height = static_cast<float>(half);
  camera.transform = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 3, 0}};
  return camera;
}

// A floor, seen whole but for its edges.
Scene floor_from_above() {
  Scene scene;
  add(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}), matt(albedo));
  scene.cameras.push_back(from_above(half_floor));
  return scene;
}

// Its first bounce, as the mean over the picture.
void expect_floor(const std::function<Flux(Scene &)> &light, const std::vector<Work> &runs) {
  Scene scene = floor_from_above();
  const Flux flux = light(scene);
  const Case made(std::move(scene));
  for (const Work &run : runs) {
    SCOPED_TRACE(run.integrator);
    const std::vector<Film> films = films_of(made, run, 1);
    EXPECT_EQ(differs(films, "bounce.1", whole(films[0]), glm::vec3(flux / (floor_area * pi)) * albedo, run.bias), "");
    EXPECT_LT(relative_error(films, "bounce.1"), run.noise) << "is too noisy to tell";
  }
}

// What each strategy of bdpt has of a floor's first bounce: the eye meets the light, asks it, or the light meets the floor. Of each bit of light its share is that of its density,
// squared, among all three: as camera rays, of which a square metre gets one a pixel, and light paths, as many as there are pixels, bring it about.
struct Shares {
  Flux of[3] = {Flux(0), Flux(0), Flux(0)};

  // All with the density of pixels on the floor left out.
  void add(const Flux &flux, double met, double asked, double sent) {
    const double all = met * met + asked * asked + sent * sent;
    of[0] += flux * (met * met / all);
    of[1] += flux * (asked * asked / all);
    of[2] += flux * (sent * sent / all);
  }
};

void expect_shares(const char *name, const Case &made, const Shares &shares, std::uint64_t samples = 64) {
  SCOPED_TRACE(name);
  for (unsigned s = 0; s < 3; s++) {
    if (shares.of[s].y == 0) continue;
    SCOPED_TRACE("strategy " + std::to_string(s) + "," + std::to_string(3 - s));
    const std::vector<Film> films = films_of(made, {"bdpt", samples, 0.005, 1e-3, 16, 0, 0, s, 3 - s}, 1);
    EXPECT_EQ(differs(films, "bounce.1", whole(films[0]), glm::vec3(shares.of[s] / (floor_area * pi)) * albedo, 1e-3), "");
    EXPECT_LT(relative_error(films, "bounce.1"), 0.005) << "is too noisy to tell";
  }
}

}  // namespace

TEST(Floor, SharesOfAConstantSky) {
  Scene scene = floor_from_above();
  constant_sky(scene);
  Shares shares;
  constexpr int n = 10000;
  for (int i = 0; i < n; i++) {
    const double cosine = (i + 0.5) / n, anywhere = 1 / (4 * pi);
    shares.add(Flux(0.8, 1, 1.5) * (2 * pi * cosine / n * floor_area), cosine / pi, anywhere, floor_area * cosine / disk * anywhere);
  }
  expect_shares("constant sky", Case(std::move(scene)), shares);
}
TEST(Floor, SharesOfASky) {
  for (const bool zenith : {false, true}) {
    Scene scene = floor_from_above();
    sky_of_many_colours(scene);
    if (zenith) {  // alone is bright, so that light paths are likely
      Image map = stormy_sky(16, 8);
      auto &values = std::get<1>(map.pixels);
      for (std::size_t i = 0; i < values.size(); i++) values[i] = i < values.size() / 4 ? 1.0f : 0.02f;
      set_sky_map(scene, std::move(map));
    }
    const Case made(std::move(scene));
    const Image &map = *made.scene().environment.map;
    const auto width = static_cast<std::size_t>(map.width), height = static_cast<std::size_t>(map.height);
    const std::vector<float> &cdf = made.flat(Layout::binary).environment_cdf;
    Shares shares;
    over_the_sky(map, [&](double v, double u, const Flux &radiance, double solid_angle) {
      const auto row = static_cast<std::size_t>(v * map.height), column = static_cast<std::size_t>(u * map.width), at = height + 1 + row * (width + 1) + column;
      const double chance = static_cast<double>(cdf[row + 1] - cdf[row]) * static_cast<double>(cdf[at + 1] - cdf[at]), cosine = std::cos(pi * v);
      const double asked = chance * map.width * map.height / (2 * pi * pi * std::sin(pi * v));
      shares.add(radiance * (cosine * solid_angle * floor_area), cosine / pi, asked, floor_area * cosine / disk * asked);
    });
    expect_shares(zenith ? "bright zenith" : "sky map", made, shares, zenith ? 128 : 64);
  }
}
TEST(Floor, SharesOfLights) {
  constexpr int n = 400;
  const auto over_the_floor = [&](const glm::dvec3 &from, const auto &visit) {
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        const glm::dvec3 to = glm::dvec3(half_floor * (2 * (i + 0.5) / n - 1), 0, half_floor * (2 * (j + 0.5) / n - 1)) - from;
        const double squared = glm::dot(to, to);
        visit(glm::normalize(to), from.y / std::sqrt(squared), squared, floor_area / (n * n));
      }
  };
  {
    Scene scene = floor_from_above();
    add_point_light(scene, {0.1f, 0.5f, -0.2f}, {4, 3, 2});
    Shares shares;
    over_the_floor({0.1, 0.5, -0.2}, [&](const glm::dvec3 &, double cosine, double squared, double area) {
      shares.add(Flux(4, 3, 2) * (cosine / squared * area), 0, 1, floor_area * cosine / squared / (4 * pi));
    });
    expect_shares("point light", Case(std::move(scene)), shares);
  }
  {
    Scene scene = floor_from_above();
    spot(scene);
    const Light &light = scene.lights[0];
    const double inner = std::cos(static_cast<double>(light.inner_angle)), outer = std::cos(static_cast<double>(light.outer_angle));
    Shares shares;
    over_the_floor(glm::dvec3(light.position), [&](const glm::dvec3 &to, double cosine, double squared, double area) {
      const double ramp = std::clamp((glm::dot(to, glm::dvec3(light.direction)) - outer) / (inner - outer), 0.0, 1.0);
      shares.add(Flux(light.intensity) * (ramp * ramp * cosine / squared * area), 0, 1, floor_area * cosine / squared / (2 * pi * (1 - outer)));
    });
    expect_shares("spot", Case(std::move(scene)), shares);
  }
  {
    Scene scene = floor_from_above();
    const Flux flux = sun(scene, floor_area);
    Shares shares;
    shares.add(flux, 0, 1, floor_area / std::sqrt(1.25) / disk);
    expect_shares("sun", Case(std::move(scene)), shares);
  }
}
TEST(Floor, SharesOfALamp) {
  Scene scene = floor_from_above();
  add(scene, quad({-0.2f, 0.5f, 0.1f}, {0.5f, 0, 0}, {0, 0, 0.7f}), lamp({3, 5, 4}));
  const Case made(std::move(scene));
  Shares shares;
  constexpr int n = 30;
  constexpr double lamp_area = 4 * 0.5 * 0.7;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      for (int k = 0; k < n; k++)
        for (int l = 0; l < n; l++) {
          const glm::dvec3 from(-0.2 + 0.5 * (2 * (i + 0.5) / n - 1), 0.5, 0.1 + 0.7 * (2 * (j + 0.5) / n - 1)), to(half_floor * (2 * (k + 0.5) / n - 1), 0, half_floor * (2 * (l + 0.5) / n - 1));
          const double squared = glm::dot(to - from, to - from), geometry = 0.25 / (squared * squared);  // both cosines are 0.5 / distance
          shares.add(Flux(3, 5, 4) * (geometry * lamp_area * floor_area / (1.0 * n * n * n * n)), geometry / pi, 1 / lamp_area, floor_area * geometry / pi / lamp_area);
        }
  expect_shares("lamp", made, shares);
}

TEST(Floor, ConstantSky) { expect_floor([](Scene &s) { return constant_sky(s, floor_area); }, {{"path", 32}, {"pure", 32}, {"bdpt", 32}, vcm(32)}); }
TEST(Floor, SkyOfManyColours) { expect_floor([](Scene &s) { return sky_of_many_colours(s, floor_area); }, {{"path", 128}, {"pure", 512}, {"distribution", 256, 0.001}, {"bdpt", 96}, vcm(96)}); }
TEST(Floor, Sun) { expect_floor([](Scene &s) { return sun(s, floor_area); }, {{"path", 16}, {"bdpt", 32}, vcm(32)}); }
TEST(Floor, SpotLight) { expect_floor(spot, {{"path", 64}, {"bdpt", 32}, vcm(32)}); }
TEST(Floor, PointLight) {
  const auto light = [](Scene &s) {
    add_point_light(s, {0.1f, 0.5f, -0.2f}, {4, 3, 2});
    constexpr int n = 1000;
    double sum = 0;
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) {
        const double x = half_floor * (2 * (i + 0.5) / n - 1) - 0.1, z = half_floor * (2 * (j + 0.5) / n - 1) + 0.2, squared = x * x + z * z + 0.25;
        sum += 0.5 / (squared * std::sqrt(squared)) / (n * n);
      }
    return Flux(4, 3, 2) * floor_area * sum;
  };
  expect_floor(light, {{"path", 32}, {"bdpt", 32}, vcm(32)});
}
TEST(Floor, QuadLamp) {
  const auto light = [](Scene &s) {
    add(s, quad({-0.2f, 0.5f, 0.1f}, {0.5f, 0, 0}, {0, 0, 0.7f}), lamp({3, 5, 4}));
    return Flux(3, 5, 4) * flux_of_quad(-0.2, 0.1, 0.5, 0.7, 0.5, half_floor);
  };
  expect_floor(light, {{"path", 32}, {"pure", 96}, {"bdpt", 32}, vcm(32)});
}

TEST(Bowl, ConstantSky) { expect_even([](Scene &s) { return constant_sky(s); }, {{"path", 128}, {"pure", 192}, {"bdpt", 64}, vcm(48), sppm(2, 65536)}); }
TEST(Bowl, SkyOfManyColours) { expect_even([](Scene &s) { return sky_of_many_colours(s); }, {{"path", 256}, {"pure", 512}, {"bdpt", 96}, vcm(48), sppm(3, 65536)}); }
TEST(Bowl, Sun) { expect_even([](Scene &s) { return sun(s); }, {{"path", 128}, {"bdpt", 48}, sppm(2, 32768)}); }
TEST(Bowl, PointLight) { expect_even(point, {{"path", 64}, {"bdpt", 32}, vcm(32), photon(24)}); }
TEST(Bowl, SpotLight) { expect_even(spot, {{"path", 128}, {"bdpt", 48}, sppm(2, 16384)}); }
TEST(Bowl, DiskLamp) { expect_even(disk_lamp, {{"path", 64}, {"pure", 256}, {"bdpt", 48}, vcm(32), photon(24)}); }
TEST(Bowl, QuadLamp) { expect_even(quad_lamp, {{"path", 64}, {"pure", 256}, {"bdpt", 48}, sppm(2, 16384)}); }
TEST(Bowl, ManyLights) { expect_even(many, {{"path", 128}, {"bdpt", 96}, vcm(48), sppm(2, 16384)}); }

// With its lid on, and shining itself: bounce n is albedo^n. There is no rim, so that photons are exact to a few tenths of a per cent.
TEST(Bowl, ClosedAndShining) {
  Scene scene = bowl();
  Material &clay = scene.materials[0];
  clay.alpha_mode = AlphaMode::opaque;
  clay.emission = {1, 1, 1};
  const Case made(std::move(scene));
  const std::vector<Work> runs{{"path", 32}, {"bdpt", 32}, vcm(32), {"sppm", 4, 0.0022, 3e-3, 16, 16384, 0.12f}, {"photon", 8, 0.002, 1e-3, 16, 65536, 0.05f}};
  for (const Work &run : runs) {
    SCOPED_TRACE(run.integrator);
    const std::vector<Film> films = films_of(made, run, 4);
    glm::vec3 expected(1);
    for (const std::string &layer : bounces(0, 4)) {
      EXPECT_EQ(differs(films, layer, whole(films[0]), expected, run.bias), "");
      EXPECT_LT(relative_error(films, layer), run.noise) << layer << " is too noisy to tell";
      expected *= albedo;
    }
  }
}

// A sample's radius is that of its number, by the schedule of [Knaus11]: the same bits as that radius asked for by itself.
TEST(Bowl, RadiusBySampleNumber) {
  Scene scene = bowl();
  point(scene);
  const Case made(std::move(scene));
  for (const char *integrator : {"sppm", "vcm"})
    for (const std::uint64_t sample : {0u, 1u, 6u}) {
      RenderSettings s = picture(16, 16, 3);
      s.integrator = integrator;
      s.radius = 0.2f;
      s.alpha = 0.7f;
      RenderSettings still = s;
      double share = 1;
      for (std::uint64_t i = 1; i <= sample; i++) share *= (static_cast<double>(i) + static_cast<double>(s.alpha)) / static_cast<double>(i + 1);
      still.radius = static_cast<float>(static_cast<double>(s.radius) * std::sqrt(share));
      still.alpha = 1;
      EXPECT_EQ(film_hash(render(made, s, {sample, sample + 1}).film), film_hash(render(made, still, {sample, sample + 1}).film)) << integrator << ", sample " << sample;
    }
}

// A lamp that rises while the shutter is open: what comes in is the mean over its way. Photons have times of their own, or share those of eye paths.
TEST(Bowl, ALightThatRises) {
  constexpr double from = 0.4, to = 1.6;
  const auto rising = [](Scene &scene) {
    scene.motion_steps = 2;
    add_point_light(scene, {0, static_cast<float>(from), 0}, {4, 3, 2});
    for (const double share : {0.5, 1.0}) scene.lights[0].keys.push_back({{0, static_cast<float>(from + (to - from) * share), 0}, {0, 0, -1}});
    return Flux(4, 3, 2) * 2.0 * pi * (1 - (std::sqrt(1 + to * to) - std::sqrt(1 + from * from)) / (to - from));
  };
  expect_even(rising, {{"path", 64}, {"bdpt", 32}, {"vcm", 256, 0.005, 1e-3, 8, 0, 0.07f}, {"sppm", 24, 0.015, 2e-3, 16, 4096, 0.1f}, photon(32)});
}

// Bowl, lamp and camera on their way together, unevenly: as if all stood still, where what is found of one walk by another has its time.
TEST(Bowl, CarriedAlong) {
  const auto carried = [](Scene &scene) {
    const Flux flux = point(scene);
    scene.motion_steps = 2;
    for (const glm::vec3 way : {glm::vec3(0.5f, 0.1f, 0.2f), glm::vec3(2, -0.3f, 0.7f)}) {
      scene.shapes[0].keys.push_back(scaled({1, 1, 1}, way));
      scene.cameras[0].keys.push_back(scene.cameras[0].transform);
      scene.cameras[0].keys.back()[3] += way;
      scene.lights[0].keys.push_back({scene.lights[0].position + way, {0, 0, -1}});
    }
    return flux;
  };
  expect_even(carried, {{"path", 64}, {"bdpt", 32}, vcm(32), sppm(3, 16384)});
}

// Closed, shining, and seen from its centre: all that a walk finds next lies evenly on the sphere, so that the strategies of a path are equally likely but for two things.
// Light leaves by either side, so that half of the light paths are lost; and those that end in the lens stand against camera rays, which are denser at the picture's corners.
TEST(Bowl, SharesOfStrategies) {
  Scene scene = bowl();
  scene.materials[0].alpha_mode = AlphaMode::opaque;
  scene.materials[0].emission = {1, 1, 1};
  scene.cameras.clear();
  add_camera(scene, {0, 0, 0}, {0.3f, -1, 0.2f}, 120);
  const Case made(std::move(scene));
  for (unsigned bounce = 1; bounce <= 3; bounce++)
    for (unsigned s = 0; s <= bounce + 1; s++) {
      const unsigned t = bounce + 2 - s;
      SCOPED_TRACE("strategy " + std::to_string(s) + "," + std::to_string(t));
      constexpr int n = 400;
      const double reach = std::tan(pi / 3);
      double share = 0;
      for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
          const double x = reach * (2 * (i + 0.5) / n - 1), y = reach * (2 * (j + 0.5) / n - 1);
          const double to_lens = 4 * reach * reach / std::pow(1 + x * x + y * y, 1.5) / (4 * pi);
          const double sent = s < 2 ? 1 : t > 1 ? 0.25 : 0.25 * to_lens * to_lens;  // squared
          share += sent / (2 + 0.25 * (bounce - 1) + 0.25 * to_lens * to_lens) / (n * n);
        }
      const std::vector<Film> films = films_of(made, {"bdpt", t == 1 ? 80u : 32u, 0.005, 1e-3, 16, 0, 0, s, t}, 3);
      const std::string layer = "bounce." + std::to_string(bounce);
      EXPECT_EQ(differs(films, layer, whole(films[0]), glm::pow(albedo, glm::vec3(static_cast<float>(bounce))) * static_cast<float>(share), 1e-3), "");
      EXPECT_LT(relative_error(films, layer), 0.005) << "is too noisy to tell";
    }
}

// Lit by a point at its centre, in a picture that is mostly beside it, so that paths of light reach the lens more often than camera rays reach the bowl.
// All that a walk finds next lies evenly on the sphere, so the strategies with an eye vertex are equally likely, and the one that ends in the lens weighs
// against them by how much of the picture a piece of the bowl takes up: less where it is steep.
TEST(Bowl, SharesBesideALargePicture) {
  constexpr double half = 2.5, area = 4 * half * half;
  Scene scene = bowl();
  add_point_light(scene, {0, 0, 0}, {4, 3, 2});
  scene.cameras[0] = from_above(half);
  const Case made(std::move(scene));
  glm::vec3 radiance = albedo * glm::vec3(4, 3, 2) / static_cast<float>(pi);
  for (unsigned bounce = 2; bounce <= 3; bounce++) {
    radiance *= albedo * 0.5f;
    for (unsigned s = 2; s <= bounce + 1; s++) {
      const unsigned t = bounce + 2 - s;
      SCOPED_TRACE("strategy " + std::to_string(s) + "," + std::to_string(t));
      constexpr int n = 10000;
      const double sent = area / (4 * pi) * area / (4 * pi);  // where the bowl is level, squared
      double share = 0;
      for (int i = 0; i < n; i++) {
        const double level = (i + 0.5) / n;  // the cosine, squared: in the picture it is evenly distributed
        share += (t > 1 ? level : sent) / (bounce * level + sent) / n;
      }
      const std::vector<Film> films = films_of(made, {"bdpt", bounce == 3 ? 112u : 48u, 0.005, 1e-3, 16, 0, 0, s, t}, bounce);
      const std::string layer = "bounce." + std::to_string(bounce);
      EXPECT_EQ(differs(films, layer, whole(films[0]), radiance * static_cast<float>(share * pi / area), 1e-3), "");
      EXPECT_LT(relative_error(films, layer), 0.005) << "is too noisy to tell";
    }
  }
}

// A closed sphere with a point light at its centre: a bounce is as bright as the one before, but for what the wall absorbs. Merging is likelier than
// joining, and as likely in one vertex as in another, so that weight is lost or won where a density of one of them is wrong.
TEST(Bowl, ClosedAroundALight) {
  Scene scene = bowl();
  scene.materials[0].alpha_mode = AlphaMode::opaque;
  add_point_light(scene, {0, 0, 0}, {4, 3, 2});
  const Case made(std::move(scene));
  const std::vector<Film> films = films_of(made, {"vcm", 5, 0.0015, 1e-3, 64, 0, 0.05f}, 3);
  glm::vec3 expected = albedo * glm::vec3(4, 3, 2) / static_cast<float>(pi);
  for (const std::string &layer : bounces(2, 3)) {
    expected *= albedo;
    EXPECT_EQ(differs(films, layer, whole(films[0]), expected, 1e-3), "");
    EXPECT_LT(relative_error(films, layer), 0.0015) << layer << " is too noisy to tell";
  }
}

}  // namespace sunstone::test
