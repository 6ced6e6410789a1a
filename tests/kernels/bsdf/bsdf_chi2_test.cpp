// SPDX-License-Identifier: Apache-2.0
// Does lobes_sample draw from the density that lobes_eval states? Pearson's chi-square over cells that follow the lobes, for every material and
// several wo; Holm's correction over all of them, to a false-alarm rate of 1e-6 for the whole program. Samples that are deltas or invalid are one
// more cell, so the mass of the density is tested too. A density that is 5 % wrong on half of the sphere has to be found, by the same test.
#include <gtest/gtest.h>

#include "kernels/bsdf/materials.h"
#include "kernels/bsdf/sphere.h"

namespace sunstone::test {
namespace {

constexpr double false_alarm = 1e-6;
constexpr std::size_t pilot_count = 60'000, count = 400'000;

// Chance of a chi-square as large as that of `count` samples, where pdf is what eval says times distortion(wi).
double p_value(const Bsdf &bsdf, const std::vector<float> &tables, vec3 wo, std::uint64_t seed, const std::function<double(vec3)> &distortion) {
  const Lobes lobes = bsdf_lobes(&bsdf, tables.data(), wo);
  Random random(seed);
  const auto draw = [&] {
    const float u = random.unit(), v = random.unit(), w = random.unit();
    return lobes_sample(&lobes, tables.data(), wo, u, v, w);
  };
  std::vector<std::array<double, 2>> pilot;
  for (std::size_t i = 0; i < pilot_count; i++)
    if (const BsdfSample s = draw(); s.valid && !s.delta) pilot.push_back(square_of(s.wi));
  const SphereHistogram histogram(pilot, pilot_count / 150);

  const std::size_t cells = histogram.cells().size();
  std::vector<double> seen(cells + 1), expected(cells + 1);
  for (std::size_t i = 0; i < count; i++) {
    const BsdfSample s = draw();
    seen[s.valid && !s.delta ? histogram.find(square_of(s.wi)) : cells]++;
  }
  const SphereIntegral integral([&](vec3 wi) { return double(lobes_eval(&lobes, tables.data(), wo, wi).pdf) * distortion(wi); }, 1e-7);
  double rest = double(count);
  for (std::size_t i = 0; i < cells; i++) {
    expected[i] = double(count) * integral.over(histogram.cells()[i]);
    rest -= expected[i];
  }
  expected[cells] = std::max(rest, 0.0);

  // Cells that expect little go together; and what little they expect then is no cause for alarm.
  double chi2 = 0, pooled_seen = 0, pooled_expected = 0;
  int used = 0;
  const auto add = [&](double s, double e) {
    chi2 += (s - e) * (s - e) / e;
    used++;
  };
  for (std::size_t i = 0; i <= cells; i++) {
    if (expected[i] >= 40) add(seen[i], expected[i]);
    else pooled_seen += seen[i], pooled_expected += expected[i];
  }
  if (pooled_expected >= 10 || pooled_seen >= 60) add(pooled_seen, std::max(pooled_expected, 10.0));
  return used > 1 ? chi2_tail(chi2, used - 1) : 1.0;
}

TEST(BsdfChi2, SamplesFollowTheDensity) {
  const std::vector<float> tables = make_tables();
  std::vector<std::pair<double, std::string>> results;
  std::uint64_t seed = 1;
  for (const Material &material : all_materials())
    for (const float cosine : {0.08f, 0.5f, 0.97f})
      results.emplace_back(p_value(material.bsdf, tables, direction(cosine, 0.4f + cosine), seed++, [](vec3) { return 1.0; }),
                           material.name + ", cos " + std::to_string(cosine));
  std::sort(results.begin(), results.end());
  for (std::size_t i = 0; i < results.size(); i++) {
    EXPECT_GE(results[i].first, false_alarm / double(results.size() - i)) << results[i].second;
    if (i == 0) RecordProperty("smallest_p", std::to_string(results[i].first));
  }
  std::printf("smallest p of %zu: %.3g (%s)\n", results.size(), results[0].first, results[0].second.c_str());
}

TEST(BsdfChi2, ADensityOffByFivePercentIsFound) {
  const std::vector<float> tables = make_tables();
  const auto all = all_materials();
  int found = 0, tried = 0;
  for (const Material &material : all) {
    if (bsdf_sample(&material.bsdf, tables.data(), direction(0.5f), 0.0f, 0.5f, 0.5f).delta) continue;  // little but deltas to look at
    const auto off = [](vec3 wi) { return wi.x * 0.6f + wi.y * 0.8f > 0.0f ? 1.05 : 0.95; };
    const auto heavy = [](vec3) { return 1.05; };
    tried += 2;
    const double p_off = p_value(material.bsdf, tables, direction(0.97f, 0.0f), 7, off);
    const double p_heavy = p_value(material.bsdf, tables, direction(0.5f), 8, heavy);
    EXPECT_LT(p_off, false_alarm / 100) << material.name;
    EXPECT_LT(p_heavy, false_alarm / 100) << material.name;
    found += (p_off < false_alarm / 100) + (p_heavy < false_alarm / 100);
  }
  std::printf("%d of %d wrong densities found\n", found, tried);
  EXPECT_GE(tried, 30);
}

}  // namespace
}  // namespace sunstone::test
