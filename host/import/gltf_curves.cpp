// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_curves.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace sunstone::gltf {

namespace {

double dot(const glm::dvec4 &a, const glm::dvec4 &b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

double sine(double angle) {
  float s, c;
  kernel::sin_cos(static_cast<float>(angle), &s, &c);
  return static_cast<double>(s);
}

glm::dvec4 quaternion(const double *v) { return {v[0], v[1], v[2], v[3]}; }

std::vector<double> numbers(const glm::dvec4 &q) { return {q.x, q.y, q.z, q.w}; }

}  // namespace

glm::dvec4 unit_or_none(const glm::dvec4 &q) {
  const double length = std::sqrt(dot(q, q));
  return length > 1e-150 && std::isfinite(length) ? q / length : glm::dvec4(0, 0, 0, 1);
}

glm::dvec4 slerp(const glm::dvec4 &a, const glm::dvec4 &to, double u) {
  const glm::dvec4 b = dot(a, to) < 0 ? -to : to;  // q and -q are one rotation: the nearer
  // Half the angle between them from the sides of the rhombus, exact for small angles, too.
  const glm::dvec4 across = b - a, along = b + a;
  const double angle =
      2 * static_cast<double>(kernel::atan2_real(static_cast<float>(std::sqrt(dot(across, across))), static_cast<float>(std::sqrt(dot(along, along)))));
  constexpr double straight = 1e-3;  // below it arc and chord differ by less than floats do
  if (angle < straight) return unit_or_none(a + across * u);
  const double whole = sine(angle);
  return unit_or_none(a * (sine((1 - u) * angle) / whole) + b * (sine(u * angle) / whole));
}

std::vector<double> value_at(const Curve &curve, double time) {
  const std::size_t n = curve.components, keys = curve.times.size();
  const bool cubic = curve.way == Curve::Way::cubic;
  const std::size_t per_key = cubic ? 3 * n : n;
  const auto key_value = [&](std::size_t key) { return &curve.values[key * per_key + (cubic ? n : 0)]; };
  const auto at_key = [&](std::size_t key) {
    const double *const v = key_value(key);
    return curve.rotation ? numbers(unit_or_none(quaternion(v))) : std::vector<double>(v, v + n);
  };
  const std::size_t after = static_cast<std::size_t>(std::upper_bound(curve.times.begin(), curve.times.end(), time) - curve.times.begin());
  if (after == 0) return at_key(0);
  const std::size_t before = after - 1;
  if (after == keys || curve.way == Curve::Way::step || time == curve.times[before]) return at_key(before);
  const double span = curve.times[after] - curve.times[before], u = (time - curve.times[before]) / span;
  const double *const a = key_value(before), *const b = key_value(after);
  if (curve.way == Curve::Way::linear && curve.rotation) return numbers(slerp(quaternion(at_key(before).data()), quaternion(at_key(after).data()), u));
  std::vector<double> out(n);
  if (curve.way == Curve::Way::linear) {
    for (std::size_t i = 0; i < n; i++) out[i] = a[i] + (b[i] - a[i]) * u;
    return out;
  }
  // Hermite's: values and tangents at both ends, the tangents per second.
  const double u2 = u * u, u3 = u2 * u, to_b = 3 * u2 - 2 * u3;
  const double *const leaving = a + n, *const arriving = b - n;
  for (std::size_t i = 0; i < n; i++) out[i] = (1 - to_b) * a[i] + span * (u3 - 2 * u2 + u) * leaving[i] + to_b * b[i] + span * (u3 - u2) * arriving[i];
  return curve.rotation ? numbers(unit_or_none(quaternion(out.data()))) : out;
}

}  // namespace sunstone::gltf
