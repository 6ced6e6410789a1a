// SPDX-License-Identifier: Apache-2.0
// The EXR with all layers, read back by OpenImageIO.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "base/file.h"
#include "host/film/made_film.h"
#include "support/temporary_folder.h"
#include "output/output.h"

namespace sunstone {

using test::add;
using test::black_film;
using test::TemporaryFolder;

namespace {

struct Layers {
  OIIO::ImageSpec spec;
  int index(const std::string &name) const { return spec.channelindex(name); }
  std::vector<float> floats;  // all channels interleaved; those of integers come scaled: read_integer gets at them
  float at(const std::string &name, int x, int y) const {
    EXPECT_GE(index(name), 0) << name;
    return floats[static_cast<std::size_t>((y * spec.width + x) * spec.nchannels + index(name))];
  }
};

Layers read_layers(const std::filesystem::path &path) {
  const auto input = OIIO::ImageInput::open(path.string());
  EXPECT_TRUE(input) << OIIO::geterror();
  Layers layers;
  layers.spec = input->spec();
  layers.floats.resize(static_cast<std::size_t>(layers.spec.image_pixels()) * static_cast<std::size_t>(layers.spec.nchannels));
  EXPECT_TRUE(input->read_image(0, 0, 0, layers.spec.nchannels, OIIO::TypeDesc::FLOAT, layers.floats.data()));
  return layers;
}

std::uint32_t read_integer(const std::filesystem::path &path, const std::string &name, int x, int y) {
  const auto input = OIIO::ImageInput::open(path.string());
  const OIIO::ImageSpec &spec = input->spec();
  const int channel = spec.channelindex(name);
  EXPECT_EQ(spec.channelformat(channel), OIIO::TypeDesc(OIIO::TypeDesc::UINT32)) << name;
  std::vector<std::uint32_t> values(static_cast<std::size_t>(spec.image_pixels()));
  EXPECT_TRUE(input->read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::UINT32, values.data()));
  return values[static_cast<std::size_t>(y * spec.width + x)];
}

Film full_film() {
  Film film = black_film(5, 4, {{0, 3}, {5, 6}},
                         {"bounce.0", "bounce.1", "bounce.2", "bounce.3", "albedo", "normal", "Z", "position", "object_id", "material_id", "alpha"});
  const std::size_t pixel = 2 * 5 + 3;  // column 3, row 2
  add(film, "beauty.even", pixel, 0, 6);
  add(film, "beauty.odd", pixel, 0, 2);
  add(film, "beauty.odd", pixel, 2, -0.25);
  add(film, "bounce.0", pixel, 0, 4);
  add(film, "bounce.1", pixel, 0, 0.5);
  add(film, "bounce.2", pixel, 0, 1.5);
  add(film, "bounce.3", pixel, 0, 2);
  add(film, "albedo", pixel, 1, 2);
  add(film, "normal", pixel, 2, -4);
  add(film, "Z", pixel, 0, 10);
  add(film, "position", pixel, 1, -100);
  add(film, "object_id", pixel, 0, 16777219);  // beyond what a float can tell apart
  add(film, "material_id", pixel, 0, 3);
  add(film, "alpha", pixel, 0, 3);
  return film;
}

}  // namespace

TEST(Layers, EveryLayerIsThereByItsName) {
  const TemporaryFolder folder;
  const Film film = full_film();
  write_picture(folder / "a.exr", film, {});
  EXPECT_EQ(folder.entries(), 1u);
  const Layers layers = read_layers(folder / "a.exr");
  std::set<std::string> names(layers.spec.channelnames.begin(), layers.spec.channelnames.end());
  std::set<std::string> expected = {"R", "G", "B", "A", "Z", "object_id", "material_id", "samples"};
  for (const char *prefix : {"albedo", "variance", "bounce.0", "bounce.1", "bounce.2", "bounce.3", "direct", "indirect"})
    for (const char *letter : {".R", ".G", ".B"}) expected.insert(std::string(prefix) + letter);
  for (const char *prefix : {"normal", "position"})
    for (const char *letter : {".X", ".Y", ".Z"}) expected.insert(std::string(prefix) + letter);
  EXPECT_EQ(names, expected);

  for (const auto &[name, value] : std::vector<std::pair<std::string, float>>{
           {"R", 2}, {"G", 0}, {"B", -0.0625f}, {"A", 0.75f}, {"Z", 2.5f}, {"albedo.G", 0.5f}, {"normal.Z", -1}, {"position.Y", -25},
           {"bounce.0.R", 1}, {"bounce.1.R", 0.125f}, {"bounce.2.R", 0.375f}, {"bounce.3.R", 0.5f}, {"direct.R", 1.125f}, {"indirect.R", 0.875f}}) {
    EXPECT_EQ(layers.at(name, 3, 2), value) << name;
    EXPECT_EQ(layers.at(name, 2, 3), 0) << name;
  }
  // Two even samples (0 and 2) of mean 3, two odd ones (1 and 5) of mean 1.
  EXPECT_EQ(layers.at("variance.R", 3, 2), 1);
  EXPECT_EQ(read_integer(folder / "a.exr", "object_id", 3, 2), 16777219u);
  EXPECT_EQ(read_integer(folder / "a.exr", "material_id", 3, 2), 3u);
  EXPECT_EQ(read_integer(folder / "a.exr", "material_id", 0, 0), 0u);
  EXPECT_EQ(read_integer(folder / "a.exr", "samples", 0, 0), 4u);
  EXPECT_EQ(layers.spec.channelformat(layers.index("R")), OIIO::TypeDesc(OIIO::TypeDesc::FLOAT));
}

TEST(Layers, AFilmOfBeautyAloneHasNoMoreThanThat) {
  const TemporaryFolder folder;
  write_picture(folder / "a.exr", black_film(3, 2, {{0, 1}}), {});
  const Layers layers = read_layers(folder / "a.exr");
  EXPECT_EQ(layers.spec.nchannels, 7);
  EXPECT_EQ(layers.at("variance.R", 0, 0), std::numeric_limits<float>::infinity()) << "one sample tells nothing of its error";
}

TEST(Layers, CropIsTheDataWindow) {
  const TemporaryFolder folder;
  Film film = black_film(40, 30, {{0, 1}});
  film.x0 = 7, film.y0 = 5, film.x1 = 20, film.y1 = 29;
  for (FilmLayer &layer : film.layers) layer = test::empty_layer(film, layer.name);
  add(film, "beauty.even", film.pixels() - 1, 1, 0.5);
  write_picture(folder / "a.exr", film, {});
  const Layers layers = read_layers(folder / "a.exr");
  const OIIO::ImageSpec &spec = layers.spec;
  EXPECT_EQ((std::array{spec.x, spec.y, spec.width, spec.height}), (std::array{7, 5, 13, 24}));
  EXPECT_EQ((std::array{spec.full_x, spec.full_y, spec.full_width, spec.full_height}), (std::array{0, 0, 40, 30}));
  EXPECT_EQ(layers.at("G", 12, 23), 0.5f);
}

TEST(Layers, MetadataSaysWhereItCameFrom) {
  const TemporaryFolder folder;
  Film film = full_film();
  film.interrupted = true, film.clamped = 12, film.nan = ~std::uint64_t(0);
  film.settings["camera"] = "\"quoted\" \xe2\x82\xac";
  write_picture(folder / "a.exr", film, {});
  const Layers layers = read_layers(folder / "a.exr");
  const auto text = [&](const std::string &key) { return std::string(layers.spec.get_string_attribute("sunstone:" + key, "missing")); };
  EXPECT_EQ(text("version"), "0.1.0");
  EXPECT_EQ(text("scene"), "room.gltf");
  EXPECT_EQ(text("device"), "a device");
  EXPECT_EQ(text("seconds"), "1.500");
  EXPECT_EQ(text("scene_hash"), film.scene_hash);
  EXPECT_EQ(text("film_hash"), film_hash(film).hex());
  EXPECT_EQ(text("seed"), "7");
  EXPECT_EQ(text("samples"), "0:3, 5:6");
  EXPECT_EQ(text("clamped"), "12");
  EXPECT_EQ(text("nan"), "18446744073709551615");
  EXPECT_EQ(text("settings"), "{\"camera\":\"\\\"quoted\\\" \xe2\x82\xac\",\"integrator\":\"path\",\"max_depth\":\"16\",\"seed\":\"7\"}");
  EXPECT_EQ(layers.spec.get_int_attribute("sunstone:interrupted", -1), 1);
}

// Not a layer, but it too is read by OpenImageIO alone: our own reader leaves TIFF out.
TEST(Tiff, RadianceAsItIsAndAlphaMultipliedIn) {
  const TemporaryFolder folder;
  Film film = black_film(3, 70, {{0, 2}}, {"alpha"});
  const std::size_t pixel = 69 * 3 + 2;
  add(film, "beauty.odd", pixel, 0, 5);
  add(film, "beauty.odd", pixel, 1, -0.5);
  add(film, "alpha", pixel, 0, 1);
  write_picture(folder / "a.tif", film, {.exposure = 5.0f, .tone = Tone::filmic});
  Layers opaque = read_layers(folder / "a.tif");
  EXPECT_EQ(opaque.spec.nchannels, 3);
  EXPECT_EQ(opaque.spec.format, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT));
  EXPECT_EQ(opaque.floats, film_beauty(film));
  write_picture(folder / "b.tiff", film, {.transparent_background = true});
  const Layers layers = read_layers(folder / "b.tiff");
  ASSERT_EQ(layers.spec.nchannels, 4);
  EXPECT_EQ(layers.spec.alpha_channel, 3);
  EXPECT_EQ(std::vector<float>(layers.floats.end() - 4, layers.floats.end()), (std::vector<float>{2.5f, -0.25f, 0, 0.5f}));
}

TEST(Layers, ManyRowsComeBackAsTheyWere) {
  const TemporaryFolder folder;
  Film film = black_film(37, 201, {{0, 1}});  // more than three blocks of rows
  std::mt19937 random(5);
  for (std::size_t pixel = 0; pixel < film.pixels(); pixel++)
    add(film, "beauty.even", pixel, static_cast<int>(pixel % 3), std::ldexp(static_cast<double>(random() % 10000), -10));
  write_picture(folder / "a.exr", film, {});
  const Layers layers = read_layers(folder / "a.exr");
  const std::vector<float> beauty = film_beauty(film);
  for (int y = 0; y < film.height(); y++)
    for (int x = 0; x < film.width(); x++)
      for (int c = 0; c < 3; c++)
        ASSERT_EQ(layers.at(std::string(1, "RGB"[c]), x, y), beauty[static_cast<std::size_t>((y * film.width() + x) * 3 + c)]);
  EXPECT_EQ(std::get<std::vector<float>>(read_picture(folder / "a.exr").pixels), beauty) << "compare sees the beauty";
}

}  // namespace sunstone
