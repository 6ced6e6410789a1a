// SPDX-License-Identifier: Apache-2.0
// A quantity over time: key frames, and the way from one to the next (glTF 2.0, appendix C). Any time may be asked for, one or many, so that what
// moves while a shutter is open needs nothing else. Only + - * / sqrt and kernels/math: poses have the same bits everywhere.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace sunstone::gltf {

struct Curve {
  enum class Way { step, linear, cubic } way = Way::linear;
  bool rotation = false;       // unit quaternions x, y, z, w: the linear way is the shortest arc
  std::size_t components = 1;  // of one value
  std::vector<double> times;   // seconds, ascending, at least one
  std::vector<double> values;  // `components` a key; cubic: in-tangent, value, out-tangent a key
};

// The value of `curve` at `time`; before the first key that of the first, after the last that of the last. Rotations are unit.
std::vector<double> value_at(const Curve &curve, double time);

// From unit quaternion a (u = 0) to b (u = 1) along the shortest arc, at even speed [Shoemake85].
glm::dvec4 slerp(const glm::dvec4 &a, const glm::dvec4 &b, double u);

// q / |q|; no rotation where it has no direction.
glm::dvec4 unit_or_none(const glm::dvec4 &q);

}  // namespace sunstone::gltf
