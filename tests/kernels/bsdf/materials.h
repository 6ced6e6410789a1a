// SPDX-License-Identifier: Apache-2.0
// The materials that the BSDF's tests go through, and small helpers; kernels compiled as C++.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bsdf/bsdf.h"
#include "flatten/tables.h"

namespace sunstone::test {

using namespace sunstone::kernel;

// A generator for tests: Steele, Lea and Flood's SplitMix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  float unit() { return float(bits() >> 40) * 0x1p-24f; }  // as the renderer's samplers: 24 bits, below 1

 private:
  std::uint64_t state_;
};

inline vec3 direction(float cosine, float azimuth = 0.7f) {
  const float sine = std::sqrt((1.0f - cosine) * (1.0f + cosine));
  return normalize3(make_vec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine));
}

inline Bsdf lambert(float base) {
  Bsdf b{};
  b.base = splat3(base);
  b.alpha = 1.0f;
  b.eta = 1.0f;
  return b;
}
inline Bsdf metal(vec3 base, float alpha) {
  Bsdf b = lambert(0.0f);
  b.base = base;
  b.metallic = 1.0f;
  b.alpha = alpha;
  b.f0 = splat3(0.04f);
  b.f90 = 1.0f;
  b.specular = 1;
  return b;
}
inline Bsdf plastic(vec3 base, float alpha, float f0 = 0.04f, float f90 = 1.0f) {
  Bsdf b = metal(base, alpha);
  b.metallic = 0.0f;
  b.f0 = splat3(f0);
  b.f90 = f90;
  return b;
}
inline Bsdf thin(vec3 base, float alpha, float transmission = 1.0f) {
  Bsdf b = plastic(base, alpha);
  b.transmission = transmission;
  return b;
}
inline Bsdf glass(vec3 base, float alpha, float eta, float transmission = 1.0f) {
  Bsdf b = thin(base, alpha, transmission);
  b.solid = 1;
  b.inside = eta < 1.0f;
  b.eta = eta;
  const float r = (eta - 1.0f) / (eta + 1.0f);
  b.f0 = splat3(r * r);
  return b;
}
// The same surface and pair of directions from the other side.
inline Bsdf from_other_side(const Bsdf &b) {
  Bsdf other = b;
  other.inside = !b.inside;
  other.eta = 1.0f / b.eta;
  return other;
}
inline vec3 flip(vec3 v) { return make_vec3(v.x, v.y, -v.z); }

struct Material {
  std::string name;
  Bsdf bsdf;
};

// Some of everything: each lobe alone, mixtures, colours, extremes.
inline std::vector<Material> all_materials() {
  const vec3 white = splat3(1.0f), copper = make_vec3(0.95f, 0.64f, 0.54f), green = make_vec3(0.2f, 0.7f, 0.3f);
  Bsdf half_metal = metal(copper, 0.3f);
  half_metal.metallic = 0.5f;
  Bsdf tinted = plastic(green, 0.2f);
  tinted.f0 = make_vec3(0.08f, 0.04f, 0.02f);
  Bsdf soup = glass(green, 0.25f, 1.5f, 0.6f);
  soup.metallic = 0.3f;
  Bsdf thin_soup = thin(copper, 0.4f, 0.5f);
  thin_soup.metallic = 0.2f;
  Bsdf dull_glass = glass(white, 0.3f, 1.5f);
  dull_glass.f90 = 0.4f;
  return {{"lambert", lambert(0.7f)},
          {"white metal, rough", metal(white, 1.0f)},
          {"copper, alpha 0.3", metal(copper, 0.3f)},
          {"copper, alpha 0.05", metal(copper, 0.05f)},
          {"plastic, rough", plastic(green, 0.6f)},
          {"plastic, alpha 0.04", plastic(green, 0.04f)},
          {"plastic, smooth", plastic(green, 0.0f)},
          {"white plastic", plastic(white, 0.5f)},
          {"plastic without grazing reflection", plastic(white, 0.3f, 0.1f, 0.0f)},
          {"tinted highlight", tinted},
          {"half metal", half_metal},
          {"thin, alpha 0.3", thin(white, 0.3f)},
          {"thin, rough", thin(green, 0.9f)},
          {"thin, smooth, half diffuse", thin(copper, 0.0f, 0.5f)},
          {"thin mixture", thin_soup},
          {"glass, alpha 0.1", glass(white, 0.1f, 1.5f)},
          {"glass, rough", glass(white, 0.8f, 1.5f)},
          {"glass from inside, alpha 0.1", glass(white, 0.1f, 1.0f / 1.5f)},
          {"glass from inside, rough", glass(white, 0.8f, 1.0f / 1.5f)},
          {"water, alpha 0.3", glass(green, 0.3f, 1.33f)},
          {"diamond, alpha 0.2", glass(white, 0.2f, 2.42f)},
          {"nearly the same ior", glass(white, 0.3f, 1.02f)},
          {"glass of less reflection", dull_glass},
          {"glass, smooth, half diffuse", glass(green, 0.0f, 1.5f, 0.5f)},
          {"mixture of everything", soup}};
}

}  // namespace sunstone::test
