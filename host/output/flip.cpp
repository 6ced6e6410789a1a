// SPDX-License-Identifier: Apache-2.0
// LDR-FLIP [Andersson20]. Colours are blurred as the eye blurs them (contrast sensitivity), compared in a uniform space where large distances count
// too, and the difference is raised where edges or points differ. All filters separate into rows and columns; pictures end in a repeated border.
#include "output/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sunstone {

namespace {

using Color = std::array<double, 3>;
using Plane = std::vector<float>;

// Linear Rec. 709 to XYZ, and the white that (1, 1, 1) gives. [IEC61966]
constexpr double xyz_of_rgb[3][3] = {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
constexpr double rgb_of_xyz[3][3] = {{3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};

Color multiply(const double (&m)[3][3], const Color &v) {
  Color result;
  for (int i = 0; i < 3; i++) result[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return result;
}

const Color &white() {
  static const Color xyz = multiply(xyz_of_rgb, {1, 1, 1});
  return xyz;
}

// The opponent space YCxCz, linear in light, where the eye's contrast sensitivity is known. [Andersson20 sec. 4.1.1]
Color opponent_of_rgb(const Color &rgb) {
  const Color xyz = multiply(xyz_of_rgb, rgb);
  const double x = xyz[0] / white()[0], y = xyz[1] / white()[1], z = xyz[2] / white()[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Color rgb_of_opponent(const Color &opponent) {
  const double y = (opponent[0] + 16) / 116;
  return multiply(rgb_of_xyz, {(y + opponent[1] / 500) * white()[0], y * white()[1], (y - opponent[2] / 200) * white()[2]});
}

// CIELAB, with chroma scaled by lightness after Hunt: colours are weaker in the dark. [Andersson20 sec. 4.1.2]
Color hunt_lab_of_rgb(const Color &rgb) {
  const auto f = [](double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const Color xyz = multiply(xyz_of_rgb, rgb);
  const double fx = f(xyz[0] / white()[0]), fy = f(xyz[1] / white()[1]), fz = f(xyz[2] / white()[2]);
  const double lightness = 116 * fy - 16;
  return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

// City-block in lightness, Euclidean in chroma: holds for large distances as well. [Andersson20 sec. 4.1.2]
double hyab(const Color &a, const Color &b) { return std::fabs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

// A filter of odd length about its middle.
struct Taps {
  std::vector<double> weights;
  int radius() const { return static_cast<int>(weights.size()) / 2; }
};

template <class Function> Taps taps(int radius, Function f) {
  Taps result;
  for (int i = -radius; i <= radius; i++) result.weights.push_back(f(static_cast<double>(i)));
  return result;
}

double sum(const Taps &t) {
  double total = 0;
  for (const double w : t.weights) total += w;
  return total;
}

// Rows with `along`, then columns with `down`, times `scale`.
class Filter {
 public:
  Filter(int width, int height) : width_(width), height_(height), rows_(size()) {}
  std::size_t size() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }

  void apply(const Plane &in, const Taps &along, const Taps &down, double scale, Plane &out) {
    const int radius = along.radius();
    std::vector<float> padded(static_cast<std::size_t>(width_ + 2 * radius));
    for (int y = 0; y < height_; y++) {
      const float *row = &in[at(0, y)];
      for (int x = -radius; x < width_ + radius; x++) padded[static_cast<std::size_t>(x + radius)] = row[std::clamp(x, 0, width_ - 1)];
      float *result = &rows_[at(0, y)];
      std::fill_n(result, width_, 0.0f);
      for (int k = 0; k <= 2 * radius; k++) {
        const float weight = static_cast<float>(along.weights[static_cast<std::size_t>(k)] * scale);
        for (int x = 0; x < width_; x++) result[x] += weight * padded[static_cast<std::size_t>(x + k)];
      }
    }
    out.assign(size(), 0.0f);
    for (int y = 0; y < height_; y++) {
      float *result = &out[at(0, y)];
      for (int k = -down.radius(); k <= down.radius(); k++) {
        const float weight = static_cast<float>(down.weights[static_cast<std::size_t>(k + down.radius())]);
        const float *row = &rows_[at(0, std::clamp(y + k, 0, height_ - 1))];
        for (int x = 0; x < width_; x++) result[x] += weight * row[x];
      }
    }
  }

 private:
  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x); }
  int width_, height_;
  Plane rows_;
};

using Planes = std::array<Plane, 3>;

// The eye's point spread of each opponent channel: sums of Gaussians a exp(-b f^2) over frequencies, hence a sqrt(pi / b) exp(-pi^2 d^2 / b) over
// degrees. [Andersson20 table 1]
struct Gaussian {
  double a, b;
};
constexpr std::array<Gaussian, 2> sensitivity[3] = {{{{1, 0.0047}, {0, 0.00001}}}, {{{1, 0.0053}, {0, 0.00001}}}, {{{34.1, 0.04}, {13.5, 0.025}}}};

void blur_as_the_eye(Planes &opponent, Filter &filter, double pixels_per_degree) {
  constexpr double pi = std::numbers::pi, widest = 0.04;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
  Plane part;
  for (std::size_t channel = 0; channel < 3; channel++) {
    double total = 0;
    std::array<Taps, 2> gaussians;
    std::array<double, 2> scales{};
    for (std::size_t i = 0; i < 2; i++) {
      const auto [a, b] = sensitivity[channel][i];
      gaussians[i] = taps(radius, [&, b = b](double x) { return std::exp(-pi * pi * x * x / (pixels_per_degree * pixels_per_degree * b)); });
      scales[i] = a * std::sqrt(pi / b);
      total += scales[i] * sum(gaussians[i]) * sum(gaussians[i]);
    }
    Plane blurred(filter.size(), 0.0f);
    for (std::size_t i = 0; i < 2; i++) {
      if (scales[i] == 0) continue;
      filter.apply(opponent[channel], gaussians[i], gaussians[i], scales[i] / total, part);
      for (std::size_t p = 0; p < part.size(); p++) blurred[p] += part[p];
    }
    opponent[channel].swap(blurred);
  }
}

// Derivatives of a Gaussian as wide as the features that the eye finds best: the first answers to edges, the second to points. Weights above 0 add up
// to 1 and those below to -1, over rows and columns together. [Andersson20 sec. 4.2]
struct FeatureTaps {
  Taps smooth, edge, point;
};

FeatureTaps feature_taps(double pixels_per_degree) {
  const double deviation = 0.5 * 0.082 * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
  const auto normalised = [](Taps t) {
    double above = 0, below = 0;
    for (const double w : t.weights) (w > 0 ? above : below) += w;
    for (double &w : t.weights) w /= w > 0 ? above : -below;
    return t;
  };
  FeatureTaps result{taps(radius, gaussian), normalised(taps(radius, [&](double x) { return -x * gaussian(x); })),
                     normalised(taps(radius, [&](double x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); }))};
  const double total = sum(result.smooth);
  for (double &w : result.smooth.weights) w /= total;
  return result;
}

struct Features {
  Plane edges, points;  // magnitudes
};

Features features_of(const Plane &luminance, Filter &filter, const FeatureTaps &t) {
  const auto magnitude = [&](const Taps &derivative) {
    Plane along, down;
    filter.apply(luminance, derivative, t.smooth, 1, along);
    filter.apply(luminance, t.smooth, derivative, 1, down);
    for (std::size_t i = 0; i < along.size(); i++) along[i] = std::hypot(along[i], down[i]);
    return along;
  };
  return {magnitude(t.edge), magnitude(t.point)};
}

struct Seen {
  Planes colors;  // blurred, opponent
  Features features;
};

Seen see(std::span<const float> rgb, Filter &filter, double pixels_per_degree) {
  Seen seen;
  for (Plane &plane : seen.colors) plane.resize(filter.size());
  Plane luminance(filter.size());
  for (std::size_t i = 0; i < filter.size(); i++) {
    Color color;
    for (std::size_t c = 0; c < 3; c++) color[c] = std::clamp(static_cast<double>(rgb[i * 3 + c]), 0.0, 1.0);
    const Color opponent = opponent_of_rgb(color);
    for (std::size_t c = 0; c < 3; c++) seen.colors[c][i] = static_cast<float>(opponent[c]);
    luminance[i] = static_cast<float>((opponent[0] + 16) / 116);
  }
  seen.features = features_of(luminance, filter, feature_taps(pixels_per_degree));
  blur_as_the_eye(seen.colors, filter, pixels_per_degree);
  return seen;
}

Color seen_color(const Planes &opponent, std::size_t pixel) {
  Color rgb = rgb_of_opponent({opponent[0][pixel], opponent[1][pixel], opponent[2][pixel]});
  for (double &value : rgb) value = std::clamp(value, 0.0, 1.0);
  return hunt_lab_of_rgb(rgb);
}

}  // namespace

std::vector<float> flip_errors(std::span<const float> test, std::span<const float> reference, int width, int height, double pixels_per_degree) {
  Filter filter(width, height);
  const Seen a = see(test, filter, pixels_per_degree), b = see(reference, filter, pixels_per_degree);

  constexpr double color_power = 0.7, knee = 0.4, knee_value = 0.95, feature_power = 0.5;
  const double largest = std::pow(hyab(hunt_lab_of_rgb({0, 1, 0}), hunt_lab_of_rgb({0, 0, 1})), color_power);
  std::vector<float> errors(filter.size());
  for (std::size_t i = 0; i < errors.size(); i++) {
    // Most of 0..1 goes to small differences, the large ones share what is left. [Andersson20 eq. 4]
    const double distance = std::pow(hyab(seen_color(a.colors, i), seen_color(b.colors, i)), color_power);
    const double color = distance < knee * largest ? knee_value * distance / (knee * largest)
                                                   : knee_value + (distance - knee * largest) / (largest - knee * largest) * (1 - knee_value);
    const double edge = std::fabs(a.features.edges[i] - b.features.edges[i]), point = std::fabs(a.features.points[i] - b.features.points[i]);
    const double feature = std::min(std::pow(std::max(edge, point) / std::numbers::sqrt2, feature_power), 1.0);
    errors[i] = static_cast<float>(std::pow(std::clamp(color, 0.0, 1.0), 1 - feature));
  }
  return errors;
}

}  // namespace sunstone
