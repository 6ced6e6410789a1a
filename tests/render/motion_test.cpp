// SPDX-License-Identifier: Apache-2.0
// What moves while the shutter is open: against a closed form, against the mean of still pictures, one integrator against another, and one film hash whatever the
// ways. All statistical tests of this file together are Holm-corrected to a false alarm in 10^6 runs.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/moment.h"
#include "support/agree.h"
#include "support/scenes.h"

namespace sunstone::test {
namespace {

constexpr double false_alarms = 1e-6 / 20;  // of one comparison: there are fewer than 20
constexpr unsigned steps = 4;

glm::mat4x3 turned(glm::vec3 axis, float angle, glm::vec3 offset, glm::vec3 scale = {1, 1, 1}) {
  const glm::vec3 a = glm::normalize(axis);
  const float c = std::cos(angle), s = std::sin(angle);
  glm::mat4x3 m(1);
  for (int column = 0; column < 3; column++) {
    glm::vec3 e(0);
    e[column] = scale[column];
    m[column] = e * c + glm::cross(a, e) * s + a * (glm::dot(a, e) * (1 - c));
  }
  m[3] = offset;
  return m;
}

// Everything that moves, in each way that there is: a turning box with flat faces, a growing ball of triangles, a sheet that bends, a rolling analytic sphere, an
// emissive panel that slides, turns and grows (mirrored, so that its front is at stake), a second lamp that bends, a point and a spot light, and the camera.
Scene moving_scene(bool punctual) {
  Scene scene;
  scene.motion_steps = steps;
  add(scene, quad({0, 0, 0}, {2.2f, 0, 0}, {0, 0, -2.2f}), matt({0.7f, 0.5f, 0.3f}));
  add(scene, quad({0, 1.5f, -2}, {2.2f, 0, 0}, {0, 1.5f, 0}), matt({0.4f, 0.6f, 0.8f}));
  const auto move = [&](std::vector<glm::mat4x3> &keys, glm::mat4x3 &first, auto &&way) {
    first = way(0.0f);
    for (unsigned key = 1; key <= steps; key++) keys.push_back(way(static_cast<float>(key) / steps));
  };
  const auto moving = [&](Primitive primitive, const Material &material, auto &&way) {
    add(scene, std::move(primitive), material);
    move(scene.instances.back().keys, scene.instances.back().transform, way);
  };
  moving(box({-0.4f, -0.4f, -0.4f}, {0.4f, 0.4f, 0.4f}), matt({0.6f, 0.6f, 0.6f}), [](float t) { return turned({0.2f, 1, 0.1f}, 1.2f * t, {-0.9f + 0.3f * t, 0.55f, -0.3f}); });
  moving(sphere({0, 0, 0}, 0.4f, 10), metal({0.9f, 0.7f, 0.5f}, 0.5f), [](float t) {
    return turned({0, 0, 1}, 0.5f * t, {0.7f, 0.5f + 0.2f * t, 0.2f}, {0.6f + 0.5f * t, 0.8f, 1 - 0.4f * t});
  });
  moving(quad({0, 0, 0}, {0.5f, 0, 0}, {0, 0, 0.4f}), lamp({5, 4, 3}), [](float t) { return turned({0, 0, 1}, 0.6f * t - 0.3f, {-0.8f + 1.2f * t, 2.2f, 0.4f}, {-0.6f - 0.6f * t, 1, 1}); });
  const auto bends = [&](Primitive p, auto &&bend) {
    const std::vector<glm::vec3> rest = p.positions;
    const auto set = [&](std::vector<glm::vec3> &positions, float t) {
      positions = rest;
      for (glm::vec3 &position : positions) position += bend(position) * t;
    };
    for (unsigned key = 1; key <= steps; key++) {
      PrimitiveKey moved;
      set(moved.positions, static_cast<float>(key) / steps);
      for (const glm::vec3 &normal : p.normals) moved.normals.push_back(glm::normalize(normal + glm::vec3(0.3f, 0.2f, 0.1f) * (static_cast<float>(key) / steps)));
      p.keys.push_back(std::move(moved));
    }
    return p;
  };
  add(scene, bends(quad({0.2f, 0.3f, 0.9f}, {0.4f, 0, 0}, {0, 0.3f, 0}), [](glm::vec3 p) { return glm::vec3(0.3f * p.y, 0.2f * p.x, 0.5f * p.x * p.y); }), matt({0.8f, 0.3f, 0.5f}));
  add(scene, bends(quad({1.6f, 1.2f, 0}, {0, 0, 0.2f}, {0, 0.3f, 0}), [](glm::vec3 p) { return glm::vec3(-0.4f * p.y, 0.2f * p.z, 0.1f); }), lamp({3, 5, 4}));
  scene.materials.push_back(matt({0.3f, 0.7f, 0.4f}));
  Shape ball{Shape::Kind::sphere, "ball", static_cast<int>(scene.materials.size()) - 1, glm::mat4x3(1)};
  move(ball.keys, ball.transform, [](float t) { return turned({0, 0, 1}, -1.5f * t, {-0.2f + 0.8f * t, 0.26f, 1.3f}, {0.25f, 0.25f, 0.25f}); });
  scene.shapes.push_back(ball);
  if (punctual) {
    add_point_light(scene, {-1.5f, 1.6f, 1.2f}, {2, 2.5f, 3});
    scene.lights.push_back(spot_light());
    for (unsigned key = 1; key <= steps; key++) {
      const float t = static_cast<float>(key) / steps;
      scene.lights[0].keys.push_back({{-1.5f + t, 1.6f + 0.3f * t, 1.2f}, {0, 0, -1}});
      scene.lights[1].keys.push_back({{1.5f, 2.2f, 1.5f}, glm::normalize(glm::vec3(-0.5f - 0.5f * t, -0.7f, -0.6f + 0.4f * t))});
    }
  }
  set_sky(scene, {0.2f, 0.25f, 0.3f});
  add_camera(scene, {0.3f, 1.4f, 4}, {0, 0.6f, 0}, 42);
  for (unsigned key = 1; key <= steps; key++) {
    const float t = static_cast<float>(key) / steps;
    Scene other;
    add_camera(other, {0.3f + 0.4f * t, 1.4f - 0.1f * t, 4}, {0.1f * t, 0.6f, 0}, 42);
    scene.cameras[0].keys.push_back(other.cameras[0].transform);
  }
  return scene;
}

// The scene as it stands at one time.
Scene at_time(const Scene &scene, float time) {
  Scene still = scene;
  still.motion_steps = 0;
  const float scaled = time * static_cast<float>(scene.motion_steps);
  const auto step = static_cast<std::size_t>(scaled);
  const float blend = scaled - static_cast<float>(step);
  const auto take = [&](glm::mat4x3 &transform, std::vector<glm::mat4x3> &keys) {
    if (keys.empty()) return;
    const glm::mat4x3 &a = step ? keys[step - 1] : transform, &b = keys[step];
    transform = a + (b - a) * blend;
    keys.clear();
  };
  for (Instance &instance : still.instances) take(instance.transform, instance.keys);
  for (Shape &shape : still.shapes) take(shape.transform, shape.keys);
  for (Camera &camera : still.cameras) {
    take(camera.transform, camera.keys);
    const glm::vec3 back = glm::normalize(camera.transform[2]), right = glm::normalize(camera.transform[0] - back * glm::dot(back, camera.transform[0]));
    camera.transform = {right, glm::cross(back, right), back, camera.transform[3]};
  }
  for (Light &light : still.lights) {
    if (light.keys.empty()) continue;
    const LightKey a = step ? light.keys[step - 1] : LightKey{light.position, light.direction}, b = light.keys[step];
    light.position = a.position + (b.position - a.position) * blend;
    light.direction = glm::normalize(a.direction + (b.direction - a.direction) * blend);
    light.keys.clear();
  }
  for (Mesh &mesh : still.meshes)
    for (Primitive &p : mesh.primitives) {
      if (p.keys.empty()) continue;
      const std::vector<glm::vec3> first = p.positions, normals = p.normals;
      for (std::size_t i = 0; i < first.size(); i++) {
        const glm::vec3 a = step ? p.keys[step - 1].positions[i] : first[i], b = p.keys[step].positions[i];
        p.positions[i] = a + (b - a) * blend;
        const glm::vec3 from = step ? p.keys[step - 1].normals[i] : normals[i], to = p.keys[step].normals[i];
        p.normals[i] = glm::normalize(from + (to - from) * blend);
      }
      p.keys.clear();
    }
  return still;
}

// One film a seed: the mean of still pictures at times that are spread over the shutter's, evenly but for a random place within each part.
std::vector<Film> render_stills(const Scene &scene, RenderSettings settings, unsigned times, std::uint64_t samples, std::uint32_t seeds) {
  std::vector<Film> films;
  settings.independent = true;
  std::mt19937 random(11);
  for (std::uint32_t seed = 1; seed <= seeds; seed++) {
    Film sum;
    for (unsigned k = 0; k < times; k++) {
      settings.seed = 1000 + seed * times + k;
      const float time = (static_cast<float>(k) + static_cast<float>(random() >> 8) * 0x1p-24f) / static_cast<float>(times);
      const Film film = render(Case(at_time(scene, time)), settings, {0, samples}).film;
      if (k == 0) {
        sum = film;
        continue;
      }
      for (std::size_t layer = 0; layer < sum.layers.size(); layer++)
        for (std::size_t i = 0; i < sum.layers[layer].values.size(); i++) sum.layers[layer].values[i] += film.layers[layer].values[i];
    }
    sum.samples = {{0, samples * times}};
    films.push_back(std::move(sum));
  }
  return films;
}

const Case &everything_moves() {
  static const Case *const made = new Case(moving_scene(true));
  return *made;
}

}  // namespace

// A lamp of width 0.6 slides by 1.2 to the right before a dark sky. A place is lit while it is between its edges: a trapezoid, whatever the number of steps.
TEST(Motion, AnEdgeBlursInAStraightLine) {
  for (const bool deforming : {false, true})
    for (const unsigned n : {1u, 8u}) {
      Scene scene;
      scene.motion_steps = n;
      Primitive panel = quad({-0.6f, 0, 0}, {0.3f, 0, 0}, {0, 2, 0});
      for (unsigned key = 1; deforming && key <= n; key++) {
        PrimitiveKey moved{panel.positions, panel.normals, {}};
        for (glm::vec3 &position : moved.positions) position.x += 1.2f * static_cast<float>(key) / static_cast<float>(n);
        panel.keys.push_back(std::move(moved));
      }
      add(scene, panel, lamp({1, 2, 3}));
      for (unsigned key = 1; !deforming && key <= n; key++) scene.instances[0].keys.push_back(scaled({1, 1, 1}, {1.2f * static_cast<float>(key) / static_cast<float>(n), 0, 0}));
      add_flat_camera(scene, {0, 0, 2}, 1);
      const Case moving(std::move(scene));
      RenderSettings settings = picture(16, 16, 0);
      settings.filter = box_filter();
      const std::vector<Film> films = render_seeds(moving, settings, 64, 16);
      for (int column = 0; column < 16; column++) {
        // The mean of the trapezoid over the pixel.
        double lit = 0;
        constexpr int parts = 4000;
        for (int i = 0; i < parts; i++) {
          const double x = -1 + 2.0 * (column + (i + 0.5) / parts) / 16;
          lit += std::max(0.0, std::min(1.0, (x + 0.9) / 1.2) - std::max(0.0, (x + 0.3) / 1.2)) / parts;
        }
        EXPECT_EQ(differs(films, "beauty", {column, 0, column + 1, 16}, glm::vec3(1, 2, 3) * static_cast<float>(lit), 1e-4), "") << "column " << column << ", " << n << " steps" << (deforming ? ", deforming" : "");
      }
    }
}

TEST(Motion, IsTheMeanOfStillPictures) {
  RenderSettings settings = picture(24, 16, 2);
  constexpr std::uint32_t seeds = 24;
  const std::vector<Film> stills = render_stills(everything_moves().scene(), settings, 12, 8, seeds);
  const std::vector<Film> films = render_seeds(everything_moves(), settings, 160, seeds);
  const Agreement agree = agreement(films, stills, bounces(0, 2), 4, false_alarms);
  EXPECT_EQ(agree.rejected, 0u) << "of " << agree.means << " means:" << agree.what;
  EXPECT_LT(relative_error(films, "bounce.1"), 0.008) << "too noisy to tell";
  EXPECT_LT(relative_error(stills, "bounce.1"), 0.012) << "too noisy to tell";
  // A test that sees no motion cannot fail.
  const std::vector<Film> begun = render_seeds(Case(at_time(everything_moves().scene(), 0)), settings, 160, 4);
  const std::vector<Film> four(films.begin(), films.begin() + 4);
  EXPECT_GT(std::abs(mean(begun[0], "bounce.1", whole(begun[0]), 1) - mean(films[0], "bounce.1", whole(films[0]), 1)), 0.02 * mean(films[0], "bounce.1", whole(films[0]), 1));
}

TEST(Motion, IntegratorsAgree) {
  const Case scene(moving_scene(false));
  RenderSettings settings = picture(24, 16, 3);
  constexpr std::uint32_t seeds = 32;
  const std::vector<Film> reference = render_seeds(scene, settings, 64, seeds);
  EXPECT_LT(relative_error(reference, "bounce.1"), 0.01) << "path is too noisy to tell";
  for (const char *name : {"pure", "bdpt", "hybrid"}) {
    settings.integrator = name;
    const std::vector<Film> films = render_seeds(scene, settings, name == std::string("pure") ? 192 : 64, seeds);
    const Agreement agree = agreement(reference, films, bounces(0, settings.max_depth), 8, false_alarms);
    EXPECT_EQ(agree.rejected, 0u) << name << ": of " << agree.means << " means:" << agree.what;
    EXPECT_LT(relative_error(films, "bounce.1"), 0.015) << name << " is too noisy to tell";
  }
}

// Lights without extent, which only shadow rays and light subpaths know; and the lens from both sides.
TEST(Motion, LightSubpathsKnowOfIt) {
  RenderSettings settings = picture(24, 16, 2);
  constexpr std::uint32_t seeds = 32;
  const std::vector<Film> reference = render_seeds(everything_moves(), settings, 64, seeds);
  settings.integrator = "bdpt";
  const std::vector<Film> films = render_seeds(everything_moves(), settings, 64, seeds);
  const Agreement agree = agreement(reference, films, bounces(0, 2), 8, false_alarms);
  EXPECT_EQ(agree.rejected, 0u) << "of " << agree.means << " means:" << agree.what;
  // Splats alone, as if there were nothing else: all light of the first bounce, by the moving camera's own measure.
  settings.strategy_s = 2;
  settings.strategy_t = 1;
  settings.unweighted = true;
  const std::vector<Film> splats = render_seeds(everything_moves(), settings, 512, seeds);
  const Agreement alone = agreement(reference, splats, {"bounce.1"}, 8, false_alarms);
  EXPECT_EQ(alone.rejected, 0u) << "splats: of " << alone.means << " means:" << alone.what;
  EXPECT_LT(relative_error(splats, "bounce.1"), 0.01) << "splats are too noisy to tell";
}

TEST(Motion, OneHashWhateverTheWays) {
  RenderSettings settings = picture(24, 16, 4);
  settings.layers.albedo = settings.layers.normal = settings.layers.depth = settings.layers.position = settings.layers.object = true;
  constexpr SampleRange samples{0, 2};
  for (const char *name : {"path", "bdpt", "distribution", "whitted"}) {
    settings.integrator = name;
    settings.indirect_samples = name == std::string("distribution") ? 2 : 1;
    const auto hashes = [&](const Ways &ways) {
      const Film film = render(everything_moves(), settings, samples, ways).film;
      std::string all = film_hash(film).hex();
      for (const FilmLayer &layer : film.layers) all += " " + layer_hash(film, layer).hex();
      return all;
    };
    const std::string expected = hashes({});
    for (const auto &[layout, lanes] : {std::pair{Layout::binary, 1u}, {Layout::wide8, 8u}, {Layout::wide16, 16u}}) {
      Ways ways;
      ways.layout = layout;
      ways.lanes = lanes;
      ways.columns = lanes == 1;
      ways.trimmed = lanes == 8;
      EXPECT_EQ(hashes(ways), expected) << name << ", " << layout_name(layout) << ", lanes " << lanes;
    }
    Ways ways;
    ways.pool = 48;
    EXPECT_EQ(hashes(ways), expected) << name << ", pool";
  }
}

// Programs that know of motion give a still scene the bits that it has without.
TEST(Motion, StillScenesKeepTheirBits) {
  const Case scene(everything());
  RenderSettings settings = picture(32, 24, 6);
  for (const char *name : {"path", "bdpt"}) {
    settings.integrator = name;
    Ways ways;
    const Hash still = film_hash(render(scene, settings, {0, 2}, ways).film);
    for (const int motion : {1, 2}) {
      ways.motion = motion;
      EXPECT_EQ(film_hash(render(scene, settings, {0, 2}, ways).film), still) << name << ", SUN_MOTION " << motion;
    }
  }
}

// Times of samples: spread over all of the shutter's, other ones in other pixels unless one is asked for, and never that of the end.
TEST(Motion, TimesOfSamples) {
  kernel::Frame frame{};
  frame.seed = 3;
  frame.motion_steps = 8;
  const auto time = [&](kernel::uint x, kernel::uint sample) {
    const kernel::SamplerKey key = kernel::sampler_key(frame.seed, x, 5, sample, SUN_SAMPLER_SOBOL);
    return kernel::sample_moment(&frame, &key);
  };
  std::vector<int> eighths(8);
  int alike = 0;
  for (kernel::uint sample = 0; sample < 64; sample++) {
    const kernel::Moment moment = time(1, sample);
    eighths.at(moment.step)++;
    EXPECT_GE(moment.blend, 0.0f);
    EXPECT_LT(moment.blend, 1.0f);
    EXPECT_EQ((static_cast<float>(moment.step) + moment.blend) / 8, moment.time);
    alike += moment.time == time(2, sample).time;
  }
  for (const int count : eighths) EXPECT_EQ(count, 8) << "a (0,1)-sequence";
  EXPECT_LT(alike, 3);
  frame.flags = SUN_FRAME_ONE_TIME;
  for (kernel::uint sample = 0; sample < 64; sample++) EXPECT_EQ(time(1, sample).time, time(2, sample).time);
  EXPECT_NE(time(1, 0).time, time(1, 1).time);
}

// A panel that shines to one side shrinks to nothing and grows again as its own mirror image: its front stays its front. A place is covered while the panel is wide enough.
TEST(Motion, AMirroredFrontStaysTheFront) {
  Scene scene;
  scene.motion_steps = 1;
  add(scene, quad({0, 0, 0}, {0.8f, 0, 0}, {0, 2, 0}), lamp({1, 2, 3}));
  scene.instances[0].keys.push_back(scaled({-1, 1, 1}, {0, 0, 0}));
  add_flat_camera(scene, {0, 0, 2}, 1);
  const Case moving(std::move(scene));
  RenderSettings settings = picture(16, 16, 0);
  settings.filter = box_filter();
  const std::vector<Film> films = render_seeds(moving, settings, 64, 16);
  for (int column = 0; column < 16; column++) {
    // 1 - |x| / 0.8, its mean over the pixel.
    const double nearer = std::abs(column - 7.5) / 8 - 1.0 / 16, farther = nearer + 1.0 / 8, end = std::min(farther, 0.8);
    const double lit = end > nearer ? ((end - nearer) - (end * end - nearer * nearer) / 1.6) * 8 : 0;
    EXPECT_EQ(differs(films, "beauty", {column, 0, column + 1, 16}, glm::vec3(1, 2, 3) * static_cast<float>(lit), 1e-4), "") << "column " << column;
  }
}

}  // namespace sunstone::test
