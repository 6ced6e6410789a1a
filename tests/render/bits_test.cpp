// SPDX-License-Identifier: Apache-2.0
// One film hash, whatever the ways: how the work is cut, ordered, laid out or interrupted never changes a bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/render.h"
#include "support/scenes.h"

namespace sunstone::test {
namespace {

const Case &scene() {
  static const Case *const made = new Case(everything());
  return *made;
}

RenderSettings settings() {
  RenderSettings s = picture(48, 32, 8);
  s.layers.albedo = s.layers.normal = s.layers.depth = s.layers.position = s.layers.object = s.layers.material = s.layers.alpha = true;
  return s;
}

constexpr SampleRange samples{0, 4};

// Every layer, and the beauty, as text: what differs shows by name.
std::map<std::string, std::string> hashes(const Film &film) {
  std::map<std::string, std::string> all;
  all["film"] = film_hash(film).hex();
  for (const FilmLayer &layer : film.layers) all[layer.name] = layer_hash(film, layer).hex();
  return all;
}

const Rendered &reference() {
  static const Rendered *const made = new Rendered(render(scene(), settings(), samples));
  return *made;
}

void expect_same(const Film &film, const std::string &how) {
  const auto expected = hashes(reference().film), got = hashes(film);
  for (const auto &[name, hash] : expected) EXPECT_EQ(got.at(name), hash) << how << ": layer " << name;
  EXPECT_EQ(film.clamped, reference().film.clamped) << how;
  EXPECT_EQ(film.nan, reference().film.nan) << how;
}

}  // namespace

// The hashes mean something only if the picture holds what it should.
TEST(Bits, TheSceneShowsWhatItIsMadeOf) {
  const Film &film = reference().film;
  EXPECT_EQ(film.nan, 0u);
  for (int channel = 0; channel < 3; channel++) EXPECT_GT(mean(film, "beauty", whole(film), channel), 0.1);
  for (const char *layer : {"bounce.0", "bounce.1", "bounce.2", "bounce.8", "albedo", "Z", "position", "object_id", "material_id", "alpha"})
    EXPECT_NE(mean(film, layer, whole(film), 1), 0.0) << layer;
  const FlatScene &flat = scene().flat(Layout::binary);
  EXPECT_TRUE(flat.has_passable && flat.has_specular && flat.has_textures);
  EXPECT_GT(flat.instances.size(), 1u);
  EXPECT_GT(flat.fragments.size(), 2u) << "no triangle is in pieces";
  bool mirrored = false, identity = false;
  for (const kernel::Instance &instance : flat.instances) {
    mirrored = mirrored || (instance.flags & SUN_INSTANCE_MIRRORED);
    identity = identity || (instance.flags & SUN_INSTANCE_IDENTITY);
  }
  EXPECT_TRUE(mirrored && identity);
}

TEST(Bits, TwiceInARow) { expect_same(render(scene(), settings(), samples).film, "again"); }

// What a renderer keeps of a sample, such as a map of its light, must not leave anything out of the next film.
TEST(Bits, TwiceByOneRenderer) {
  for (const char *name : {"path", "bdpt", "sppm", "photon", "vcm"}) {
    RenderSettings s = picture(24, 16, 4);
    s.integrator = name;
    s.layers.albedo = true;
    const auto films = render_twice(scene(), s, 0);
    EXPECT_EQ(films[0] == films[1], true) << name;
    EXPECT_GT(std::ranges::count_if(films[0], [](std::int64_t value) { return value != 0; }), 24 * 16) << name << ": the film is empty";
  }
}

TEST(Bits, AnotherSeedIsAnotherPicture) {
  RenderSettings other = settings();
  other.seed = 1;
  EXPECT_NE(film_hash(render(scene(), other, samples).film), film_hash(reference().film));
}

TEST(Bits, PoolSizes) {
  for (const unsigned pool : {16u, 64u, 1000u, 65536u}) {
    Ways ways;
    ways.pool = pool;
    expect_same(render(scene(), settings(), samples, ways).film, "pool " + std::to_string(pool));
  }
}

TEST(Bits, WorkGroupSizes) {
  for (const std::size_t size : {std::size_t{1}, std::size_t{16}, std::size_t{256}}) {
    Ways ways;
    ways.work_group = size;
    expect_same(render(scene(), settings(), samples, ways).film, "work-groups of " + std::to_string(size));
  }
}

TEST(Bits, Layouts) {
  for (const Layout layout : {Layout::binary, Layout::wide8, Layout::wide16}) {
    Ways ways;
    ways.layout = layout;
    EXPECT_EQ(scene().flat(layout).scene_hash, scene().flat(Layout::binary).scene_hash);
    expect_same(render(scene(), settings(), samples, ways).film, layout_name(layout));
  }
}

TEST(Bits, Lanes) {
  for (const unsigned lanes : {1u, 8u, 16u}) {
    Ways ways;
    ways.lanes = lanes;
    expect_same(render(scene(), settings(), samples, ways).film, "lanes " + std::to_string(lanes));
  }
}

TEST(Bits, ColumnsAndChunks) {
  Ways ways;
  ways.columns = true;
  ways.lanes = 1;
  ways.layout = Layout::binary;
  ways.chunk = 64;
  expect_same(render(scene(), settings(), samples, ways).film, "columns, as on a GPU");
  ways = {};
  ways.columns = true;
  expect_same(render(scene(), settings(), samples, ways).film, "columns");
  for (const unsigned chunk : {64u, 256u}) {
    ways = {};
    ways.chunk = chunk;
    ways.pool = 3000;
    expect_same(render(scene(), settings(), samples, ways).film, "chunks of " + std::to_string(chunk));
  }
}

TEST(Bits, CodeThatASceneDoesNotNeedIsLeftOut) {
  const Case cornell = Case::file(scene_file("cornell/cornell.gltf"));
  const RenderSettings s = picture(24, 24, 5);
  Ways trimmed;
  trimmed.trimmed = true;
  EXPECT_EQ(hashes(render(cornell, s, samples, trimmed).film), hashes(render(cornell, s, samples).film));
}

TEST(Bits, HalvesAddUp) {
  Film whole = render(scene(), settings(), {2, 4}).film;
  add_film(whole, render(scene(), settings(), {0, 2}).film);
  EXPECT_EQ(whole.samples, (std::vector<SampleRange>{samples}));
  expect_same(whole, "halves");
  Film single = render(scene(), settings(), {1, 2}).film;
  for (const SampleRange part : {SampleRange{3, 4}, SampleRange{0, 1}, SampleRange{2, 3}}) add_film(single, render(scene(), settings(), part).film);
  expect_same(single, "single samples");
}

TEST(Bits, StoppedAndResumed) {
  const Variant variant = device_variant(test_device().info());
  Programs programs(test_device(), variant);
  Tuning tuning;
  tuning.pool = 64;  // of 1536 paths a sample: it stops in between
  Renderer renderer(test_device(), programs, scene().flat(variant.layout), scene().camera(48, 32), settings(), tuning);
  SampleRange done{0, 0};
  int calls = 0;
  while (done.last < samples.last) {
    done = renderer.render({done.last, samples.last}, [](const RenderProgress &) { return false; });
    ASSERT_LT(calls++, 8) << "a call that is stopped at once still does a sample";
  }
  EXPECT_GT(calls, 1) << "it was never interrupted";
  EXPECT_EQ(renderer.film().samples, (std::vector<SampleRange>{samples}));
  expect_same(renderer.film(), "stopped and resumed");
}

TEST(Bits, StoppedInOneProcessAndResumedInAnother) {
  Ways small;
  small.pool = 64;
  Film first = render(scene(), settings(), samples, small, [](const RenderProgress &p) { return p.paths_begun < 1600; }).film;
  ASSERT_EQ(first.samples.size(), 1u);
  ASSERT_LT(first.samples[0].last, samples.last);
  add_film(first, render(scene(), settings(), {first.samples[0].last, samples.last}).film);
  expect_same(first, "resumed");
}

TEST(Bits, CropsAreWindowsOfTheWhole) {
  const Film &whole = reference().film;
  for (const Window w : {Window{0, 0, 48, 5}, Window{13, 7, 30, 21}, Window{47, 31, 48, 32}}) {
    RenderSettings cropped = settings();
    cropped.x0 = w.x0;
    cropped.y0 = w.y0;
    cropped.x1 = w.x1;
    cropped.y1 = w.y1;
    const Film film = render(scene(), cropped, samples).film;
    ASSERT_EQ(film.layers.size(), whole.layers.size());
    const std::size_t values = SUN_FILM_CHANNELS * SUN_FILM_BINS;
    std::size_t different = 0;
    for (std::size_t layer = 0; layer < film.layers.size(); layer++)
      for (int y = w.y0; y < w.y1; y++)
        for (std::size_t i = 0; i < values * static_cast<std::size_t>(w.x1 - w.x0); i++) {
          const std::size_t in_crop = static_cast<std::size_t>(y - w.y0) * static_cast<std::size_t>(film.width()) * values + i;
          const std::size_t in_whole = (static_cast<std::size_t>(y) * 48 + static_cast<std::size_t>(w.x0)) * values + i;
          different += film.layers[layer].values[in_crop] != whole.layers[layer].values[in_whole];
        }
    EXPECT_EQ(different, 0u) << "crop from " << w.x0 << "," << w.y0;
  }
}

TEST(Bits, BouncesSumToTheBeautyBinByBin) {
  for (const char *integrator : {"path", "pure", "hybrid", "bdpt", "sppm", "photon"}) {
    Scene without = everything();
    if (std::string(integrator) == "pure") without.lights.clear();
    RenderSettings s = settings();
    s.integrator = integrator;
    if (std::string(integrator) == "hybrid") s.light_samples = 3;
    if (std::string(integrator) == "photon") s.photons = 5000;
    const Film film = render(Case(std::move(without)), s, samples).film;
    std::vector<std::int64_t> sum(film.layers[0].values.size());
    for (const FilmLayer &layer : film.layers)
      if (layer.name.starts_with("bounce."))
        for (std::size_t i = 0; i < sum.size(); i++) sum[i] += layer.values[i];
    for (std::size_t i = 0; i < sum.size(); i++)
      ASSERT_EQ(sum[i], film.find("beauty.even")->values[i] + film.find("beauty.odd")->values[i]) << integrator << ", value " << i;
  }
}

// What single integrators add: several shadow rays a vertex, a fixed chance to end, directions without a look at the bsdf.
TEST(Bits, WaysOfEveryIntegrator) {
  Scene lit = everything(), unlit = lit;
  unlit.lights.clear();
  const Case lit_case(lit), unlit_case(unlit);
  std::vector<std::pair<const Case *, RenderSettings>> kinds(5, {&lit_case, settings()});
  kinds[0].second.integrator = "hybrid";
  kinds[0].second.light_samples = 3;
  kinds[0].second.absorption = 0.2f;
  kinds[1] = {&unlit_case, kinds[0].second};
  kinds[1].second.nee_first = true;
  kinds[2].first = &unlit_case;
  kinds[2].second.integrator = "pure";
  kinds[2].second.sampling = Sampling::uniform;
  kinds[3].second.integrator = "hybrid";
  kinds[3].second.indirect_samples = 3;
  kinds[3].second.absorption = 0.25f;
  kinds[4].second.integrator = "distribution";
  kinds[4].second.indirect_samples = 2;
  kinds.emplace_back(&lit_case, settings());
  kinds.back().second.integrator = "bdpt";
  kinds.emplace_back(&lit_case, settings());
  kinds.back().second.integrator = "sppm";
  kinds.emplace_back(&lit_case, settings());
  kinds.back().second.integrator = "photon";
  kinds.back().second.photons = 5000;
  std::vector<std::string> seen;
  for (const auto &[made, s] : kinds) {
    const auto expected = hashes(render(*made, s, samples).film);
    Ways one, sixteen, columns, small;
    one.lanes = 1;
    one.layout = Layout::binary;
    sixteen.lanes = 16;
    sixteen.layout = Layout::wide16;
    sixteen.work_group = 16;
    columns.columns = true;
    columns.lanes = 1;
    columns.chunk = 64;
    small.pool = 48;
    for (const Ways &ways : {one, sixteen, columns, small}) EXPECT_EQ(hashes(render(*made, s, samples, ways).film), expected) << s.integrator;
    Film halves = render(*made, s, {2, 4}).film;
    add_film(halves, render(*made, s, {0, 2}).film);
    EXPECT_EQ(hashes(halves), expected) << s.integrator;
    seen.push_back(expected.at("film"));
  }
  EXPECT_EQ(std::set<std::string>(seen.begin(), seen.end()).size(), kinds.size());
}

TEST(Bits, LayersDoNotChangeTheBeauty) {
  const RenderSettings bare = [] {
    RenderSettings s = picture(48, 32, 8);
    s.layers.bounces = false;
    return s;
  }();
  EXPECT_EQ(film_hash(render(scene(), bare, samples).film), film_hash(reference().film));
}

// Bands of rows, where a film is too large for one buffer, are crops in a row: covered by CropsAreWindowsOfTheWhole. This one is about the numbers a
// path is told by: a picture that is no multiple of 4x4, in pools smaller than a row of blocks.
TEST(Bits, OddSizes) {
  RenderSettings odd = picture(37, 23, 3);
  Ways small, large;
  small.pool = 48;
  large.pool = 65536;
  EXPECT_EQ(hashes(render(scene(), odd, {0, 3}, small).film), hashes(render(scene(), odd, {0, 3}, large).film));
}

}  // namespace sunstone::test
