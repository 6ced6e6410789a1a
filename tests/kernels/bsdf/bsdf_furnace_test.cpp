// SPDX-License-Identifier: Apache-2.0
// White furnaces: under uniform light a white surface of any kind and roughness shows just that light. The mean of the sampled weights (times eta^2
// where light was refracted: see bsdf.h) may not exceed 1 by more than noise, and falls short by no more than the tables' interpolation error.
#include <gtest/gtest.h>

#include "kernels/bsdf/materials.h"
#include "kernels/bsdf/sphere.h"

namespace sunstone::test {
namespace {

struct Mean {
  double value = 0, error = 0;  // and its standard error
};

// Stratified over (u0, u1), so the standard error of plain sampling is an upper bound.
Mean furnace(const Bsdf &bsdf, const std::vector<float> &tables, vec3 wo, int strata, std::uint64_t seed) {
  const Lobes lobes = bsdf_lobes(&bsdf, tables.data(), wo);
  Random random(seed);
  const bool bends = bsdf.solid && !(std::fabs(bsdf.eta - 1.0f) < SUN_SAME_IOR);
  double sum = 0, squares = 0;
  for (int i = 0; i < strata; i++)
    for (int j = 0; j < strata; j++) {
      const float u = random.unit(), u0 = (float(i) + random.unit()) / float(strata), u1 = (float(j) + random.unit()) / float(strata);
      const BsdfSample s = lobes_sample(&lobes, tables.data(), wo, u, std::min(u0, 0x1.fffffep-1f), std::min(u1, 0x1.fffffep-1f));
      if (!s.valid) continue;
      double weight = s.weight.y;
      if (s.transmitted && bends) weight *= double(bsdf.eta) * bsdf.eta;
      sum += weight, squares += weight * weight;
    }
  const double n = double(strata) * strata;
  return {sum / n, std::sqrt(std::max(squares / n - sum / n * (sum / n), 0.0) / n)};
}

struct Kind {
  std::string name;
  std::function<Bsdf(float alpha)> make;
  double least;  // mean weight; what is missing is the tables' interpolation, kept on the dark side
};

std::vector<Kind> white_kinds() {
  const vec3 white = splat3(1.0f);
  return {{"lambert", [=](float) { return lambert(1.0f); }, 0.9999},
          {"metal", [=](float alpha) { return metal(white, alpha); }, 0.995},
          {"plastic", [=](float alpha) { return plastic(white, alpha); }, 0.995},
          {"strong coat", [=](float alpha) { return plastic(white, alpha, 0.5f); }, 0.995},
          {"half metal",
           [=](float alpha) {
             Bsdf b = plastic(white, alpha);
             b.metallic = 0.5f;
             return b;
           },
           0.995},
          {"thin", [=](float alpha) { return thin(white, alpha); }, 0.995},
          {"thin, half diffuse", [=](float alpha) { return thin(white, alpha, 0.5f); }, 0.995},
          {"glass", [=](float alpha) { return glass(white, alpha, 1.5f); }, 0.99},
          {"glass from inside", [=](float alpha) { return glass(white, alpha, 1.0f / 1.5f); }, 0.99},
          {"water", [=](float alpha) { return glass(white, alpha, 1.33f); }, 0.99},
          {"water from inside", [=](float alpha) { return glass(white, alpha, 1.0f / 1.33f); }, 0.99},
          {"diamond", [=](float alpha) { return glass(white, alpha, 2.42f); }, 0.99},
          {"diamond from inside", [=](float alpha) { return glass(white, alpha, 1.0f / 2.42f); }, 0.99},
          {"glass, half diffuse", [=](float alpha) { return glass(white, alpha, 1.5f, 0.5f); }, 0.99},
          {"nearly the same ior", [=](float alpha) { return glass(white, alpha, 1.02f); }, 0.985},
          {"nearly the same ior from inside", [=](float alpha) { return glass(white, alpha, 1.0f / 1.02f); }, 0.93}};
}

TEST(BsdfFurnace, WhiteStaysWhite) {
  const std::vector<float> tables = make_tables();
  double most = 0, least = 2;
  std::uint64_t seed = 1;
  for (const Kind &kind : white_kinds())
    for (const float alpha : {0.0f, 0.001f, 0.01f, 0.05f, 0.15f, 0.4f, 0.75f, 1.0f})
      for (const float cosine : {0.1f, 0.25f, 0.6f, 1.0f}) {
        const Mean mean = furnace(kind.make(alpha), tables, direction(cosine), 160, seed++);
        EXPECT_LE(mean.value, 1 + 5 * mean.error + 2e-4) << kind.name << ", alpha " << alpha << ", cos " << cosine;
        EXPECT_GE(mean.value, kind.least - 5 * mean.error) << kind.name << ", alpha " << alpha << ", cos " << cosine;
        most = std::max(most, mean.value - 5 * mean.error), least = std::min(least, mean.value + 5 * mean.error);
      }
  std::printf("mean weights surely at least %.5f somewhere, surely at most %.5f somewhere\n", most, least);
}

// Within a degree of the surface the tables are coarse, more so for smooth surfaces: light may be lost there, but hardly made.
TEST(BsdfFurnace, GrazingLosesRatherThanGains) {
  const std::vector<float> tables = make_tables();
  for (const Kind &kind : white_kinds())
    for (const float alpha : {0.0f, 0.003f, 0.03f, 0.3f, 1.0f})
      for (const float cosine : {0.001f, 0.017f}) {
        const Mean mean = furnace(kind.make(alpha), tables, direction(cosine), 100, 3);
        EXPECT_LE(mean.value, 1.01 + 5 * mean.error) << kind.name << ", alpha " << alpha << ", cos " << cosine;
        EXPECT_GE(mean.value, 0.9 - 5 * mean.error) << kind.name << ", alpha " << alpha << ", cos " << cosine;
      }
}

// What a coloured material reflects is below 1, and bsdf_albedo states it, but for solid glass.
TEST(BsdfFurnace, AlbedoIsTheMeanWeight) {
  const std::vector<float> tables = make_tables();
  for (const Material &material : all_materials())
    for (const float cosine : {0.2f, 0.8f}) {
      const vec3 wo = direction(cosine);
      const Mean mean = furnace(material.bsdf, tables, wo, 160, 11);
      const double albedo = bsdf_albedo(&material.bsdf, tables.data(), wo).y;
      EXPECT_LE(mean.value, 1 + 5 * mean.error + 2e-4) << material.name;
      EXPECT_NEAR(mean.value, albedo, material.bsdf.solid ? 0.25 : 0.004 + 5 * mean.error) << material.name << ", cos " << cosine;
    }
}

// The sampled mean is the integral of f cos that eval states: weights and values are of one function. Deltas have their share in the first alone.
TEST(BsdfFurnace, SampledMeanIsTheIntegralOfEval) {
  const std::vector<float> tables = make_tables();
  int looked_at = 0;
  for (const Material &material : all_materials()) {
    const vec3 wo = direction(0.6f);
    const Bsdf &bsdf = material.bsdf;
    const Lobes lobes = bsdf_lobes(&bsdf, tables.data(), wo);
    if (lobes.delta_reflection || lobes.delta_transmission) continue;
    const auto f = [&](vec3 wi) {
      return double(lobes_eval(&lobes, tables.data(), wo, wi).f_cos.y) * (wi.z < 0.0f && bsdf.solid ? double(bsdf.eta) * bsdf.eta : 1.0);
    };
    const double integral = SphereIntegral(f, 1e-6).over(Cell{});
    const Mean mean = furnace(bsdf, tables, wo, 300, 5);
    EXPECT_NEAR(mean.value, integral, 5 * mean.error + 3e-4) << material.name;
    looked_at++;
  }
  EXPECT_GE(looked_at, 20);
}

}  // namespace
}  // namespace sunstone::test
