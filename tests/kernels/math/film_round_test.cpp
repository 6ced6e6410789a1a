// SPDX-License-Identifier: Apache-2.0
// The film's one rounding: exact on whole quanta, without bias on all else, honest at the ends of its range; and adding through FilmView.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "chi2.h"
#include "math/hash.h"
#include "path/film.h"

namespace sunstone::kernel {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

struct Rounded {
  long value;
  uint bin, verdict;
};
Rounded round_to_film(float x, float dither) {
  Rounded r{};
  r.value = film_round(x, dither, &r.bin, &r.verdict);
  return r;
}
long double quantum(uint bin) { return ldexpl(1, bin ? -SUN_FILM_COARSE_BITS : -SUN_FILM_FINE_BITS); }

TEST(FilmRound, AtMostOneQuantumOffAndInTheRightBin) {
  for (uint i = 0; i < 300000; i++) {
    const uint h = hash2(i, 1);
    const float x = as_float((h & 0x807fffffu) | ((60 + hash2(i, 2) % 92) << 23));  // up to 2^25
    if (std::fabs(x) > SUN_FILM_LIMIT) continue;
    const float dither = unit_of_hash(hash2(i, 3));
    const Rounded r = round_to_film(x, dither);
    ASSERT_EQ(r.verdict, SUN_FILM_GOOD);
    ASSERT_EQ(r.bin, std::fabs(x) < 1 ? 0u : 1u);
    const long double quanta = static_cast<long double>(x) / quantum(r.bin), size = fabsl(quanta);
    const long double want = floorl(size) + (size - floorl(size) > dither ? 1 : 0);
    ASSERT_EQ(static_cast<long double>(r.value), copysignl(want, quanta)) << x;
  }
}

TEST(FilmRound, WholeQuantaAreExact) {
  for (const float dither : {0.0f, 0.5f, 0.99999994f}) {
    EXPECT_EQ(round_to_film(0.5f, dither).value, 1l << 35);
    EXPECT_EQ(round_to_film(-0.5f, dither).value, -(1l << 35));
    EXPECT_EQ(round_to_film(1.0f, dither).value, 4096);
    EXPECT_EQ(round_to_film(0.99999994f, dither).value, (1l << 36) - (1l << 12));
    EXPECT_EQ(round_to_film(SUN_FILM_LIMIT, dither).value, 1l << 37);
    EXPECT_EQ(round_to_film(0.0f, dither).value, 0);
    EXPECT_EQ(round_to_film(-0.0f, dither).value, 0);
  }
}

// Over all 2^24 dithers the mean is x itself: the number of them that round up is the fraction times 2^24.
TEST(FilmRound, MeanOverAllDithersIsExact) {
  for (const float x : {0.000123456789f, 1.2345678f, -0.7f / 1048576, 1234.5677f, 3.1e-11f}) {
    uint bin, verdict;
    long sum = 0;
    for (uint d = 0; d < 1u << 24; d++) sum += film_round(x, unit_of_hash(d << 8), &bin, &verdict);
    EXPECT_EQ(static_cast<long double>(sum), static_cast<long double>(x) / quantum(bin) * (1 << 24)) << x;
  }
}

// Far below a quantum the mean is right to 2^-24 of one.
TEST(FilmRound, TinyContributions) {
  long sum = 0;
  uint bin, verdict;
  const float x = ldexpf(1.0f, -50);
  for (uint d = 0; d < 1u << 24; d++) sum += film_round(x, unit_of_hash(d << 8), &bin, &verdict);
  EXPECT_EQ(sum, 1 << 10);
  EXPECT_EQ(round_to_film(1e-45f, 0).value, 1);
  EXPECT_EQ(round_to_film(1e-45f, 5.96046448e-8f).value, 0);
}

TEST(FilmRound, EndsOfTheRange) {
  for (const float x : {infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_EQ(round_to_film(x, 0.5f).value, 0);
    EXPECT_EQ(round_to_film(x, 0.5f).verdict, SUN_FILM_BAD);
  }
  for (const float x : {33554436.0f, 3e38f}) {
    EXPECT_EQ(round_to_film(x, 0.5f).value, 1l << 37);
    EXPECT_EQ(round_to_film(-x, 0.5f).value, -(1l << 37));
    EXPECT_EQ(round_to_film(x, 0.5f).verdict, SUN_FILM_CLAMPED);
  }
}

class FilmAdd : public testing::Test {
 protected:
  static constexpr uint pixels = 6, layers = 3;
  std::vector<long> words = std::vector<long>(layers * pixels * SUN_FILM_CHANNELS * SUN_FILM_BINS);
  std::vector<uint> counts = std::vector<uint>(SUN_COUNT_WORDS);
  FilmView view{words.data(), pixels, counts.data()};
  long at(uint layer, uint pixel, uint channel, uint bin) const { return words[((layer * pixels + pixel) * 3 + channel) * 2 + bin]; }
};

TEST_F(FilmAdd, GoesWhereItBelongs) {
  film_add(&view, 2, 5, 77, 1, 0, 0.25f, -3.0f, 0.0f);
  EXPECT_EQ(at(2, 5, 0, 0), 1l << 34);
  EXPECT_EQ(at(2, 5, 1, 1), -3 * 4096);
  long others = 0;
  for (const long word : words) others += word != 0;
  EXPECT_EQ(others, 2);
}

TEST_F(FilmAdd, CountsWhatItCannotTake) {
  film_add(&view, 0, 0, 1, 0, 0, infinity, std::nanf(""), 1e30f);
  EXPECT_EQ(counts[SUN_COUNT_NAN], 2u);
  EXPECT_EQ(counts[SUN_COUNT_CLAMPED], 1u);
  EXPECT_EQ(at(0, 0, 2, 1), 1l << 37);
  EXPECT_EQ(at(0, 0, 0, 0) | at(0, 0, 0, 1) | at(0, 0, 1, 0) | at(0, 0, 1, 1), 0);
}

// Two layers that take the same contributions hold the same integers: beauty is exactly the sum of its bounces.
TEST_F(FilmAdd, LayersTakeTheSameRounding) {
  for (uint sample = 0; sample < 1000; sample++) {
    const float x = 0.1f + unit_of_hash(hash2(sample, 5));
    for (uint layer = 0; layer < 2; layer++) film_add(&view, layer, 3, hash3(0, 3, 0), sample, SUN_FILM_KEY_DIRECT(1, 0u), x, x, x);
  }
  for (uint channel = 0; channel < 3; channel++)
    for (uint bin = 0; bin < 2; bin++) EXPECT_EQ(at(0, 3, channel, bin), at(1, 3, channel, bin));
}

// The dithers that film_add takes are uniform and differ by channel, sample, key and pixel: the means of sums are x to within five sigma.
TEST_F(FilmAdd, SumsAreUnbiased) {
  const float x = 0.3f / 4096 + 2.0f;  // a fraction of 0.3 of a coarse quantum
  const double fraction = static_cast<double>(x) * 4096 - std::floor(static_cast<double>(x) * 4096);
  constexpr uint n = 200000;
  const double bound = 5 * std::sqrt(n * fraction * (1 - fraction));
  for (uint i = 0; i < n; i++) film_add(&view, 0, 0, hash3(0, 1, 1), i, 0, x, x, x);           // over samples
  for (uint i = 0; i < n; i++) film_add(&view, 0, 1, hash3(0, i, 0), 0, 0, x, x, x);           // over pixels
  for (uint i = 0; i < n; i++) film_add(&view, 0, 2, hash3(0, 2, 2), 0, i, x, x, x);           // over keys
  for (uint pixel = 0; pixel < 3; pixel++)
    for (uint channel = 0; channel < 3; channel++)
      EXPECT_NEAR(static_cast<double>(at(0, pixel, channel, 1)), static_cast<double>(x) * 4096 * n, bound) << pixel << " " << channel;
}

TEST_F(FilmAdd, ChannelsDitherApart) {
  std::vector<double> counts_of_rises(8);
  for (uint i = 0; i < 80000; i++) {
    std::fill(words.begin(), words.end(), 0);
    const float half = 0.5f / 4096 + 1.0f;
    film_add(&view, 0, 0, hash3(0, 4, 4), i, 0, half, half, half);
    std::size_t rises = 0;
    for (uint channel = 0; channel < 3; channel++) rises = rises * 2 + (at(0, 0, channel, 1) > 4096 ? 1 : 0);
    counts_of_rises[rises]++;
  }
  EXPECT_LT(test::chi2_score_uniform(counts_of_rises), test::chi2_limit);
}

}  // namespace
}  // namespace sunstone::kernel
