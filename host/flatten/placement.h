// SPDX-License-Identifier: Apache-2.0
// Where an instance stands: its transform, what follows of it, and the keys of one that moves while the shutter is open.
#pragma once
#include "flatten/flatten.h"

namespace sunstone {

struct Placement {
  float m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // row major
  double normal[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};      // inverse transpose, but for a positive factor
  double determinant = 1;
  bool mirrored() const { return determinant < 0; }
};
Placement placement_of(const glm::mat4x3 &transform);

// A point in world space, the sums in the order of kernels/scene: ((x + y) + z) + offset, in float.
glm::vec3 transform_point(const float *matrix, float x, float y, float z);
glm::vec3 transform_point(const kernel::Instance &instance, const float *position);

// An instance that stands there: both matrices, and SUN_INSTANCE_MIRRORED among its flags. No emitters, no box.
kernel::Instance instance_at(const Placement &placement);

// Whether its inverse can be had in single precision.
bool has_inverse(const kernel::Instance &instance);

// Keys of one transform: none where it does not move.
std::vector<kernel::InstanceKey> keys_of(const glm::mat4x3 &transform, const std::vector<glm::mat4x3> &later);

// Enters the keys of an instance that moves, and marks it. Its to_object is not used.
void take_keys(const std::vector<kernel::InstanceKey> &keys, kernel::Instance &instance, FlatScene &flat);

constexpr float farthest = 1e18f;  // of a coordinate: squares stay finite
bool in_range(const Bounds &box);
void include_box(Bounds &box, const Bounds &other);

}  // namespace sunstone
