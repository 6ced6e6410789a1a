// SPDX-License-Identifier: Apache-2.0
// .film files: what is written comes back, and nothing else is believed.
#include "film/film_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "host/film/made_film.h"
#include "support/temporary_folder.h"

namespace sunstone {

using nlohmann::json;
using test::black_film;
using test::TemporaryFolder;

namespace {

Film random_film() {
  Film film = black_film(16, 12, {{0, 16}, {32, 48}}, {"albedo", "bounce.0"});
  film.x0 = 3, film.y0 = 2, film.x1 = 10, film.y1 = 7;
  for (FilmLayer &layer : film.layers) layer = test::empty_layer(film, layer.name);
  test::fill_at_random(film, 42);
  film.clamped = 3, film.nan = ~std::uint64_t(0), film.interrupted = true;
  film.settings["odd \"name\"\n"] = "\xe2\x82\xac \\";
  return film;
}

void expect_equal(const Film &a, const Film &b) {
  EXPECT_EQ(film_difference(a, b), "");
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.information, b.information);
  EXPECT_EQ(a.clamped, b.clamped);
  EXPECT_EQ(a.nan, b.nan);
  EXPECT_EQ(a.interrupted, b.interrupted);
  ASSERT_EQ(a.layers.size(), b.layers.size());
  for (std::size_t i = 0; i < a.layers.size(); i++) {
    EXPECT_EQ(a.layers[i].name, b.layers[i].name);
    EXPECT_EQ(a.layers[i].values, b.layers[i].values);
  }
  EXPECT_EQ(film_hash(a), film_hash(b));
}

std::string message_of(const std::function<void()> &f) {
  try {
    f();
  } catch (const Error &error) {
    return error.what();
  }
  return {};
}

// Without write_file's care for the disk, which takes most of a test of many small files.
void put(const std::filesystem::path &path, std::span<const std::byte> data) {
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char *>(data.data()), static_cast<std::streamsize>(data.size()));
}

// A film file put together by hand, with a hash that fits.
std::vector<std::byte> file_of(const std::string &header, std::size_t value_bytes, std::uint64_t header_length) {
  std::vector<std::byte> data(16 + header.size() + value_bytes);
  std::memcpy(data.data(), "SUNFILM1", 8);
  std::memcpy(data.data() + 8, &header_length, 8);
  std::memcpy(data.data() + 16, header.data(), header.size());
  Hasher hasher;
  hasher.bytes(data.data(), data.size());
  const Hash hash = hasher.digest();
  for (const std::uint64_t word : {hash.low, hash.high})
    for (int i = 0; i < 8; i++) data.push_back(static_cast<std::byte>(word >> (8 * i)));
  return data;
}
std::vector<std::byte> file_of(const std::string &header, std::size_t value_bytes) { return file_of(header, value_bytes, header.size()); }

const std::size_t one_pixel_bytes = 2 * 3 * 2 * 8;
json one_pixel_header() {
  return json::parse(R"({"version": 1, "picture": [1, 1], "window": [0, 0, 1, 1], "samples": [[0, 4]], "layers": ["beauty.even", "beauty.odd"],
    "scene_hash": "ab", "settings": {"seed": "1"}, "information": {}, "clamped": 0, "nan": 0, "interrupted": false})");
}

}  // namespace

TEST(FilmFile, RoundTrip) {
  const TemporaryFolder folder;
  const Film film = random_film();
  write_film(folder / "a.film", film);
  EXPECT_EQ(folder.entries(), 1u);
  const Film back = read_film(folder / "a.film");
  expect_equal(film, back);
  EXPECT_EQ(back.name, (folder / "a.film").string());
  write_film(folder / "a.film", back);  // over itself
  write_film(folder / "b.film", film);
  EXPECT_EQ(read_file(folder / "a.film"), read_file(folder / "b.film")) << "the bytes depend on the film alone";
}

TEST(FilmFile, BytesThatAreNoUtf8DoNotStopARender) {
  const TemporaryFolder folder;
  Film film = random_film();
  film.information["scene"] = "r\xff\x80.gltf";
  write_film(folder / "a.film", film);
  EXPECT_EQ(film_hash(read_film(folder / "a.film")), film_hash(film));
}

TEST(FilmFile, EveryFlippedBitIsFound) {
  const TemporaryFolder folder;
  write_film(folder / "a.film", random_film());
  const std::vector<std::byte> good = read_file(folder / "a.film");
  std::mt19937 random(1);
  for (std::size_t at = 0; at < good.size(); at += at < 700 ? 1 : 53) {
    std::vector<std::byte> bad = good;
    bad[at] ^= static_cast<std::byte>(1u << (random() % 8));
    put(folder / "bad.film", bad);
    EXPECT_NE(message_of([&] { read_film(folder / "bad.film"); }), "") << "byte " << at;
  }
}

TEST(FilmFile, CutOffAnywhereOrTooLong) {
  const TemporaryFolder folder;
  write_film(folder / "a.film", random_film());
  const std::vector<std::byte> good = read_file(folder / "a.film");
  for (std::size_t length = 0; length < good.size(); length += length < 700 ? 7 : 501) {
    put(folder / "bad.film", std::span(good).first(length));
    EXPECT_NE(message_of([&] { read_film(folder / "bad.film"); }), "") << length << " bytes";
  }
  std::vector<std::byte> longer = good;
  longer.push_back(std::byte{0});
  put(folder / "bad.film", longer);
  EXPECT_NE(message_of([&] { read_film(folder / "bad.film"); }).find("too long"), std::string::npos);
}

// Whoever forges the hash too meets the checks of each number.
TEST(FilmFile, HeadersThatLie) {
  const TemporaryFolder folder;
  const auto read = [&](const std::string &header, std::size_t values = one_pixel_bytes) {
    put(folder / "h.film", file_of(header, values));
    return message_of([&] { read_film(folder / "h.film"); });
  };
  ASSERT_EQ(read(one_pixel_header().dump()), "") << "the header that all others are made from has to pass";
  const auto changed = [&](const char *pointer, const json &value) {
    json header = one_pixel_header();
    header[json::json_pointer(pointer)] = value;
    return read(header.dump());
  };
  EXPECT_NE(changed("/version", 2).find("newer version"), std::string::npos);
  EXPECT_EQ(changed("/picture", {1000000, 1000000}), "") << "a small window of a large picture is no lie";
  const json two_to_31 = 2147483648u, huge = 1u << 20;
  const std::vector<std::pair<const char *, json>> lies = {{"/version", "1"},
                                                           {"/version", -1},
                                                           {"/version", 1.0},
                                                           {"/version", nullptr},
                                                           {"/picture", {0, 1}},
                                                           {"/picture", {1}},
                                                           {"/picture", {1, 1, 1}},
                                                           {"/picture", {-1, 1}},
                                                           {"/picture", {1.5, 1}},
                                                           {"/picture", {two_to_31, 1}},
                                                           {"/picture", 1},
                                                           {"/window", {0, 0, 0, 1}},
                                                           {"/window", {1, 0, 1, 1}},
                                                           {"/window", {0, 0, 2, 1}},
                                                           {"/window", {0, 0, 1, 18446744073709551615u}},
                                                           {"/window", {0, 0, 1}},
                                                           {"/samples", {{0, 0}}},
                                                           {"/samples", {{4, 0}}},
                                                           {"/samples", json::array({{0, 4}, {4, 8}})},
                                                           {"/samples", json::array({{0, 4}, {3, 8}})},
                                                           {"/samples", json::array({{8, 9}, {0, 4}})},
                                                           {"/samples", {{0, 18446744073709551615u}}},
                                                           {"/samples", {{0, 1, 2}}},
                                                           {"/samples", {0, 1}},
                                                           {"/samples", "0:4"},
                                                           {"/layers", {"beauty.even"}},
                                                           {"/layers", {"beauty.odd", "beauty.even"}},
                                                           {"/layers", {"beauty.even", "beauty.even"}},
                                                           {"/layers", {"beauty.even", 1}},
                                                           {"/layers", {"beauty.even", "beauty.odd", "albedo"}},
                                                           {"/layers", json::array()},
                                                           {"/scene_hash", 1},
                                                           {"/settings", json::array()},
                                                           {"/settings", {{"seed", 1}}},
                                                           {"/information", {{"a", json::array()}}},
                                                           {"/clamped", -1},
                                                           {"/clamped", 1.5},
                                                           {"/nan", "0"},
                                                           {"/interrupted", 0},
                                                           {"/more", 1}};
  for (const auto &[pointer, value] : lies) EXPECT_NE(changed(pointer, value), "") << pointer << " " << value;
  const json complete = one_pixel_header();
  for (const auto &[key, value] : complete.items()) {
    json header = one_pixel_header();
    header.erase(key);
    EXPECT_NE(read(header.dump()), "") << "without " << key;
  }
  // The largest picture that the numbers allow must fail by the file's length, not by an attempt to allocate it.
  json large = one_pixel_header();
  large["picture"] = {huge, huge}, large["window"] = {0, 0, 1 << 14, 1 << 14};
  EXPECT_NE(read(large.dump()).find("its header needs 25769804"), std::string::npos);
}

TEST(FilmFile, HeadersThatAreNoStrictJson) {
  const TemporaryFolder folder;
  const std::string good = one_pixel_header().dump();
  const auto read = [&](const std::string &header) {
    put(folder / "h.film", file_of(header, one_pixel_bytes));
    return message_of([&] { read_film(folder / "h.film"); });
  };
  EXPECT_NE(read("{\"clamped\":0," + good.substr(1)).find("twice"), std::string::npos);
  EXPECT_NE(read(std::string(1 << 20, '[')).find("nested too deeply"), std::string::npos);
  for (const std::string &header :
       {std::string(), std::string("[]"), std::string("null"), good + "x", good.substr(0, good.size() - 1), "//\n" + good,
        good + std::string(1, '\0'), std::string("{\"a\":\"\xff\"}"), std::string("{\"a\":NaN}"), std::string("{\"a\":1e999}")})
    EXPECT_NE(read(header), "") << printable(header.substr(0, 40));
}

TEST(FilmFile, HeaderLengthsThatLie) {
  const TemporaryFolder folder;
  const std::string good = one_pixel_header().dump();
  for (const std::uint64_t length : {~std::uint64_t(0), std::uint64_t(1) << 63, ~std::uint64_t(0) - 31,
                                     std::uint64_t(good.size() + one_pixel_bytes + 1), std::uint64_t(0), std::uint64_t(1)}) {
    put(folder / "h.film", file_of(good, one_pixel_bytes, length));
    EXPECT_NE(message_of([&] { read_film(folder / "h.film"); }), "") << length;
  }
}

TEST(FilmFile, OtherFilesAreNamed) {
  const TemporaryFolder folder;
  EXPECT_NE(message_of([&] { read_film(folder / "none.film"); }).find("none.film: no such file"), std::string::npos);
  EXPECT_NE(message_of([&] { read_film(folder / ""); }).find("not a regular file"), std::string::npos);
  put(folder / "p.film", std::as_bytes(std::span("\x89PNG\r\n\x1a\n and so on", 18)));
  EXPECT_NE(message_of([&] { read_film(folder / "p.film"); }).find("is no film"), std::string::npos);
  put(folder / "p.film", std::as_bytes(std::span("SUNFILM2 and so on, for more than 32 bytes", 42)));
  EXPECT_NE(message_of([&] { read_film(folder / "p.film"); }).find("another version"), std::string::npos);
}

TEST(FilmFile, AFailedWriteLeavesNothing) {
  const TemporaryFolder folder;
  const Film film = random_film();
  EXPECT_NE(message_of([&] { write_film(folder / "none/a.film", film); }), "");
  write_film(folder / "a.film", film);
  EXPECT_NE(message_of([&] { write_film(folder / "a.film/b.film", film); }), "");
  const std::vector<std::byte> before = read_file(folder / "a.film");

  // A full disk, as a limit on the length of files: in the header, in the integers, and in what only closing writes out.
  Film other = film;
  other.layers[0].values[0]++;
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  std::vector<std::string> messages;
  for (const std::size_t limit : {std::size_t(10), std::size_t(5000), before.size() - 1}) {
    rlimit small = old;
    small.rlim_cur = limit;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    messages.push_back(message_of([&] { write_film(folder / "a.film", other); }));
  }
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  for (const std::string &message : messages) EXPECT_NE(message.find("a.film: could not be written: File too large"), std::string::npos) << message;
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_EQ(read_file(folder / "a.film"), before) << "what was there stays";
  Film broken = film;
  broken.layers[1].values.pop_back();
  EXPECT_NE(message_of([&] { write_film(folder / "c.film", broken); }), "");
  EXPECT_EQ(folder.entries(), 1u);
}

}  // namespace sunstone
