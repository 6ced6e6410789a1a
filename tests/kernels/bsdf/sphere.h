// SPDX-License-Identifier: Apache-2.0
// Integrals and histograms over the sphere of directions, on a square: t in [-1, 1] with z = t |t|, which spreads grazing light, and the azimuth.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "math/vector.h"

namespace sunstone::test {

using kernel::vec3;

struct Cell {
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
  std::array<Cell, 4> quarters() const {
    const double u = 0.5 * (u0 + u1), v = 0.5 * (v0 + v1);
    return {Cell{u0, u, v0, v}, Cell{u, u1, v0, v}, Cell{u0, u, v, v1}, Cell{u, u1, v, v1}};
  }
};

inline std::array<double, 2> square_of(vec3 direction) {
  const double z = std::clamp(double(direction.z), -1.0, 1.0);
  double v = std::atan2(double(direction.y), double(direction.x)) / (2 * M_PI);
  if (v < 0) v += 1;
  return {0.5 * (1 + std::copysign(std::sqrt(std::fabs(z)), z)), std::min(v, 1.0)};
}
inline vec3 direction_of(double u, double v) {
  const double t = 2 * u - 1, z = t * std::fabs(t), r = std::sqrt(std::max(0.0, 1 - z * z)), phi = 2 * M_PI * v;
  return kernel::make_vec3(float(r * std::cos(phi)), float(r * std::sin(phi)), float(z));
}

// Integral over solid angle, by 3 x 3 Gauss points on cells that are split until both answers agree.
class SphereIntegral {
 public:
  using Function = std::function<double(vec3)>;
  SphereIntegral(Function f, double tolerance) : f_(std::move(f)), tolerance_(tolerance) {}
  double over(const Cell &cell) const { return refine(cell, gauss(cell), 0); }

 private:
  double gauss(const Cell &c) const {
    constexpr double node = 0.7745966692414834, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        const double u = c.u0 + (c.u1 - c.u0) * 0.5 * (1 + node * (i - 1)), v = c.v0 + (c.v1 - c.v0) * 0.5 * (1 + node * (j - 1));
        sum += weight[i] * weight[j] * f_(direction_of(u, v)) * 8 * M_PI * std::fabs(2 * u - 1);  // dz dphi = 2 |t| 2 du 2 pi dv
      }
    return sum * (c.u1 - c.u0) * (c.v1 - c.v0);
  }
  double refine(const Cell &cell, double whole, int depth) const {
    const auto quarters = cell.quarters();
    std::array<double, 4> parts;
    double sum = 0;
    for (int i = 0; i < 4; i++) sum += parts[std::size_t(i)] = gauss(quarters[std::size_t(i)]);
    if (depth >= 2 && (depth >= 11 || std::fabs(sum - whole) < tolerance_)) return sum;
    sum = 0;
    for (int i = 0; i < 4; i++) sum += refine(quarters[std::size_t(i)], parts[std::size_t(i)], depth + 1);
    return sum;
  }
  Function f_;
  double tolerance_;
};

// A histogram whose cells are split where pilot samples are dense.
class SphereHistogram {
 public:
  SphereHistogram(const std::vector<std::array<double, 2>> &pilot, std::size_t most) { split(Cell{}, pilot, most, 0); }
  const std::vector<Cell> &cells() const { return cells_; }
  std::size_t find(const std::array<double, 2> &at) const {
    std::size_t node = 0;
    Cell cell;
    while (nodes_[node].leaf < 0) {
      const double u = 0.5 * (cell.u0 + cell.u1), v = 0.5 * (cell.v0 + cell.v1);
      const std::size_t quarter = std::size_t(at[0] >= u) + 2 * std::size_t(at[1] >= v);
      cell = cell.quarters()[quarter];
      node = nodes_[node].children[quarter];
    }
    return std::size_t(nodes_[node].leaf);
  }

 private:
  struct Node {
    std::array<std::size_t, 4> children{};
    long leaf = -1;
  };
  std::size_t split(const Cell &cell, const std::vector<std::array<double, 2>> &points, std::size_t most, int depth) {
    const std::size_t number = nodes_.size();
    nodes_.emplace_back();
    if (depth >= 2 && (points.size() <= most || depth >= 12)) {
      nodes_[number].leaf = long(cells_.size());
      cells_.push_back(cell);
      return number;
    }
    const double u = 0.5 * (cell.u0 + cell.u1), v = 0.5 * (cell.v0 + cell.v1);
    std::array<std::vector<std::array<double, 2>>, 4> parts;
    for (const auto &p : points) parts[std::size_t(p[0] >= u) + 2 * std::size_t(p[1] >= v)].push_back(p);
    const auto quarters = cell.quarters();
    for (std::size_t i = 0; i < 4; i++) {
      const std::size_t child = split(quarters[i], parts[i], most, depth + 1);
      nodes_[number].children[i] = child;
    }
    return number;
  }
  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
};

// Q(a, x), the upper regularised incomplete gamma function: by its series, or Lentz's continued fraction.
inline double gamma_upper(double a, double x) {
  if (x <= 0) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; std::fabs(term) > 1e-16 * std::fabs(sum); n++) sum += term *= x / n;
    return std::max(0.0, 1 - front * sum);
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 100000; i++) {
    const double an = -i * (i - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= c * d;
    if (std::fabs(c * d - 1) < 1e-15) break;
  }
  return front * h;
}
// Chance that chi-square of so many degrees of freedom exceeds x.
inline double chi2_tail(double x, double degrees) { return gamma_upper(0.5 * degrees, 0.5 * x); }

}  // namespace sunstone::test
