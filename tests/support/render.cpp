// SPDX-License-Identifier: Apache-2.0
#include "support/render.h"

#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <tuple>

#include "base/error.h"
#include "flatten/camera.h"
#include "import/import.h"
#include "scene/default_view.h"
#include "scene/validate.h"
#include "support/statistics.h"

namespace sunstone::test {

namespace {

// What outlives a test: opened devices and compiled programs. Leaked on purpose, since a driver may be gone before static objects are destroyed.
struct Kept {
  std::map<std::size_t, Device> devices;
  std::map<std::tuple<std::size_t, unsigned, Layout, bool, unsigned, unsigned, int>, std::unique_ptr<Programs>> programs;
};

Kept &kept() {
  static Kept *all = new Kept;
  return *all;
}

const Programs &programs_for(const Variant &v, std::size_t work_group) {
  const unsigned features = (v.passable ? 1u : 0u) | (v.specular ? 2u : 0u) | (v.textures ? 4u : 0u) | (v.branching ? 8u : 0u) | (v.bidirectional ? 16u : 0u) | (v.shapes ? 32u : 0u) | (v.light_map ? 64u : 0u) | (v.photons ? 128u : 0u) |
                            (v.few_shapes ? 256u : 0u) | (v.triangles ? 512u : 0u);
  auto &found = kept().programs[{work_group, v.lanes, v.layout, v.columns, v.chunk, features, v.motion}];
  if (!found) found = std::make_unique<Programs>(test_device(work_group), v);
  return *found;
}

Variant variant_of(const Case &scene, const RenderSettings &settings, const Ways &ways) {
  Variant v = device_variant(test_device(ways.work_group).info());
  v = integrator_variant(v, settings);
  v.lanes = ways.lanes.value_or(v.lanes);
  v.layout = ways.layout.value_or(v.layout);
  v.columns = ways.columns.value_or(v.columns);
  v.chunk = ways.chunk.value_or(v.chunk);
  v.motion = ways.motion.value_or(scene.flat(v.layout).motion());
  if (ways.trimmed) v = scene_variant(v, scene.flat(v.layout), settings);
  v.few_shapes = ways.few_shapes.value_or(v.few_shapes);
  return v;
}

Renderer renderer_of(const Case &scene, const RenderSettings &settings, const Ways &ways, const kernel::Camera *camera = nullptr) {
  const Variant variant = variant_of(scene, settings, ways);
  const FlatScene &flat = scene.flat(variant.layout);
  return {test_device(ways.work_group), programs_for(variant, ways.work_group), flat, camera ? *camera : scene.camera(settings.width, settings.height), settings, Tuning{ways.pool, variant.lanes}};
}

}  // namespace

std::vector<std::pair<std::string, Ways>> other_ways() {
  std::vector<std::pair<std::string, Ways>> all(8);
  all[0] = {"binary", {}}, all[0].second.layout = Layout::binary;
  all[1] = {"wide8", {}}, all[1].second.layout = Layout::wide8;
  all[2] = {"lanes 1", {}}, all[2].second.lanes = 1;
  all[3] = {"lanes 8", {}}, all[3].second.lanes = 8;
  all[4] = {"pool 16", {}}, all[4].second.pool = 16;
  all[5] = {"work-groups of 1", {}}, all[5].second.work_group = 1;
  all[6] = {"trimmed", {}}, all[6].second.trimmed = true;
  all[7] = {"columns", {}}, all[7].second.columns = true;
  return all;
}

const Device &test_device(std::size_t work_group) {
  auto &devices = kept().devices;
  const auto found = devices.find(work_group);
  if (found != devices.end()) return found->second;
  Notices notices;
  const char *wanted = std::getenv("SUNSTONE_TEST_DEVICE");
  const DeviceInfo info = choose_device(list_devices(notices), wanted ? wanted : "");
  return devices.emplace(work_group, Device(info, {0, false, work_group})).first->second;
}

Case::Case(Scene scene) : scene_(std::move(scene)) {
  Notices notices;
  validate(scene_, "test scene", notices);
  if (!notices.all().empty()) throw std::logic_error("a test's scene is not clean: " + notices.all()[0].place + ": " + notices.all()[0].text);
}

Case Case::file(const std::filesystem::path &path) {
  Notices notices;
  return Case(import_scene(path, {}, notices));
}

const FlatScene &Case::flat(Layout layout) const {
  const auto found = flat_.find(layout);
  if (found != flat_.end()) return found->second;
  FlattenOptions options;
  options.layout = layout;
  options.max_page_bytes = test_device().info().max_allocation;
  Notices notices;
  return flat_.emplace(layout, flatten(scene_, options, notices)).first->second;
}

kernel::Camera Case::camera(int width, int height) const {
  if (!scene_.cameras.empty())
    for (auto &[layout, flat] : flat_) flat.camera_keys = flatten_camera_keys(scene_.cameras[0], width, height, flatten_camera);
  if (scene_.cameras.empty()) return flatten_camera(default_camera(scene_, static_cast<float>(width) / static_cast<float>(height)), width, height);
  return flatten_camera(scene_.cameras[0], width, height);
}

RenderSettings picture(int width, int height, unsigned max_depth) {
  RenderSettings s;
  s.width = s.x1 = width;
  s.height = s.y1 = height;
  s.max_depth = max_depth;
  s.layers.bounces = true;
  return s;
}

Filter box_filter() { return {Filter::Kind::box, 0.5f}; }

Rendered render(const Case &scene, const RenderSettings &settings, SampleRange samples, const Ways &ways, const std::function<bool(const RenderProgress &)> &progress,
                const kernel::Camera *camera) {
  Renderer renderer = renderer_of(scene, settings, ways, camera);
  renderer.render(samples, progress);
  return {renderer.film(), renderer.counts()};
}

std::vector<kernel::uint> show(const Case &scene, const RenderSettings &settings, std::span<const kernel::Camera> cameras, float scale, const Ways &ways) {
  const Renderer renderer = renderer_of(scene, settings, ways);
  Display display = renderer.display();
  for (const kernel::Camera &camera : cameras) display.show(camera, scale);
  return display.shown();
}

std::array<std::vector<std::int64_t>, 2> render_twice(const Case &scene, const RenderSettings &settings, std::uint64_t sample) {
  Renderer renderer = renderer_of(scene, settings, {});
  const SampleRange alone{sample, sample + 1};
  renderer.render(alone, {});
  std::vector<std::int64_t> first;
  for (const FilmLayer &layer : renderer.film().layers) first.insert(first.end(), layer.values.begin(), layer.values.end());
  StageProbe again = renderer.probe(alone);
  std::vector<kernel::uint> counts;
  do {
    again.warm_up(1);
    counts = again.save().counts;
  } while (counts[SUN_COUNT_LIVE] != 0 || counts[SUN_COUNT_NEXT_PATH] < counts[SUN_COUNT_PATHS]);
  return {first, again.film()};
}

Twice render_more(const Case &scene, const RenderSettings &settings, SampleRange samples, SampleRange more) {
  Renderer renderer = renderer_of(scene, settings, {});
  renderer.render(samples, {});
  Twice twice{renderer.film(), {}, renderer.counts(), {}, ""};
  try {
    renderer.render(more, {});
  } catch (const Error &error) {
    twice.refused = error.what();
  }
  twice.then = renderer.film();
  twice.counted_then = renderer.counts();
  return twice;
}

std::string refusal(const Case &scene, const RenderSettings &settings) {
  try {
    render(scene, settings, {0, 1});
  } catch (const UsageError &error) {
    return error.place;
  }
  return "";
}

std::vector<Film> render_seeds(const Case &scene, RenderSettings settings, std::uint64_t samples, std::uint32_t seeds, const Ways &ways) {
  std::vector<Film> films;
  settings.independent = true;
  for (std::uint32_t seed = 1; seed <= seeds; seed++) {
    settings.seed = seed;
    films.push_back(render(scene, settings, {0, samples}, ways).film);
  }
  return films;
}

Window whole(const Film &film) { return {film.x0, film.y0, film.x1, film.y1}; }

double mean(const Film &film, const std::string &layer, const Window &w, int channel) {
  if (layer == "beauty") return mean(film, "beauty.even", w, channel) + mean(film, "beauty.odd", w, channel);
  const FilmLayer *found = film.find(layer);
  if (!found) throw std::logic_error("the film has no layer " + layer);
  double sum = 0;
  for (int y = w.y0; y < w.y1; y++)
    for (int x = w.x0; x < w.x1; x++)
      sum += film_value(film, *found, static_cast<std::size_t>(y - film.y0) * static_cast<std::size_t>(film.width()) + static_cast<std::size_t>(x - film.x0), channel);
  return sum / (static_cast<double>(w.x1 - w.x0) * static_cast<double>(w.y1 - w.y0));
}

std::vector<double> means(const std::vector<Film> &films, const std::string &layer, const Window &window, int channel) {
  std::vector<double> values;
  for (const Film &film : films) values.push_back(mean(film, layer, window, channel));
  return values;
}

std::string differs(const std::vector<Film> &films, const std::string &layer, const Window &window, const glm::vec3 &expected, double rounding) {
  std::string text;
  for (int channel = 0; channel < 3; channel++) {
    const Moments m = moments(means(films, layer, window, channel));
    const double allowed = rounding * std::abs(static_cast<double>(expected[channel])) + 1e-9 + (films.size() > 1 ? interval(m, 1e-9) : 0.0);
    if (!(std::abs(m.mean - static_cast<double>(expected[channel])) <= allowed))
      text += layer + " channel " + std::to_string(channel) + ": expected " + std::to_string(expected[channel]) + ", is " + std::to_string(m.mean) + " +- " + std::to_string(allowed) + "; ";
  }
  return text;
}

}  // namespace sunstone::test
