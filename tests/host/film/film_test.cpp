// SPDX-License-Identifier: Apache-2.0
// Films add like integers, refuse what does not belong together, and say so.
#include "film/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "host/film/made_film.h"

namespace sunstone {

using test::add;
using test::black_film;
using test::fill_at_random;

template <class Function> std::string message_of(Function f) {
  try {
    f();
  } catch (const Error &error) {
    return error.what();
  }
  return {};
}

TEST(Samples, RangesStaySortedDisjointAndJoined) {
  std::vector<SampleRange> ranges;
  for (const SampleRange range : {SampleRange{32, 48}, {0, 8}, {16, 32}, {60, 61}, {5, 5}}) insert_samples(ranges, range);
  EXPECT_EQ(show_samples(ranges), "0:8, 16:48, 60:61");
  insert_samples(ranges, {8, 16});
  EXPECT_EQ(show_samples(ranges), "0:48, 60:61");
  insert_samples(ranges, {59, 60});
  EXPECT_EQ(show_samples(ranges), "0:48, 59:61");
  EXPECT_EQ(show_samples({}), "");
}

TEST(Samples, OverlapsAreRefusedWhereverTheyLie) {
  const std::vector<SampleRange> before = {{8, 16}, {32, 48}};
  for (const SampleRange range : {SampleRange{8, 16}, {0, 9}, {15, 16}, {10, 12}, {0, 100}, {47, 60}, {16, 33}}) {
    std::vector<SampleRange> ranges = before;
    EXPECT_THROW(insert_samples(ranges, range), Error) << range.first << ":" << range.last;
    EXPECT_EQ(ranges, before);
  }
  std::vector<SampleRange> ranges = before;
  EXPECT_EQ(message_of([&] { insert_samples(ranges, {40, 100}); }), "samples 40:100: samples 40:48 are there already");
  EXPECT_THROW(insert_samples(ranges, {3, 2}), Error);
}

TEST(Film, ValuesAreSumsOfTheirBinsOverTheSamples) {
  Film film = black_film(2, 1, {{0, 3}, {7, 8}}, {"albedo", "object_id"});
  add(film, "beauty.even", 0, 1, 0.75);
  add(film, "beauty.odd", 0, 1, 2.5);
  add(film, "albedo", 1, 2, -0.5);
  add(film, "object_id", 1, 0, 9);
  EXPECT_EQ(film.sample_count(), 4u);
  EXPECT_EQ(film_beauty(film), (std::vector<float>{0, 3.25f / 4, 0, 0, 0, 0}));
  EXPECT_EQ(film_value(film, *film.find("albedo"), 1, 2), -0.125);
  EXPECT_EQ(film_value(film, *film.find("object_id"), 1, 0), 9) << "identifiers are sample 0's alone";
  EXPECT_EQ(film.find("normal"), nullptr);
  film.samples.clear();
  EXPECT_EQ(film_value(film, *film.find("albedo"), 1, 2), 0);
}

TEST(Film, AddingGivesOneHashInAnyOrderAndWrapsAround) {
  const std::vector<SampleRange> ranges = {{0, 4}, {4, 8}, {12, 20}, {8, 12}};
  std::vector<Film> films;
  for (std::size_t i = 0; i < ranges.size(); i++) {
    films.push_back(black_film(13, 7, {ranges[i]}, {"bounce.0"}));
    fill_at_random(films.back(), i);
    films.back().clamped = i;
  }
  std::vector<std::size_t> order = {0, 1, 2, 3};
  std::string expected, expected_layer;
  do {
    Film sum = films[order[0]];
    for (std::size_t i = 1; i < order.size(); i++) add_film(sum, films[order[i]]);
    EXPECT_EQ(show_samples(sum.samples), "0:20");
    EXPECT_EQ(sum.clamped, 6u);
    EXPECT_EQ(sum.information["seconds"], "6.000");
    if (expected.empty()) expected = film_hash(sum).hex(), expected_layer = layer_hash(sum, sum.layers[2]).hex();
    EXPECT_EQ(film_hash(sum).hex(), expected);
    EXPECT_EQ(layer_hash(sum, sum.layers[2]).hex(), expected_layer);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Film, TheHashIsOfTheBeautyWhicheverHalfHoldsIt) {
  Film a = black_film(3, 2, {{0, 4}}), b = a;
  add(a, "beauty.even", 4, 1, 0.5);
  EXPECT_NE(film_hash(a), film_hash(b));
  add(b, "beauty.odd", 4, 1, 0.5);
  EXPECT_EQ(film_hash(a), film_hash(b));
  b.settings["seed"] = "8", b.information["device"] = "another", b.interrupted = true;
  b.layers.push_back(test::empty_layer(b, "albedo"));
  EXPECT_EQ(film_hash(a), film_hash(b)) << "only size, samples and integers count";
  b.samples = {{0, 5}};
  EXPECT_NE(film_hash(a), film_hash(b));
  b = a, b.picture_width = 4;
  EXPECT_NE(film_hash(a), film_hash(b));
  // The two bins are not one sum: each is hashed.
  Film c = black_film(3, 2, {{0, 4}});
  c.layers[0].values[(4 * 3 + 1) * 2 + 1] = std::int64_t(1) << (SUN_FILM_COARSE_BITS - 1);
  EXPECT_EQ(film_beauty(c), film_beauty(a));
  EXPECT_NE(film_hash(c), film_hash(a));
}

TEST(Film, WhatDoesNotBelongTogetherIsNamed) {
  Film a = black_film(4, 3, {{0, 4}}, {"albedo"});
  a.name = "a.film";
  const auto refused = [&](auto change) {
    Film b = black_film(4, 3, {{4, 8}}, {"albedo"});
    b.name = "b.film";
    change(b);
    Film sum = a;
    const std::string message = message_of([&] { add_film(sum, b); });
    if (!message.empty()) {
      EXPECT_EQ(film_hash(sum), film_hash(a)) << "a refused film leaves no trace";
      EXPECT_EQ(sum.samples, a.samples);
    }
    return message;
  };
  ASSERT_EQ(refused([](Film &) {}), "") << "equals must be able to add";
  const std::string head = "b.film: cannot be added to a.film: ";
  EXPECT_EQ(refused([](Film &b) { b.settings["max_depth"] = "8"; }), head + "settings differ: max_depth is 16 in a.film and 8 in b.film");
  EXPECT_EQ(refused([](Film &b) { b.settings["sampler"] = "sobol"; }), head + "settings differ: sampler is not set in a.film and sobol in b.film");
  EXPECT_EQ(refused([](Film &b) { b.settings.erase("seed"), b.settings["integrator"] = "pure"; }),
            head + "settings differ: integrator is path in a.film and pure in b.film, seed is 7 in a.film and not set in b.film");
  EXPECT_EQ(refused([](Film &b) { b.scene_hash = "ff"; }),
            head + "scenes differ: the hash is 0123456789abcdef0123456789abcdef in a.film and ff in b.film");
  EXPECT_EQ(refused([](Film &b) { b.picture_width = 5; }), head + "pictures differ: the size is 4x3 in a.film and 5x3 in b.film");
  EXPECT_EQ(refused([](Film &b) { b.x0 = 1, b.layers.clear(); }),
            head + "pictures differ: the crop window is 0,0,4,3 in a.film and 1,0,4,3 in b.film");
  EXPECT_EQ(refused([](Film &b) { b.layers.pop_back(); }), head + "layers differ: albedo is missing in b.film");
  EXPECT_EQ(refused([](Film &b) { b.layers.push_back(test::empty_layer(b, "normal")); }), head + "layers differ: normal is missing in a.film");
  EXPECT_EQ(refused([](Film &b) { b.samples = {{3, 5}}; }), head + "samples 3:4 are there already");
  EXPECT_NE(refused([](Film &b) { b.layers[2].values.pop_back(); }), "");
}

TEST(Film, AddingMatchesLayersByName) {
  Film a = black_film(1, 1, {{0, 1}}, {"albedo", "normal"}), b = black_film(1, 1, {{1, 2}}, {"normal", "albedo"});
  add(a, "albedo", 0, 0, 0.5);
  add(b, "albedo", 0, 0, 0.25);
  add(b, "normal", 0, 0, -0.5);
  add_film(a, b);
  EXPECT_EQ(film_value(a, *a.find("albedo"), 0, 0), 0.375);
  EXPECT_EQ(film_value(a, *a.find("normal"), 0, 0), -0.25);
}

TEST(Film, InformationKeepsAllThatWasSaid) {
  Film a = black_film(1, 1, {{0, 1}}), b = black_film(1, 1, {{1, 2}}), c = black_film(1, 1, {{2, 3}});
  b.information["device"] = "b device", c.information["host"] = "c", c.interrupted = true;
  add_film(a, b);
  add_film(a, c);
  EXPECT_EQ(a.information["device"], "a device; b device");
  EXPECT_EQ(a.information["host"], "c");
  EXPECT_EQ(a.information["seconds"], "4.500");
  EXPECT_TRUE(a.interrupted);
}

TEST(Film, VarianceAndErrorFromTheHalves) {
  Film film = black_film(1, 1, {{0, 4}});
  EXPECT_EQ(film_variance(film, 0, 0), 0);
  EXPECT_EQ(estimated_error(film), 0);
  // Means 3 and 1 of two samples each: the mean of all is 2, its variance ((3 - 1) / 2)^2 = 1.
  add(film, "beauty.even", 0, 0, 6);
  add(film, "beauty.odd", 0, 0, 2);
  EXPECT_DOUBLE_EQ(film_variance(film, 0, 0), 1);
  EXPECT_DOUBLE_EQ(estimated_error(film), 1 / (4 + 0.01) / 3);
  // Three samples: two even with mean 3, one odd of 2; m n / (m + n)^2 = 2/9.
  film.samples = {{0, 3}};
  EXPECT_DOUBLE_EQ(film_variance(film, 0, 0), 2.0 / 9);
  for (const std::vector<SampleRange> &lacking : {std::vector<SampleRange>{}, {{0, 1}}, {{0, 1}, {2, 3}}}) {
    film.samples = lacking;
    EXPECT_EQ(estimated_error(film), std::numeric_limits<double>::infinity());
  }
}

// The estimate is unbiased: over many films of independent samples its mean is the variance of the mean.
TEST(Film, VarianceIsUnbiasedForUnequalHalves) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  const int runs = 20000, samples = 5;
  double sum = 0;
  for (int run = 0; run < runs; run++) {
    Film film = black_film(1, 1, {{0, samples}});
    for (int s = 0; s < samples; s++)
      add(film, s % 2 ? "beauty.odd" : "beauty.even", 0, 0, std::ldexp(std::floor(std::ldexp(uniform(random), 30)), -30));
    sum += film_variance(film, 0, 0);
  }
  const double expected = 1.0 / 12 / samples;  // of the mean of five uniform numbers
  // One degree of freedom: a relative deviation of about sqrt(2 / runs) = 1 %; five of them.
  EXPECT_NEAR(sum / runs, expected, 0.05 * expected);
}

}  // namespace sunstone
