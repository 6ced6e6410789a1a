// SPDX-License-Identifier: Apache-2.0
#include "support/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sunstone::test {

namespace {

// The continued fraction of the incomplete beta function [DLMF 8.17.22], evaluated from the front by Lentz's method. Converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  const auto kept = [](double v) { return std::abs(v) < tiny ? tiny : v; };
  double c = 1, d = 1 / kept(1 - (a + b) * x / (a + 1)), value = d;
  for (int m = 1; m < 10000; m++) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / kept(1 + even * d);
    c = kept(1 + even / c);
    value *= c * d;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / kept(1 + odd * d);
    c = kept(1 + odd / c);
    value *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return value;
}

}  // namespace

double incomplete_beta(double a, double b, double x) {
  if (!(x > 0)) return 0;
  if (!(x < 1)) return 1;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * beta_fraction(a, b, x) / a;
  return 1 - front * beta_fraction(b, a, 1 - x) / b;
}

double student_two_sided(double t, double freedom) {
  if (std::isnan(t)) return 0;
  if (std::isinf(t)) return 0;
  return incomplete_beta(freedom / 2, 0.5, freedom / (freedom + t * t));
}

double student_quantile(double p, double freedom) {
  double low = 0, high = 1;
  while (student_two_sided(high, freedom) > p && high < 1e12) high *= 2;
  for (int i = 0; i < 200; i++) {
    const double middle = 0.5 * (low + high);
    (student_two_sided(middle, freedom) > p ? low : high) = middle;
  }
  return high;
}

Moments moments(std::span<const double> values) {
  Moments m;
  m.count = values.size();
  m.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(m.count);
  for (const double v : values) m.variance += (v - m.mean) * (v - m.mean);
  m.variance = m.count > 1 ? m.variance / static_cast<double>(m.count - 1) : std::numeric_limits<double>::infinity();
  return m;
}

double welch(std::span<const double> a, std::span<const double> b) {
  const Moments ma = moments(a), mb = moments(b);
  const double va = ma.variance / static_cast<double>(ma.count), vb = mb.variance / static_cast<double>(mb.count), difference = ma.mean - mb.mean;
  // What rounding to floats and to the film's quantum may do to values that are no random numbers at all.
  const double largest = std::max(std::abs(ma.mean), std::abs(mb.mean));
  if (std::abs(difference) <= 1e-6 * largest + 1e-9) return 1;
  if (!(va + vb > 1e-24 * largest * largest)) return 0;
  const double freedom =
      (va + vb) * (va + vb) / (va * va / static_cast<double>(ma.count - 1) + vb * vb / static_cast<double>(mb.count - 1));
  return student_two_sided(difference / std::sqrt(va + vb), freedom);
}

std::vector<std::size_t> holm_rejected(std::span<const double> p, double alpha) {
  std::vector<std::size_t> order(p.size()), rejected;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  for (std::size_t i = 0; i < order.size(); i++) {
    if (!(p[order[i]] <= alpha / static_cast<double>(p.size() - i))) break;
    rejected.push_back(order[i]);
  }
  return rejected;
}

double interval(const Moments &m, double alpha) {
  return student_quantile(alpha, static_cast<double>(m.count - 1)) * std::sqrt(m.variance / static_cast<double>(m.count));
}

}  // namespace sunstone::test
