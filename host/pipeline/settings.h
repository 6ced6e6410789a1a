// SPDX-License-Identifier: Apache-2.0
// What is to be rendered (decides the bits) and how (never does).
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flatten/flatten.h"
#include "pipeline/filter.h"

namespace sunstone {

// Layers of the first hit that can be asked for, beside the beauty.
struct LayerChoice {
  bool bounces = false, albedo = false, normal = false, depth = false, position = false, object = false, material = false, alpha = false;
};

// How a path's directions are drawn: as the bsdf asks, or without a look at it.
enum class Sampling { bsdf, cosine, uniform };
const char *sampling_name(Sampling sampling);
Sampling sampling_from_name(const std::string &name);  // UsageError with the names there are

struct RenderSettings {
  int width = 1280, height = 720;
  int x0 = 0, y0 = 0, x1 = 1280, y1 = 720;  // crop window, half-open
  std::string integrator = "path";
  unsigned max_depth = 16, roulette_depth = 4;
  std::uint32_t seed = 0;
  std::optional<double> time;  // seconds into the animation, as the scene was imported
  double shutter = 0;          // seconds that it is open from then on
  bool independent = false;  // sampler: plain hashes instead of Sobol'
  Filter filter;
  bool transparent_background = false;
  // Of single integrators: Plan::takes.
  bool end_on_light = false;
  Sampling sampling = Sampling::bsdf;
  unsigned light_samples = 1;  // shadow rays a vertex
  unsigned indirect_samples = 1;  // rays that leave a vertex
  bool nee_first = false;      // shadow rays from the camera ray's hit alone
  float absorption = -1;       // chance to end at each scattering; negative: by the throughput
  bool double_count = false;   // wrong on purpose
  bool balance = false;        // bidirectional weights: the balance heuristic; else the power heuristic
  unsigned strategy_s = 0, strategy_t = 0;  // vertices from the light's side and from the eye's: this strategy alone; 0, 0: all
  bool unweighted = false;     // it, as if there were no other
  std::array<float, 3> ambient{};  // radiance that matt surfaces scatter wherever they are
  float cutoff = 1.0f / 512;       // rays worth less are not followed
  std::uint32_t photons = 0;       // light paths of an iteration, or of the whole render; 0: see default_photons
  float radius = 0, caustic_radius = 0;  // metres within which photons count, at first; 0: by the scene, see default_radius
  float alpha = 2.0f / 3;          // share of the photons that an iteration adds within a shrinking radius
  LayerChoice layers;
};

struct Tuning {
  unsigned pool = 0;   // slots; 0: chosen by the device
  unsigned lanes = 0;  // 1, 8 or 16; 0: chosen by the device
};

}  // namespace sunstone
