// SPDX-License-Identifier: Apache-2.0
#include "pipeline/filter.h"

#include <algorithm>

#include "base/error.h"
#include "math/elementary.h"
#include "shared/frame.h"

namespace sunstone {

namespace {

struct Named {
  const char *name;
  Filter filter;
};
const Named filters[] = {{"box", {Filter::Kind::box, 0.5f}},
                         {"tent", {Filter::Kind::tent, 1.0f}},
                         {"gaussian", {Filter::Kind::gaussian, 2.0f}},
                         {"mitchell", {Filter::Kind::mitchell, 2.0f}},
                         {"blackman-harris", {Filter::Kind::blackman_harris, 1.5f}}};

// [Mitchell88] with B = C = 1/3, its support of 2 scaled to the radius.
float mitchell(float x) {
  const float b = 1.0f / 3.0f, c = 1.0f / 3.0f;
  if (x < 1.0f) return ((12.0f - 9.0f * b - 6.0f * c) * x * x * x + (-18.0f + 12.0f * b + 6.0f * c) * x * x + (6.0f - 2.0f * b)) / 6.0f;
  return ((-b - 6.0f * c) * x * x * x + (6.0f * b + 30.0f * c) * x * x + (-12.0f * b - 48.0f * c) * x + (8.0f * b + 24.0f * c)) / 6.0f;
}

float cosine(float x) {
  float s, c;
  kernel::sin_cos(x, &s, &c);
  return c;
}

}  // namespace

Filter filter_from_name(const std::string &name) {
  std::string known;
  for (const Named &f : filters) {
    if (name == f.name) return f.filter;
    known += std::string(known.empty() ? "" : ", ") + f.name;
  }
  throw UsageError("--filter " + printable(name), "no such filter; there are " + known);
}

std::string filter_name(const Filter &filter) {
  for (const Named &f : filters)
    if (f.filter.kind == filter.kind) return f.name;
  return "unknown";
}

float filter_value(const Filter &filter, float x) {
  const float r = filter.radius, d = x < 0.0f ? -x : x;
  if (d >= r) return 0.0f;
  switch (filter.kind) {
    case Filter::Kind::box: return 1.0f;
    case Filter::Kind::tent: return 1.0f - d / r;
    case Filter::Kind::gaussian: {
      const float sigma = r / 4.0f;
      return kernel::exp_real(-0.5f * d * d / (sigma * sigma)) - kernel::exp_real(-0.5f * r * r / (sigma * sigma));
    }
    case Filter::Kind::mitchell: return mitchell(d / r * 2.0f);
    case Filter::Kind::blackman_harris: {
      // The four-term minimum window [Harris78] over the support.
      const float t = (d / r + 1.0f) * SUN_PI;
      return 0.35875f - 0.48829f * cosine(t) + 0.14128f * cosine(2.0f * t) - 0.01168f * cosine(3.0f * t);
    }
  }
  return 0.0f;
}

FilterTable make_filter_table(const Filter &filter) {
  constexpr int fine = 16 * SUN_FILTER_TABLE;
  const double r = static_cast<double>(filter.radius), step = 2.0 * r / fine;
  FilterTable table;
  table.negative_from = 2.0f * filter.radius + 1.0f;
  std::vector<double> cdf(fine + 1, 0.0);
  double signed_sum = 0.0;
  for (int i = 0; i < fine; i++) {
    const float x = static_cast<float>(-r + (i + 0.5) * step), f = filter_value(filter, x);
    if (f < 0.0f && x > 0.0f) table.negative_from = std::min(table.negative_from, x);
    signed_sum += static_cast<double>(f);
    cdf[static_cast<std::size_t>(i) + 1] = cdf[static_cast<std::size_t>(i)] + static_cast<double>(f < 0.0f ? -f : f);
  }
  const double total = cdf.back(), ratio = total / signed_sum;
  table.weight = static_cast<float>(ratio * ratio);
  int cell = 0;
  for (int i = 0; i <= SUN_FILTER_TABLE; i++) {
    const double target = total * i / SUN_FILTER_TABLE;
    while (cell < fine - 1 && cdf[static_cast<std::size_t>(cell) + 1] < target) cell++;
    const double lower = cdf[static_cast<std::size_t>(cell)], width = cdf[static_cast<std::size_t>(cell) + 1] - lower;
    const double within = width > 0.0 ? std::clamp((target - lower) / width, 0.0, 1.0) : 0.0;
    table.inverse_cdf.push_back(static_cast<float>(-r + (cell + within) * step));
  }
  return table;
}

}  // namespace sunstone
