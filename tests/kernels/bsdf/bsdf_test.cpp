// SPDX-License-Identifier: Apache-2.0
// Closed forms and identities of the BSDF: Fresnel and Snell, mirrors and glass, Lambert to the bit, reciprocity, and nothing but finite numbers.
#include <gtest/gtest.h>

#include "kernels/bsdf/materials.h"
#include "shared/tables.h"

namespace sunstone::test {
namespace {

const std::vector<float> &tables() {
  static const std::vector<float> made = make_tables();
  return made;
}

double exact_fresnel(double cosine, double eta) {
  const double sine_far = std::sqrt(1 - cosine * cosine) / eta;
  if (sine_far >= 1) return 1;
  const double far = std::sqrt(1 - sine_far * sine_far);
  const double parallel = (eta * cosine - far) / (eta * cosine + far), perpendicular = (cosine - eta * far) / (cosine + eta * far);
  return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// As facets are asked: from the cosine and the ior.
float reflectance(float cosine, float eta, float *far) {
  *far = refracted_cosine(cosine, 1.0f / eta);
  return fresnel_dielectric(cosine, eta, *far);
}

TEST(Fresnel, KnownValues) {
  float far;
  EXPECT_NEAR(reflectance(1.0f, 1.5f, &far), 0.04, 1e-7);  // ((n - 1) / (n + 1))^2
  EXPECT_FLOAT_EQ(far, 1.0f);
  EXPECT_NEAR(reflectance(1.0f, 1.0f / 1.5f, &far), 0.04, 1e-7);
  EXPECT_NEAR(reflectance(0.5f, 1.5f, &far), 0.0891867, 1e-6);  // 60 degrees: r_s = (1 - sqrt 6) / (1 + sqrt 6), r_p likewise
  EXPECT_NEAR(far, std::sqrt(2.0 / 3.0), 1e-6);                        // sin = sin 60 / 1.5
  const double brewster = std::cos(std::atan(1.5));                    // no parallel part: half of the perpendicular one
  EXPECT_NEAR(reflectance(float(brewster), 1.5f, &far), 0.5 * std::pow((1 - 2.25) / (1 + 2.25), 2), 1e-6);
  EXPECT_FLOAT_EQ(reflectance(0.0f, 1.5f, &far), 1.0f);
  const double critical = std::sqrt(1 - 1 / 2.25);
  EXPECT_EQ(reflectance(float(critical * 0.999), 1.0f / 1.5f, &far), 1.0f);
  EXPECT_EQ(far, 0.0f);
  EXPECT_LT(reflectance(float(critical * 1.001), 1.0f / 1.5f, &far), 1.0f);
  for (int i = 1; i <= 100; i++)
    for (const double eta : {0.4, 0.75, 1.0, 1.33, 2.42, 4.0})
      EXPECT_NEAR(reflectance(float(i) / 100.0f, float(eta), &far), exact_fresnel(float(i) / 100.0f, float(eta)), 2e-6) << i << ' ' << eta;
}

TEST(Smooth, MirrorReflectsAsSchlickSays) {
  const Bsdf b = metal(make_vec3(0.9f, 0.6f, 0.3f), 0.0f);
  const vec3 wo = direction(0.5f);
  const BsdfSample s = bsdf_sample(&b, tables().data(), wo, 0.3f, 0.1f, 0.9f);
  ASSERT_TRUE(s.valid && s.delta && !s.transmitted);
  EXPECT_EQ(s.pdf, 0.0f);
  EXPECT_NEAR(s.wi.x, -wo.x, 1e-6);
  EXPECT_NEAR(s.wi.y, -wo.y, 1e-6);
  EXPECT_NEAR(s.wi.z, wo.z, 1e-6);
  EXPECT_NEAR(s.weight.x, 0.9 + 0.1 / 32, 1e-6);
  EXPECT_NEAR(s.weight.z, 0.3 + 0.7 / 32, 1e-6);
  const BsdfEval e = bsdf_eval(&b, tables().data(), wo, s.wi);
  EXPECT_EQ(e.f_cos.x, 0.0f);
  EXPECT_EQ(e.pdf, 0.0f);
}

TEST(Smooth, GlassObeysSnellWithoutNoise) {
  for (const float eta : {1.5f, 1.0f / 1.5f})
    for (const float cosine : {0.05f, 0.3f, 0.7f, 0.8f, 1.0f}) {
      const Bsdf b = glass(splat3(1.0f), 0.0f, eta);
      const vec3 wo = direction(cosine);
      const double reflectance = exact_fresnel(wo.z, eta);
      int reflected = 0, n = 2000;
      for (int i = 0; i < n; i++) {
        const BsdfSample s = bsdf_sample(&b, tables().data(), wo, (float(i) + 0.5f) / float(n), 0.3f, 0.6f);
        ASSERT_TRUE(s.valid && s.delta);
        ASSERT_NEAR(s.weight.y * (s.transmitted ? eta * eta : 1.0f), 1.0, 1e-5) << cosine;
        reflected += !s.transmitted;
        if (!s.transmitted) continue;
        const double sine_o = std::hypot(wo.x, wo.y), sine_i = std::hypot(s.wi.x, s.wi.y);
        ASSERT_NEAR(sine_o, eta * sine_i, 2e-6);
        ASSERT_LT(s.wi.z, 0.0f);
        ASSERT_NEAR(s.wi.x * wo.y, s.wi.y * wo.x, 2e-6);                // in one plane,
        ASSERT_LE(s.wi.x * wo.x + s.wi.y * wo.y, 0.0f);                 // on the other side of the normal
        ASSERT_NEAR(dot3(s.wi, s.wi), 1.0, 1e-5);
      }
      EXPECT_NEAR(reflected, reflectance * n, 1.0) << "eta " << eta << ", cos " << cosine;
      if (reflectance == 1) { EXPECT_EQ(reflected, n); }  // total internal reflection
    }
}

TEST(Smooth, StraightPassage) {
  const vec3 wo = direction(0.5f), base = make_vec3(0.8f, 0.5f, 0.2f);
  const Bsdf slab = thin(base, 0.0f, 0.75f);
  const float passes = 0.75f * (1.0f - (0.04f + 0.96f / 32.0f));
  vec3 t = bsdf_straight(&slab, wo);
  EXPECT_NEAR(t.x, base.x * passes, 1e-6);
  EXPECT_NEAR(t.z, base.z * passes, 1e-6);
  const Bsdf same = glass(base, 0.4f, 1.00005f);
  t = bsdf_straight(&same, wo);
  EXPECT_NEAR(t.y, base.y, 1e-6);
  for (const Bsdf &other : {thin(base, 0.2f), glass(base, 0.0f, 1.5f), lambert(1.0f), metal(base, 0.0f), plastic(base, 0.0f)})
    EXPECT_EQ(max_of3(bsdf_straight(&other, wo)), 0.0f);

  // Sampling agrees: the mean weight of passing straight on is that transmittance.
  for (const Bsdf &b : {slab, same}) {
    double sum = 0;
    const int n = 100'000;
    Random random(4);
    for (int i = 0; i < n; i++) {
      const float v = random.unit(), w = random.unit();
      const BsdfSample s = bsdf_sample(&b, tables().data(), wo, (float(i) + 0.5f) / float(n), v, w);
      if (!s.valid || !s.delta || !s.transmitted) continue;
      ASSERT_EQ(s.wi.x, -wo.x);
      ASSERT_EQ(s.wi.y, -wo.y);
      ASSERT_EQ(s.wi.z, -wo.z);
      sum += s.weight.y;
    }
    EXPECT_NEAR(sum / n, bsdf_straight(&b, wo).y, 2e-3);
  }
}

TEST(Diffuse, LambertToTheBit) {
  const Bsdf b = lambert(0.6f);
  Random random(1);
  for (int i = 0; i < 1000; i++) {
    const vec3 wo = direction(std::max(random.unit(), 1e-3f)), wi = direction(std::max(random.unit(), 1e-3f), 2.0f);
    const BsdfEval e = bsdf_eval(&b, tables().data(), wo, wi);
    ASSERT_EQ(e.f_cos.x, (0.6f * SUN_INV_PI) * wi.z);
    ASSERT_EQ(e.pdf, wi.z * SUN_INV_PI);
    ASSERT_EQ(bsdf_eval(&b, tables().data(), wo, flip(wi)).pdf, 0.0f);
    const float u = random.unit(), v = random.unit(), w = random.unit();
    const BsdfSample s = bsdf_sample(&b, tables().data(), wo, u, v, w);
    if (s.wi.z > 0.0f) { ASSERT_NEAR(s.weight.x, 0.6f, 2e-7f); }
  }
  // A coat of no reflectance is no coat.
  Bsdf coated = plastic(splat3(0.6f), 0.3f, 0.0f, 0.0f);
  const vec3 wo = direction(0.3f), wi = direction(0.7f, 2.0f);
  EXPECT_EQ(bsdf_eval(&coated, tables().data(), wo, wi).f_cos.x, bsdf_eval(&b, tables().data(), wo, wi).f_cos.x);
}

TEST(Bsdf, Reciprocal) {
  Random random(2);
  int compared = 0;
  for (const Material &material : all_materials())
    for (int i = 0; i < 2000; i++) {
      const Bsdf &b = material.bsdf;
      const vec3 wo = direction(0.02f + 0.98f * random.unit(), 6.2f * random.unit());
      vec3 wi = direction(0.02f + 0.98f * random.unit(), 6.2f * random.unit());
      if (i % 2) {  // one that matters to narrow lobes
        const float u = random.unit(), v = random.unit(), w = random.unit();
        const BsdfSample s = bsdf_sample(&b, tables().data(), wo, u, v, w);
        if (!s.valid || s.delta || std::fabs(s.wi.z) < 0.02f) continue;
        wi = normalize3(s.wi);
      } else if (i % 4 == 0) wi = flip(wi);
      const bool across = wi.z < 0.0f;
      const Bsdf other = across && b.solid ? from_other_side(b) : b;
      const vec3 there = bsdf_eval(&b, tables().data(), wo, wi).f_cos;
      const vec3 back = across ? bsdf_eval(&other, tables().data(), flip(wi), flip(wo)).f_cos : bsdf_eval(&other, tables().data(), wi, wo).f_cos;
      const double squeeze = across && b.solid ? double(b.eta) * b.eta : 1.0;
      for (const auto &[f, g] : {std::pair{there.x, back.x}, {there.y, back.y}, {there.z, back.z}}) {
        const double forward = squeeze * f / std::fabs(wi.z), backward = g / wo.z;
        ASSERT_NEAR(forward, backward, 4e-3 * std::max(forward, backward) + 2e-5) << material.name << " at " << wi.z << ' ' << wo.z;
      }
      compared += there.y > 0.0f;
    }
  EXPECT_GT(compared, 20'000);
}

TEST(Bsdf, WeightIsValueOverDensity) {
  Random random(3);
  int looked_at = 0;
  for (const Material &material : all_materials())
    for (int i = 0; i < 2000; i++) {
      const vec3 wo = direction(0.01f + 0.99f * random.unit(), 6.2f * random.unit());
      const float u = random.unit(), v = random.unit(), w = random.unit();
      const BsdfSample s = bsdf_sample(&material.bsdf, tables().data(), wo, u, v, w);
      if (!s.valid) {
        ASSERT_EQ(max_of3(s.weight), 0.0f);
        continue;
      }
      ASSERT_EQ(s.transmitted != 0, s.wi.z < 0.0f) << material.name;
      if (s.delta) {
        ASSERT_EQ(s.pdf, 0.0f);
        continue;
      }
      const BsdfEval e = bsdf_eval(&material.bsdf, tables().data(), wo, s.wi);
      ASSERT_EQ(e.pdf, s.pdf) << material.name;
      ASSERT_NEAR(s.weight.y * s.pdf, e.f_cos.y, 1e-6f * e.f_cos.y) << material.name;
      ASSERT_NEAR(dot3(s.wi, s.wi), 1.0f, 1e-4f) << material.name;
      looked_at++;
    }
  EXPECT_GT(looked_at, 30'000);
}

// Every parameter at its limits and in between, grazing views, all corners of the sample square.
TEST(Bsdf, StaysFinite) {
  Random random(5);
  const auto extreme = [&](float lower, float upper) {
    const float choice = random.unit();
    return choice < 0.2f ? lower : choice < 0.4f ? upper : lower + (upper - lower) * random.unit();
  };
  const auto unit = [&] { return random.unit() < 0.2f ? 0.0f : random.unit() < 0.2f ? 0x1.fffffep-1f : random.unit(); };
  const float cosines[] = {1e-30f, 1e-12f, 1e-7f, 1e-6f, 1e-4f, 1e-3f, 0.03f, 0.5f, 0.9999f, 1.0f};
  const float etas[] = {0.001f, 1.0f / 3.0f, 1.0f / 1.5f, 0.9999f, 0.99995f, 1.0f, 1.0001f, 1.00011f, 1.02f, 1.5f, 3.0f, 1000.0f};
  const float alphas[] = {0.0f, 1e-8f, 0.000999f, 0.001f, 0.0011f, 0.01f, 0.3f, 1.0f};
  const auto finite = [](vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && v.x >= 0 && v.y >= 0 && v.z >= 0; };
  for (int i = 0; i < 200'000; i++) {
    Bsdf b{};
    b.base = make_vec3(extreme(0, 1), extreme(0, 1), extreme(0, 1));
    b.metallic = extreme(0, 1), b.transmission = extreme(0, 1);
    b.alpha = alphas[random.bits() % std::size(alphas)];
    b.f0 = make_vec3(extreme(0, 1), extreme(0, 1), extreme(0, 1)), b.f90 = extreme(0, 1);
    b.eta = etas[random.bits() % std::size(etas)];
    b.solid = int(random.bits() & 1), b.inside = b.eta < 1.0f, b.specular = random.unit() < 0.9f;
    const vec3 wo = direction(cosines[random.bits() % std::size(cosines)], 6.3f * random.unit());
    const float u = unit(), v = unit(), w = unit();
    const BsdfSample s = bsdf_sample(&b, tables().data(), wo, u, v, w);
    ASSERT_TRUE(finite(s.weight)) << i;
    ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0) << i;
    ASSERT_TRUE(std::isfinite(s.wi.x) && std::isfinite(s.wi.y) && std::isfinite(s.wi.z)) << i;
    vec3 wi = direction(cosines[random.bits() % std::size(cosines)], 6.3f * random.unit());
    if (random.bits() & 1) wi = flip(wi);
    if (i % 5 == 0) wi = negate3(wo);
    const BsdfEval e = bsdf_eval(&b, tables().data(), wo, wi);
    ASSERT_TRUE(finite(e.f_cos)) << i;
    ASSERT_TRUE(std::isfinite(e.pdf) && e.pdf >= 0) << i;
    const vec3 albedo = bsdf_albedo(&b, tables().data(), wo), straight = bsdf_straight(&b, wo);
    ASSERT_TRUE(finite(albedo) && max_of3(albedo) < 1.01f) << i;
    ASSERT_TRUE(finite(straight) && max_of3(straight) <= 1.0f) << i;
  }
}

TEST(Bsdf, BlackAndUnseenEndThePath) {
  const Bsdf black = lambert(0.0f), grey = lambert(0.5f);
  const BsdfSample s = bsdf_sample(&black, tables().data(), direction(0.5f), 0.5f, 0.3f, 0.6f);
  EXPECT_EQ(max_of3(s.weight), 0.0f);
  const BsdfSample behind = bsdf_sample(&grey, tables().data(), flip(direction(0.5f)), 0.5f, 0.3f, 0.6f);
  EXPECT_FALSE(behind.valid);
  EXPECT_EQ(max_of3(bsdf_eval(&grey, tables().data(), flip(direction(0.5f)), direction(0.5f)).f_cos), 0.0f);
}

TEST(Tables, FollowTheStandardAndTheirLimits) {
  const auto &t = tables();
  ASSERT_EQ(t.size(), std::size_t(SUN_TABLE_FLOATS));
  EXPECT_EQ(t[SUN_TABLE_SRGB], 0.0f);
  EXPECT_EQ(t[SUN_TABLE_SRGB + 255], 1.0f);
  for (int i = 0; i < 256; i++) {
    const double encoded = i / 255.0;
    EXPECT_NEAR(t[std::size_t(SUN_TABLE_SRGB + i)], encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4), 2e-7) << i;
  }
  for (std::size_t i = SUN_TABLE_SPLIT_A; i < SUN_TABLE_FILTER; i++) ASSERT_TRUE(t[i] >= 0.0f && t[i] <= 1.0f) << i;
  for (std::size_t i = SUN_TABLE_FILTER; i < t.size(); i++) ASSERT_EQ(t[i], 0.0f);
  // Smooth: the Fresnel term itself, nothing lost; its mean is 1/21. Alpha 1 at normal incidence: D is 1 / pi and G2 / G1 is 2 c / (1 + c) with
  // c = cos i = 2 (cos h)^2 - 1, so E is the integral of 2 - 1 / s over s = (cos h)^2 from 1/2 to 1: 1 - ln 2.
  const Split smooth = split_albedo(t.data(), 0.0f, 0.25f);
  EXPECT_NEAR(smooth.b, std::pow(0.75, 5), 2e-3);
  EXPECT_NEAR(smooth.lost, 0.0f, 1e-6);
  EXPECT_NEAR(split_mean(t.data(), 0.0f).b, 1.0 / 21, 1e-3);
  EXPECT_NEAR(1 - split_albedo(t.data(), 1.0f, 1.0f).lost, 1 - std::log(2.0), 2e-3);
}

}  // namespace
}  // namespace sunstone::test
