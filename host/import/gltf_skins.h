// SPDX-License-Identifier: Apache-2.0
// Skins: vertices that follow joints, blended linearly (glTF 2.0, section 3.7.3).
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "import/gltf_accessors.h"
#include "scene/scene.h"

namespace sunstone::gltf {

// The nodes that are the joints of a skin.
std::vector<std::size_t> read_joints(const Value &skin, std::size_t node_count);

// One matrix a joint: inverse bind matrix, then the joint's own; mesh -> world.
std::vector<glm::dmat4> joint_matrices(const Value &skin, const std::vector<glm::dmat4> &joints_world, Accessors &accessors);

// Weights and joints of the vertices: four a set, sets JOINTS_0, JOINTS_1, ... one after the other.
struct Influences {
  std::vector<std::vector<double>> joints, weights;
};
Influences read_influences(const Value &attributes, std::size_t vertices, Accessors &accessors);

// Takes the vertices of `primitive`, whose attributes these are, from the mesh to the world. Faces of mirrored joints keep their front.
void apply_skin(const Value &attributes, const Influences &influences, const std::vector<glm::dmat4> &joints, Primitive &primitive);

}  // namespace sunstone::gltf
