// SPDX-License-Identifier: Apache-2.0
#include "flatten/placement.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace sunstone {

Placement placement_of(const glm::mat4x3 &transform) {
  Placement p;
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++) p.m[4 * row + column] = transform[column][row];
  const auto at = [&](int row, int column) { return static_cast<double>(p.m[4 * (row % 3) + column % 3]); };
  double cofactor[9];
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) cofactor[3 * r + c] = at(r + 1, c + 1) * at(r + 2, c + 2) - at(r + 1, c + 2) * at(r + 2, c + 1);
  p.determinant = at(0, 0) * cofactor[0] + at(0, 1) * cofactor[1] + at(0, 2) * cofactor[2];
  for (int i = 0; i < 9; i++) p.normal[i] = p.determinant < 0 ? -cofactor[i] : cofactor[i];
  return p;
}

glm::vec3 transform_point(const float *m, float x, float y, float z) {
  const auto row = [&](const float *r) { return ((r[0] * x + r[1] * y) + r[2] * z) + r[3]; };
  return {row(m), row(m + 4), row(m + 8)};
}

glm::vec3 transform_point(const kernel::Instance &instance, const float *position) {
  if (instance.flags & SUN_INSTANCE_IDENTITY) return {position[0], position[1], position[2]};
  return transform_point(instance.to_world, position[0], position[1], position[2]);
}

static void invert(const Placement &p, float *inverse) {
  const double scale = 1.0 / std::fabs(p.determinant);
  double linear[9];  // the inverse is the transposed inverse transpose
  for (int r = 0; r < 3; r++)
    for (int c = 0; c < 3; c++) linear[3 * r + c] = p.normal[3 * c + r] * scale;
  for (int r = 0; r < 3; r++) {
    const double offset = (linear[3 * r] * p.m[3] + linear[3 * r + 1] * p.m[7]) + linear[3 * r + 2] * p.m[11];
    for (int c = 0; c < 3; c++) inverse[4 * r + c] = static_cast<float>(linear[3 * r + c]);
    inverse[4 * r + 3] = static_cast<float>(-offset);
  }
}

kernel::Instance instance_at(const Placement &p) {
  kernel::Instance instance{};
  std::copy(std::begin(p.m), std::end(p.m), instance.to_world);
  invert(p, instance.to_object);
  instance.flags = p.mirrored() ? SUN_INSTANCE_MIRRORED : 0;
  instance.first_emitter = SUN_NONE;
  return instance;
}

bool has_inverse(const kernel::Instance &instance) {
  return std::all_of(std::begin(instance.to_object), std::end(instance.to_object), [](float x) { return std::isfinite(x); });
}

std::vector<kernel::InstanceKey> keys_of(const glm::mat4x3 &transform, const std::vector<glm::mat4x3> &later) {
  std::vector<kernel::InstanceKey> keys;
  if (later.empty()) return keys;
  const auto add = [&](const glm::mat4x3 &m) {
    kernel::InstanceKey key;
    const Placement p = placement_of(m);
    std::copy(std::begin(p.m), std::end(p.m), key.to_world);
    keys.push_back(key);
  };
  add(transform);
  for (const glm::mat4x3 &m : later) add(m);
  return keys;
}

void take_keys(const std::vector<kernel::InstanceKey> &keys, kernel::Instance &instance, FlatScene &flat) {
  if (keys.empty()) return;
  const std::size_t number = flat.instance_keys.size() / keys.size();
  if (number >= SUN_MOST_MOVING_INSTANCES) throw Error{"flatten", "more than 2^20 instances move", "a --shutter of 0 shows them still"};
  instance.flags |= SUN_INSTANCE_MOVING | static_cast<kernel::uint>(number) << SUN_INSTANCE_MOTION_SHIFT;
  std::fill(std::begin(instance.to_object), std::end(instance.to_object), 0.0f);
  flat.instance_keys.insert(flat.instance_keys.end(), keys.begin(), keys.end());
}

bool in_range(const Bounds &box) {
  for (int c = 0; c < 3; c++)
    if (!(box.lower[c] >= -farthest && box.upper[c] <= farthest)) return false;
  return true;
}

void include_box(Bounds &box, const Bounds &other) {
  for (int c = 0; c < 3; c++) {
    box.lower[c] = std::min(box.lower[c], other.lower[c]);
    box.upper[c] = std::max(box.upper[c], other.upper[c]);
  }
}

}  // namespace sunstone
