// SPDX-License-Identifier: Apache-2.0
// Reconstruction filters, drawn from by importance sampling [Ernst06]: each is a separable f(x) f(y), given to kernels as the inverse cdf of |f|.
#pragma once
#include <string>
#include <vector>

namespace sunstone {

struct Filter {
  enum class Kind { box, tent, gaussian, mitchell, blackman_harris } kind = Kind::blackman_harris;
  float radius = 1.5f;  // pixels: f is 0 beyond
};

// box (0.5), tent (1), gaussian (2; sigma a quarter of it), mitchell (2; B = C = 1/3), blackman-harris (1.5): the radius in brackets. UsageError for others.
Filter filter_from_name(const std::string &name);
std::string filter_name(const Filter &filter);

struct FilterTable {
  std::vector<float> inverse_cdf;  // SUN_FILTER_TABLE + 1 offsets in pixels, from -radius to radius
  float negative_from;             // |offset| beyond which f is negative; larger than the radius where it never is
  float weight;                    // (integral |f| / integral f)^2: what the magnitude of every sample is scaled by
};
FilterTable make_filter_table(const Filter &filter);

// f at x, not normalised. By the arithmetic of kernels/math.
float filter_value(const Filter &filter, float x);

}  // namespace sunstone
