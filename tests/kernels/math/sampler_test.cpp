// SPDX-License-Identifier: Apache-2.0
// The sampler: nets where Sobol' promises them, uniformity, and no dependence between dimensions, pixels, samples or seeds.
#include "math/sampler.h"

#include <gtest/gtest.h>

#include <functional>

#include "chi2.h"

namespace sunstone::kernel {
namespace {

using test::chi2_limit;
using test::chi2_score_uniform;

constexpr uint kinds[] = {SUN_SAMPLER_SOBOL, SUN_SAMPLER_INDEPENDENT};

// Sobol's second dimension as it is defined: the direction numbers of the polynomial x + 1, a bit of the index at a time.
uint sobol_second_by_bits(uint index) {
  uint result = 0;
  for (uint direction = 1u << 31; index; index >>= 1, direction ^= direction >> 1)
    if (index & 1) result ^= direction;
  return result;
}

// Every elementary interval of area 2^-m holds exactly one of the 2^m points.
void expect_net(int m, const std::function<vec2(uint)> &point, const char *what) {
  for (int mx = 0; mx <= m; mx++) {
    const int my = m - mx;
    std::vector<int> cells(std::size_t(1) << m);
    for (uint i = 0; i < 1u << m; i++) {
      const vec2 p = point(i);
      const auto x = static_cast<std::size_t>(p.x * static_cast<float>(1 << mx)), y = static_cast<std::size_t>(p.y * static_cast<float>(1 << my));
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      cells[(x << my) + y]++;
    }
    for (const int count : cells) ASSERT_EQ(count, 1) << what << ", m = " << m << ", split " << mx << " + " << my;
  }
}

// Counts of (a, b) on a grid of n x n, as chi2's score.
double joint_score(std::size_t n, std::size_t samples, const std::function<vec2(uint)> &pair) {
  std::vector<double> counts(n * n);
  for (uint i = 0; i < samples; i++) {
    const vec2 p = pair(i);
    counts[static_cast<std::size_t>(p.x * static_cast<float>(n)) * n + static_cast<std::size_t>(p.y * static_cast<float>(n))]++;
  }
  return chi2_score_uniform(counts);
}

TEST(Sampler, SecondDimensionByShifts) {
  for (uint i = 0; i < 5000; i++) {
    const uint index = i < 2500 ? i : hash2(i, 1);
    ASSERT_EQ(reverse_bits(sobol_second_reversed(index)), sobol_second_by_bits(index)) << index;
  }
}

TEST(Sampler, UnscrambledNet) {
  for (int m = 0; m <= 10; m++)
    expect_net(m, [](uint i) { return make_vec2(unit_of_hash(reverse_bits(i)), unit_of_hash(reverse_bits(sobol_second_reversed(i)))); }, "Sobol'");
}

TEST(Sampler, ScrambledNets) {
  for (uint pixel = 0; pixel < 12; pixel++)
    for (int m = 0; m <= 9; m++)
      for (const uint block : {0u, 1u, 5u})
        expect_net(m, [&](uint i) {
          const SamplerKey key = sampler_key(3, pixel, 7 * pixel, (block << m) + i, SUN_SAMPLER_SOBOL);
          return sample_2d(&key, pixel % 5);
        }, "scrambled");
}

// A scramble is a permutation that flips each bit by those above it alone: equal prefixes stay equal, and so long.
TEST(Sampler, ScrambleKeepsPrefixes) {
  for (uint i = 0; i < 20000; i++) {
    const uint a = hash2(i, 2), seed = hash2(i, 3), length = i % 32;
    const uint b = a ^ (0x80000000u >> length);  // the first bit that differs
    const uint sa = reverse_bits(owen_reversed(reverse_bits(a), seed)), sb = reverse_bits(owen_reversed(reverse_bits(b), seed));
    ASSERT_EQ(__builtin_clz(sa ^ sb), static_cast<int>(length));
  }
}

TEST(Sampler, OneDimensionIsTheFirstOfTwo) {
  for (const uint kind : kinds)
    for (uint i = 0; i < 1000; i++) {
      const SamplerKey key = sampler_key(i % 3, i, i / 7, i * 13, kind);
      ASSERT_EQ(sample_1d(&key, i % 40), sample_2d(&key, i % 40).x);
    }
}

TEST(Sampler, UniformOverPixels) {
  for (const uint kind : kinds)
    for (const uint sample : {0u, 1u, 1023u})
      for (const uint dimension : {0u, 1u, 2u, 77u}) {
        const double score = joint_score(32, 512 * 128, [&](uint i) {
          const SamplerKey key = sampler_key(1, i % 512, i / 512, sample, kind);
          return sample_2d(&key, dimension);
        });
        EXPECT_LT(score, chi2_limit) << kind << " sample " << sample << " dimension " << dimension;
      }
}

TEST(Sampler, UniformOverSamples) {
  for (const uint kind : kinds)
    for (uint pixel = 0; pixel < 6; pixel++) {
      const double score = joint_score(16, 16384, [&](uint i) {
        const SamplerKey key = sampler_key(9, pixel, 4, i, kind);
        return sample_2d(&key, 3);
      });
      EXPECT_LT(score, chi2_limit) << kind << " pixel " << pixel;
    }
}

// Over pixels, whose points are independent. (Within a pixel Sobol's pairs are joined by two scrambles that keep blocks together, so counts are
// more even
// in some ways and less in others than Pearson's test expects; that is the next test.)
TEST(Sampler, DimensionsAreIndependent) {
  const uint pairs[][2] = {{0, 1}, {1, 2}, {2, 3}, {5, 9}, {0, 64}, {6, 7}};
  for (const uint kind : kinds)
    for (const auto &pair : pairs)
      for (const uint sample : {0u, 1u, 37u})
        for (const bool second : {false, true}) {
          const double score = joint_score(16, 16384, [&](uint i) {
            const SamplerKey key = sampler_key(5, i % 128, i / 128, sample, kind);
            const vec2 a = sample_2d(&key, pair[0]), b = sample_2d(&key, pair[1]);
            return second ? make_vec2(a.y, b.y) : make_vec2(a.x, b.x);
          });
          EXPECT_LT(score, chi2_limit) << kind << " dimensions " << pair[0] << ", " << pair[1] << " sample " << sample;
        }
}

// Within a pixel: the squared error of a product's mean over 256 samples, against that of independent numbers. Two ideal Owen scrambles (each bit
// flipped by
// a strong hash of those above it, measured over 6000 pixels) give 1.58 +- 0.04 whatever the number of samples; ours must be as good.
TEST(Sampler, PaddedPairsDontCorrelate) {
  const uint pairs[][2] = {{0, 1}, {2, 3}, {6, 7}, {5, 70}};
  for (const uint kind : kinds)
    for (const auto &pair : pairs) {
      double squares = 0;
      for (uint pixel = 0; pixel < 400; pixel++) {
        double sum = 0;
        for (uint i = 0; i < 256; i++) {
          const SamplerKey key = sampler_key(6, pixel, 1, i, kind);
          sum += (static_cast<double>(sample_1d(&key, pair[0])) - 0.5) * (static_cast<double>(sample_1d(&key, pair[1])) - 0.5);
        }
        squares += sum / 256 * sum / 256;
      }
      const double ratio = squares / 400 / (1.0 / 144 / 256);
      const double ideal = kind == SUN_SAMPLER_SOBOL ? 1.58 : 1.0;
      EXPECT_NEAR(ratio, ideal, 0.4 * ideal) << kind << " dimensions " << pair[0] << ", " << pair[1];  // five sigma of 400 squares
    }
}

TEST(Sampler, NeighboursAreIndependent) {
  const auto value = [](uint seed, uint x, uint y, uint sample, uint kind) {
    const SamplerKey key = sampler_key(seed, x, y, sample, kind);
    return sample_1d(&key, 2);
  };
  const auto expect_independent = [&](const char *what, const std::function<vec2(uint)> &pair) {
    EXPECT_LT(joint_score(16, 65536, pair), chi2_limit) << what;
  };
  for (const uint k : kinds) {
    expect_independent("right", [&](uint i) { return make_vec2(value(0, i % 256, i / 256, 0, k), value(0, i % 256 + 1, i / 256, 0, k)); });
    expect_independent("below", [&](uint i) { return make_vec2(value(0, i % 256, i / 256, 0, k), value(0, i % 256, i / 256 + 1, 0, k)); });
    expect_independent("samples of two", [&](uint i) { return make_vec2(value(0, 9, 9, i, k), value(0, 10, 9, i, k)); });
    expect_independent("seeds", [&](uint i) { return make_vec2(value(0, 9, 9, i, k), value(1, 9, 9, i, k)); });
    expect_independent("turned", [&](uint i) { return make_vec2(value(0, i % 256, 300 + i / 256, 0, k), value(0, 300 + i / 256, i % 256, 0, k)); });
  }
  constexpr uint plain = SUN_SAMPLER_INDEPENDENT;
  expect_independent("next sample", [&](uint i) { return make_vec2(value(0, i, 0, 0, plain), value(0, i, 0, 1, plain)); });
}

// Sobol' is worth having: the mean of a smooth function over 1024 samples, against what independent numbers give.
TEST(Sampler, SobolConvergesFaster) {
  double error[2] = {0, 0};
  for (const uint kind : kinds)
    for (uint pixel = 0; pixel < 64; pixel++) {
      double sum = 0;
      for (uint i = 0; i < 1024; i++) {
        const SamplerKey key = sampler_key(2, pixel, 0, i, kind);
        const vec2 u = sample_2d(&key, 4);
        sum += static_cast<double>(u.x) * u.x * u.y;
      }
      const double off = sum / 1024 - 1.0 / 6;
      error[kind] += off * off;
    }
  EXPECT_LT(error[SUN_SAMPLER_SOBOL] * 1000, error[SUN_SAMPLER_INDEPENDENT]);
}

TEST(Sampler, HashesAvalanche) {
  // Each bit of each input word flips each bit of the result in half of the cases.
  for (int word = 0; word < 4; word++)
    for (int bit = 0; bit < 32; bit++) {
      int flips[32] = {};
      constexpr int trials = 4096;
      for (uint i = 0; i < trials; i++) {
        uint in[4] = {i, i * 7 % 61, i % 13, 3 * i};
        const uint before = hash4(in[0], in[1], in[2], in[3]);
        in[word] ^= 1u << bit;
        const uint change = before ^ hash4(in[0], in[1], in[2], in[3]);
        for (int b = 0; b < 32; b++) flips[b] += change >> b & 1;
      }
      for (int b = 0; b < 32; b++) EXPECT_NEAR(flips[b], trials / 2, 6 * 32) << "word " << word << " bit " << bit << " -> " << b;
    }
}

TEST(Sampler, CoinsAreFairAndIndependent) {
  for (const uint salt : {0u, 1u}) {
    EXPECT_LT(joint_score(16, 65536, [&](uint i) {
      const SamplerKey key = sampler_key(0, i % 64, i / 64 % 64, i / 4096, SUN_SAMPLER_SOBOL);
      return make_vec2(hash_coin(&key, 1, 5, 100, salt), hash_coin(&key, 1, 5, 101, salt));
    }), chi2_limit);
    EXPECT_LT(joint_score(16, 65536, [&](uint i) {
      const SamplerKey key = sampler_key(0, 3, 4, i, SUN_SAMPLER_SOBOL);
      return make_vec2(hash_coin(&key, 0, 5, 100, salt), hash_coin(&key, 1, 5, 100, 1 - salt));
    }), chi2_limit);
  }
  for (uint i = 0; i < 1000; i++) {
    const SamplerKey key = sampler_key(8, i, i / 3, i % 17, SUN_SAMPLER_SOBOL);
    ASSERT_EQ(hash_coin(&key, i % 5, i % 3, i, i % 2), hash_coin_1(hash3_1(8, i, i / 3), i % 17, i % 5, i % 3, i, i % 2));
  }
}

// The bits of every picture hang on these: a change here changes all of them.
TEST(Sampler, KnownValues) {
  const auto number = [](uint kind, uint x, uint y, uint sample, uint dimension) {
    const SamplerKey key = sampler_key(0, x, y, sample, kind);
    const vec2 u = sample_2d(&key, dimension);
    return std::pair(static_cast<int>(u.x * 16777216), static_cast<int>(u.y * 16777216));
  };
  EXPECT_EQ(number(SUN_SAMPLER_SOBOL, 0, 0, 0, 0), std::pair(11807368, 8984898));
  EXPECT_EQ(number(SUN_SAMPLER_SOBOL, 17, 4, 1, 3), std::pair(1828915, 16538407));
  EXPECT_EQ(number(SUN_SAMPLER_SOBOL, 1919, 1079, 1000000, 70), std::pair(9952369, 8337585));
  EXPECT_EQ(number(SUN_SAMPLER_INDEPENDENT, 0, 0, 0, 0), std::pair(3442440, 10387820));
  EXPECT_EQ(number(SUN_SAMPLER_INDEPENDENT, 17, 4, 1, 3), std::pair(12128236, 5860626));
  EXPECT_EQ(hash4(1, 2, 3, 4), 0x8935b7bbu);
}

}  // namespace
}  // namespace sunstone::kernel
