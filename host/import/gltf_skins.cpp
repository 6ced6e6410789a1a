// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_skins.h"

#include <cmath>
#include <utility>

namespace sunstone::gltf {

namespace {

// What takes normals along where m takes points: the inverse transpose times the determinant, products alone.
glm::dmat3 cofactors(const glm::dmat4 &m) {
  const glm::dvec3 a(m[0]), b(m[1]), c(m[2]);
  return {glm::cross(b, c), glm::cross(c, a), glm::cross(a, b)};
}

glm::vec3 rounded(const glm::dvec3 &v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

// Directions lose their length here, lest it vanishes or overflows as a float; zero stays zero, for the repairs that follow.
glm::vec3 direction(const glm::dvec3 &v) {
  const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
  return length > 0 && std::isfinite(length) ? rounded(v / length) : glm::vec3(0);
}

}  // namespace

Influences read_influences(const Value &attributes, std::size_t vertices, Accessors &accessors) {
  Influences all;
  for (int set = 0;; set++) {
    const std::string number = std::to_string(set);
    const Value joints = attributes[("JOINTS_" + number).c_str()], weights = attributes[("WEIGHTS_" + number).c_str()];
    if (!joints && !weights) return all;
    if (!joints) joints.fail("is missing beside " + weights.place());
    if (!weights) weights.fail("is missing beside " + joints.place());
    const Accessor which = accessors.open(joints, 4), weight = accessors.open(weights, 4);
    for (const auto &[value, accessor] : {std::pair{joints, which}, std::pair{weights, weight}})
      if (accessor.count != vertices) value.fail("has " + counted(accessor.count, "elements") + ", but there are " + counted(vertices, "positions"));
    if ((which.component_type != 5121 && which.component_type != 5123) || which.normalized)
      which.value["componentType"].fail(std::to_string(which.component_type) + " cannot number joints: that takes 5121 or 5123, not normalised");
    if (weight.component_type != 5126 && !(weight.normalized && (weight.component_type == 5121 || weight.component_type == 5123)))
      weight.value["componentType"].fail(std::to_string(weight.component_type) + " cannot be a weight: that takes 5126, or 5121 and 5123 normalised");
    all.joints.push_back(accessors.numbers(which));
    all.weights.push_back(accessors.numbers(weight));
  }
}

std::vector<std::size_t> read_joints(const Value &skin, std::size_t node_count) {
  skin.expect_object();
  skin.check_extensions({});
  const Value listed = skin["joints"];
  if (listed.size() == 0) listed.fail(listed ? "is empty" : "is missing");
  std::vector<std::size_t> joints(listed.size());
  for (std::size_t i = 0; i < joints.size(); i++) joints[i] = listed[i].index(node_count, "nodes");
  return joints;
}

std::vector<glm::dmat4> joint_matrices(const Value &skin, const std::vector<glm::dmat4> &joints_world, Accessors &accessors) {
  std::vector<glm::dmat4> matrices = joints_world;
  const Value reference = skin["inverseBindMatrices"];
  if (!reference) return matrices;
  const Accessor accessor = accessors.open(reference, 16);
  if (accessor.component_type != 5126) accessor.value["componentType"].fail(std::to_string(accessor.component_type) + " cannot be a matrix: that takes 5126");
  if (accessor.count < matrices.size())
    reference.fail("has " + counted(accessor.count, "elements") + ", but there are " + counted(matrices.size(), "joints"));
  const std::vector<double> m = accessors.numbers(accessor);
  for (std::size_t i = 0; i < matrices.size(); i++) {
    const double *const v = &m[16 * i];
    matrices[i] = matrices[i] * glm::dmat4(v[0], v[1], v[2], 0, v[4], v[5], v[6], 0, v[8], v[9], v[10], 0, v[12], v[13], v[14], 1);
  }
  return matrices;
}

void apply_skin(const Value &attributes, const Influences &influences, const std::vector<glm::dmat4> &joints, Primitive &primitive) {
  const std::size_t vertices = primitive.positions.size();
  if (influences.joints.empty()) attributes.warn("has no joints for its node's skin, so it is shown where it is stored");
  std::vector<bool> mirrored(vertices, false);
  for (std::size_t i = 0; i < vertices && !influences.joints.empty(); i++) {
    glm::dmat4 blend(0);
    double sum = 0;
    for (std::size_t set = 0; set < influences.joints.size(); set++)
      for (std::size_t k = 4 * i; k < 4 * i + 4; k++) {
        const double weight = influences.weights[set][k];
        if (weight == 0) continue;
        if (!(weight > 0) || !std::isfinite(weight))
          attributes[("WEIGHTS_" + std::to_string(set)).c_str()].fail("a weight of vertex " + std::to_string(i) + " is negative or not finite");
        const double joint = influences.joints[set][k];
        if (!(joint < static_cast<double>(joints.size())))
          attributes[("JOINTS_" + std::to_string(set)).c_str()].fail("index " + std::to_string(static_cast<std::size_t>(joint)) +
                                                                       ", but there " + (joints.size() == 1 ? "is " : "are ") + counted(joints.size(), "joints"));
        blend += joints[static_cast<std::size_t>(joint)] * weight;
        sum += weight;
      }
    if (!(sum > 0)) {
      attributes.warn("vertices without weights follow the first joint");
      blend = joints[0];
      sum = 1;
    }
    blend = blend / sum;
    primitive.positions[i] = rounded(glm::dvec3(blend * glm::dvec4(glm::dvec3(primitive.positions[i]), 1)));
    const glm::dmat3 along = cofactors(blend);
    const double volume = glm::dot(glm::dvec3(blend[0]), along[0]);
    mirrored[i] = volume < 0;
    if (!primitive.normals.empty()) primitive.normals[i] = direction(along * glm::dvec3(primitive.normals[i]) * (volume < 0 ? -1.0 : 1.0));
    if (!primitive.tangents.empty()) {
      const glm::vec4 tangent = primitive.tangents[i];
      primitive.tangents[i] = glm::vec4(direction(glm::dmat3(blend) * glm::dvec3(tangent)), volume < 0 ? -tangent.w : tangent.w);
    }
  }
  for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
    std::uint32_t *const corner = &primitive.indices[t];
    if (mirrored[corner[0]] && mirrored[corner[1]] && mirrored[corner[2]]) std::swap(corner[1], corner[2]);
  }
}

}  // namespace sunstone::gltf
