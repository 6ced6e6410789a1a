// SPDX-License-Identifier: Apache-2.0
// Views of known values to the byte; files of every suffix; and failures that leave nothing behind.
#include "output/view.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>
#include <thread>

#include "base/error.h"
#include "base/file.h"
#include "host/film/made_film.h"
#include "support/temporary_folder.h"
#include "output/color.h"
#include "output/output.h"

namespace sunstone {

using test::add;
using test::black_film;
using test::TemporaryFolder;

namespace {

// A row of grey pixels of one sample.
Film grey_film(const std::vector<double> &values) {
  Film film = black_film(static_cast<int>(values.size()), 1, {{0, 1}});
  for (std::size_t i = 0; i < values.size(); i++)
    for (int c = 0; c < 3; c++) add(film, "beauty.even", i, c, values[i]);
  return film;
}

std::vector<int> reds(const std::vector<std::uint8_t> &bytes, std::size_t channels = 3) {
  std::vector<int> result;
  for (std::size_t i = 0; i < bytes.size(); i += channels) result.push_back(bytes[i]);
  return result;
}

std::string message_of(const std::function<void()> &f) {
  try {
    f();
  } catch (const Error &error) {
    return error.what();
  }
  return {};
}

Film colorful_film() {
  Film film = black_film(48, 32, {{0, 1}}, {"alpha"});
  for (std::size_t pixel = 0; pixel < film.pixels(); pixel++) {
    for (int c = 0; c < 3; c++) add(film, "beauty.even", pixel, c, static_cast<double>(pixel * (static_cast<std::size_t>(c) + 1) % 1500) / 1024);
    add(film, "alpha", pixel, 0, 0.75);
  }
  return film;
}

}  // namespace

TEST(View, SrgbToTheByte) {
  // Bytes worked out by hand from the standard's two pieces: 0.0031308 * 12.92 * 255 = 10.31; 0.5 -> 0.7353570 -> 187.5160; 0.18 -> 0.4613561 ->
  // 117.6458.
  const Film film = grey_film({0, 0.0009765625, 0.0029296875, 0.003173828125, 0.1796875, 0.5, 0.99609375, 1, 2, 100000, -0.5, -3});
  EXPECT_EQ(reds(view_bytes(film, {})), (std::vector<int>{0, 3, 10, 10, 118, 188, 255, 255, 255, 255, 0, 0}));
  for (int byte = 0; byte < 256; byte++) EXPECT_EQ(byte_of(srgb_encode(srgb_decode(byte / 255.0))), byte);
  EXPECT_NEAR(srgb_encode(0.0031308), srgb_encode(0.0031309), 2e-6) << "the pieces meet";
}

TEST(View, ExposureIsInStops) {
  const Film film = grey_film({0.25, 0.5, 1});
  EXPECT_EQ(reds(view_bytes(film, {.exposure = -1.0f})), reds(view_bytes(grey_film({0.125, 0.25, 0.5}), {})));
  EXPECT_EQ(reds(view_bytes(film, {.exposure = 2.0f})), (std::vector<int>{255, 255, 255}));
}

TEST(View, AutomaticExposureBringsTheGeometricMeanToMiddleGrey) {
  const std::vector<float> rgb = {0.5f, 0.5f, 0.5f, 2, 2, 2, 0, 0, 0, -1, -1, -1};  // what does not shine has no logarithm
  EXPECT_NEAR(automatic_exposure(rgb), std::log2(0.18), 1e-6);
  EXPECT_EQ(automatic_exposure(std::vector<float>(30, 0.0f)), 0);
  const Film film = grey_film({40, 40});
  EXPECT_EQ(reds(view_bytes(film, {.exposure = std::nullopt})), (std::vector<int>{118, 118}));
}

TEST(View, FilmicRollsOff) {
  EXPECT_EQ(filmic(0), 0);
  EXPECT_NEAR(filmic(1), 2.54 / 3.16, 1e-12);
  EXPECT_EQ(filmic(1e300), 1);
  for (double x = 0.01; x < 20; x *= 1.1) EXPECT_LE(filmic(x), filmic(x * 1.1));
  // 2.54 / 3.16 = 0.803797 -> sRGB 0.908231 -> 231.60
  EXPECT_EQ(reds(view_bytes(grey_film({0, 1, 30000}), {.tone = Tone::filmic})), (std::vector<int>{0, 232, 255}));
}

TEST(View, TransparencyIsStraightInPng) {
  Film film = black_film(4, 1, {{0, 2}}, {"alpha"});
  const double coverage[] = {1, 0.5, 0, 2};
  for (std::size_t i = 0; i < 4; i++) {
    add(film, "alpha", i, 0, coverage[i] * 2);
    add(film, "beauty.odd", i, 0, coverage[i] * 0.5 * 2);  // a red of 0.5 under that coverage
  }
  const std::vector<std::uint8_t> bytes = view_bytes(film, {.transparent_background = true});
  EXPECT_EQ(reds(bytes, 4), (std::vector<int>{188, 188, 0, 255}));
  EXPECT_EQ((std::vector<int>{bytes[3], bytes[7], bytes[11], bytes[15]}), (std::vector<int>{255, 128, 0, 255}));
  EXPECT_EQ(reds(view_bytes(film, {})), (std::vector<int>{188, 137, 0, 255})) << "before black";

  const TemporaryFolder folder;
  write_picture(folder / "a.png", film, {.transparent_background = true});
  const Image back = read_image(folder / "a.png");
  EXPECT_EQ(back.channels, 4);
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(back.pixels), bytes);

  Film opaque = grey_film({0.5});
  EXPECT_NE(message_of([&] { write_picture(folder / "b.png", opaque, {.transparent_background = true}); }).find("no layer alpha"), std::string::npos);
  EXPECT_EQ(folder.entries(), 1u);
  write_picture(folder / "b.jpg", film, {.transparent_background = true});
  EXPECT_EQ(read_image(folder / "b.jpg").channels, 3);
}

TEST(View, FilesComeBack) {
  const TemporaryFolder folder;
  const Film film = colorful_film();
  const std::vector<std::uint8_t> bytes = view_bytes(film, {});
  write_picture(folder / "a.PNG", film, {});
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(read_image(folder / "a.PNG").pixels), bytes);

  write_picture(folder / "a.jpeg", film, {});
  const auto jpeg = std::get<std::vector<std::uint8_t>>(read_image(folder / "a.jpeg").pixels);
  ASSERT_EQ(jpeg.size(), bytes.size());
  double squares = 0;
  for (std::size_t i = 0; i < bytes.size(); i++) squares += (jpeg[i] - bytes[i]) * (jpeg[i] - bytes[i]);
  EXPECT_LT(std::sqrt(squares / static_cast<double>(bytes.size())), 6);

  write_picture(folder / "a.hdr", film, {.exposure = 3.0f, .tone = Tone::filmic});
  const std::vector<float> beauty = film_beauty(film), hdr = std::get<std::vector<float>>(read_image(folder / "a.hdr").pixels);
  for (std::size_t pixel = 0; pixel < film.pixels(); pixel++) {
    const float largest = std::max({beauty[pixel * 3], beauty[pixel * 3 + 1], beauty[pixel * 3 + 2]});
    for (std::size_t c = 0; c < 3; c++)
      EXPECT_NEAR(hdr[pixel * 3 + c], beauty[pixel * 3 + c], largest / 128 + 1e-30) << "a mantissa of 8 bits, shared";
  }

  write_picture(folder / "a.film", film, {});
  const Image from_film = read_picture(folder / "a.film");
  EXPECT_EQ(std::get<std::vector<float>>(from_film.pixels), beauty);
}

TEST(View, PicturesAreReadAsLinearLight) {
  const TemporaryFolder folder;
  const Film film = grey_film({0, 0.25, 1, -1});
  write_picture(folder / "a.png", film, {});
  const std::vector<float> png = std::get<std::vector<float>>(read_picture(folder / "a.png").pixels);
  EXPECT_EQ(png[0], 0);
  EXPECT_NEAR(png[3], 0.25, 0.003);
  EXPECT_EQ(png[6], 1);
  write_picture(folder / "a.hdr", film, {});
  EXPECT_EQ(std::get<std::vector<float>>(read_picture(folder / "a.hdr").pixels)[3], 0.25f);
  write_picture(folder / "a.exr", film, {});
  EXPECT_EQ(std::get<std::vector<float>>(read_picture(folder / "a.exr").pixels)[9], -1);
}

TEST(View, TheSameFilmGivesTheSameBytes) {
  const TemporaryFolder folder;
  const Film film = colorful_film();
  for (const std::string &suffix : picture_suffixes()) write_picture(folder / ("a" + suffix), film, {});
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // a date in a header would show
  for (const std::string &suffix : picture_suffixes()) {
    write_picture(folder / ("b" + suffix), film, {});
    EXPECT_EQ(read_file(folder / ("a" + suffix)), read_file(folder / ("b" + suffix))) << suffix;
  }
}

TEST(Names, UnknownSuffixesAreUsageErrors) {
  for (const std::string &suffix : picture_suffixes()) EXPECT_NO_THROW(check_picture_name("a" + suffix));
  EXPECT_NO_THROW(check_picture_name("A.B.Exr"));
  for (const char *name : {"a", "a.", "a.gif", ".png", "a.exr.bak", "a.p\nng"}) EXPECT_THROW(check_picture_name(name), UsageError) << name;
  EXPECT_EQ(message_of([] { check_picture_name("a.gif"); }),
            "a.gif: the suffix .gif is not known (pictures are written as .exr .png .jpg .jpeg .hdr .tif .tiff .film)");
}

TEST(Write, FailuresLeaveNothingBehind) {
  const TemporaryFolder folder;
  const Film film = colorful_film();
  write_picture(folder / "file.png", film, {});
  const std::vector<std::byte> before = read_file(folder / "file.png");
  for (const std::string &suffix : picture_suffixes()) {
    EXPECT_NE(message_of([&] { write_picture(folder / ("none/a" + suffix), film, {}); }), "") << suffix;
    EXPECT_NE(message_of([&] { write_picture(folder / ("file.png/a" + suffix), film, {}); }), "") << suffix;
    std::filesystem::create_directory(folder / ("folder" + suffix));
    EXPECT_NE(message_of([&] { write_picture(folder / ("folder" + suffix), film, {}); }), "") << suffix;
  }
  // A full disk, as a limit on the length of files.
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  rlimit small = old;
  small.rlim_cur = 100;
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::vector<std::string> messages;
  for (const std::string &suffix : picture_suffixes()) messages.push_back(message_of([&] { write_picture(folder / ("full" + suffix), film, {}); }));
  messages.push_back(message_of([&] { write_picture(folder / "file.png", film, {.exposure = 1.0f}); }));
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  for (const std::string &message : messages) EXPECT_NE(message.find("could not be written: File too large"), std::string::npos) << message;
  EXPECT_EQ(folder.entries(), 1 + picture_suffixes().size());
  EXPECT_EQ(read_file(folder / "file.png"), before);
}

}  // namespace sunstone
