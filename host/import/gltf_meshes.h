// SPDX-License-Identifier: Apache-2.0
// Meshes: primitives of triangles in every mode, morph targets at the weights of the pose, skins.
#pragma once
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "import/gltf_accessors.h"
#include "import/gltf_materials.h"
#include "scene/scene.h"

namespace sunstone::gltf {

using Joints = std::vector<glm::dmat4>;  // of a skin: mesh -> world

// What the animation makes of a mesh at one time: weights of its morph targets, joints of its node's skin.
struct MeshPose {
  std::optional<std::vector<double>> weights{};
  std::optional<Joints> joints{};
};

class Meshes {
 public:
  Meshes(const Value &root, Accessors &accessors, Materials &materials) : meshes_(root["meshes"]), accessors_(accessors), materials_(materials) {}

  // The mesh that a node shows, as a number into Scene::meshes; -1 where nothing of it can be rendered. Nodes that share a mesh, and do not
  // give it weights of their own, get the same one; what follows a skin is its node's alone, in world space. One pose, or where it deforms one for each key
  // of the shutter's time.
  int mesh(const Value &node, std::vector<MeshPose> poses, Scene &scene);

 private:
  Mesh read(const Value &value, const std::vector<MeshPose> &poses, Scene &scene);
  bool read_primitive(const Value &value, const std::vector<MeshPose> &poses, Primitive &primitive);
  void read_attributes(const Value &value, Primitive &primitive);
  void read_indices(const Value &value, Primitive &primitive);

  Value meshes_;
  Accessors &accessors_;
  Materials &materials_;
  std::map<std::pair<std::size_t, std::vector<double>>, int> numbers_;  // by the weights of all poses
};

}  // namespace sunstone::gltf
