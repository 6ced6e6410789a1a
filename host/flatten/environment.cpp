// SPDX-License-Identifier: Apache-2.0
#include "flatten/environment.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "base/error.h"
#include "math/elementary.h"
#include "math/vector.h"

namespace sunstone {
namespace {

using kernel::uint;

constexpr float brightest = 1e30f;  // sums over a map stay finite

// Sines at the rows' middles.
std::vector<double> row_sines(uint height) {
  std::vector<double> sines(height);
  for (uint y = 0; y < height; y++) {
    float sine, cosine;
    kernel::sin_cos((static_cast<float>(y) + 0.5f) / static_cast<float>(height) * SUN_PI, &sine, &cosine);
    sines[y] = sine;
  }
  return sines;
}

// Mean luminance of the bilinear interpolation over each cell: per axis 1/8, 6/8, 1/8 of the texel before, its own and the next.
std::vector<float> cell_means(std::span<const float> texels, uint width, uint height) {
  std::vector<float> means(std::size_t(width) * height);
  tbb::parallel_for(uint(0), height, [&](uint y) {
    const std::size_t rows[3] = {y ? y - 1 : 0, y, y + 1 < height ? y + 1 : y};
    const auto column = [&](std::size_t x) {
      float luminance[3];
      for (std::size_t r = 0; r < 3; r++) {
        const float *t = &texels[3 * (rows[r] * width + x)];
        luminance[r] = kernel::luminance(kernel::make_vec3(t[0], t[1], t[2]));
      }
      return 0.125f * luminance[0] + 0.75f * luminance[1] + 0.125f * luminance[2];
    };
    for (std::size_t x = 0; x < width; x++)
      means[y * std::size_t(width) + x] = 0.125f * column(x ? x - 1 : width - 1) + 0.75f * column(x) + 0.125f * column(x + 1 < width ? x + 1 : 0);
  });
  return means;
}

// (n + 1) rising multiples of 2^-24 from 0 to 1; even steps where all weights are 0.
void write_cdf(std::span<const double> weights, float *cdf) {
  double total = 0, sum = 0;
  for (double weight : weights) total += weight;
  cdf[0] = 0;
  for (std::size_t i = 0; i < weights.size(); i++) {
    sum += weights[i];
    const double part = total > 0 ? sum / total : static_cast<double>(i + 1) / static_cast<double>(weights.size());
    cdf[i + 1] = static_cast<float>(std::floor(part * 0x1p24 + 0.5) * 0x1p-24);
  }
  cdf[weights.size()] = 1;
}

double sphere_integral(std::span<const float> means, std::span<const double> sines, uint width) {
  double sum = 0;
  for (std::size_t y = 0; y < sines.size(); y++) {
    double row = 0;
    for (std::size_t x = 0; x < width; x++) row += means[y * width + x];
    sum += row * sines[y];
  }
  return sum * (2 * 3.141592653589793 * 3.141592653589793) / (static_cast<double>(width) * static_cast<double>(sines.size()));
}

// RGB texels with the strength multiplied in; bytes are sRGB.
std::vector<float> radiance_of(const Image &map, float strength, std::span<const float> srgb, std::size_t &bad) {
  const std::size_t texels = static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height),
                    channels = static_cast<std::size_t>(map.channels);
  std::vector<float> out(3 * texels);
  for (std::size_t i = 0; i < texels; i++)
    for (std::size_t c = 0; c < 3; c++) {
      const std::size_t from = i * channels + (channels < 3 ? 0 : c);
      const float value = (map.is_float() ? std::get<1>(map.pixels)[from] : srgb[std::get<0>(map.pixels)[from]]) * strength;
      const bool good = value >= 0 && value <= brightest;
      if (!good) bad++;
      out[3 * i + c] = good ? value : value > 0 ? brightest : 0.0f;
    }
  return out;
}

}  // namespace

std::vector<float> environment_distribution(std::span<const float> texels, uint width, uint height) {
  const std::vector<float> means = cell_means(texels, width, height);
  const std::vector<double> sines = row_sines(height);
  double sine_sum = 0;
  for (double sine : sines) sine_sum += sine;
  const double mean = sphere_integral(means, sines, width) / (2 * 3.141592653589793 * 3.141592653589793) * static_cast<double>(height) / sine_sum;
  if (!(mean > 0)) return {};

  const std::size_t w = width, h = height;
  std::vector<float> cdf(h + 1 + h * (w + 1));
  std::vector<double> row_weights(h);
  const auto fill = [&](double less) {
    tbb::parallel_for(std::size_t(0), h, [&](std::size_t y) {
      std::vector<double> weights(w);
      double sum = 0;
      for (std::size_t x = 0; x < w; x++) {
        weights[x] = std::max(static_cast<double>(means[y * w + x]) - less, 0.0);
        sum += weights[x];
      }
      row_weights[y] = sum * sines[y];
      write_cdf(weights, &cdf[h + 1 + y * (w + 1)]);
    });
    double total = 0;
    for (double weight : row_weights) total += weight;
    return total;
  };
  // A map that is even but for rounding has next to nothing above its mean.
  if (!(fill(mean) > 1e-4 * mean * static_cast<double>(w) * sine_sum)) fill(0);
  write_cdf(row_weights, cdf.data());
  return cdf;
}

double flatten_environment(const Scene &scene, std::size_t max_bytes, FlatScene &flat, Notices &notices) {
  const Environment &environment = scene.environment;
  kernel::Environment &out = flat.environment;
  out = {};
  out.emitter = SUN_NONE;
  out.rotation = environment.rotation - std::floor(environment.rotation);
  if (environment.kind == Environment::Kind::constant) {
    for (int c = 0; c < 3; c++) out.radiance[c] = std::min(std::max(environment.constant[c] * environment.strength, 0.0f), brightest);
    const float luminance = kernel::luminance(kernel::make_vec3(out.radiance[0], out.radiance[1], out.radiance[2]));
    if (luminance > 0) out.kind = SUN_ENVIRONMENT_CONSTANT;
    return luminance * (4 * 3.141592653589793);
  }
  if (environment.kind != Environment::Kind::map || !environment.map) return 0;
  const Image &map = *environment.map;
  const auto width = static_cast<std::size_t>(map.width), height = static_cast<std::size_t>(map.height);
  if (width * height > max_bytes / (3 * sizeof(float)))
    throw Error{printable(map.name), "the environment map does not fit into one buffer of " + std::to_string(max_bytes >> 20) + " MiB",
                "use a smaller map"};
  std::size_t bad = 0;
  flat.environment_texels = radiance_of(map, environment.strength, std::span(flat.tables).subspan(SUN_TABLE_SRGB, 256), bad);
  if (bad) notices.warning(printable(map.name), std::to_string(bad) + " values are negative, not finite or beyond 1e30; they were clamped");
  out.kind = SUN_ENVIRONMENT_MAP;
  out.width = static_cast<uint>(width);
  out.height = static_cast<uint>(height);
  flat.environment_cdf = environment_distribution(flat.environment_texels, out.width, out.height);
  return sphere_integral(cell_means(flat.environment_texels, out.width, out.height), row_sines(out.height), out.width);
}

}  // namespace sunstone
