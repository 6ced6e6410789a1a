// SPDX-License-Identifier: Apache-2.0
// The hierarchy of nodes, walked without recursion: instances, analytic shapes, cameras and punctual lights in world space.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "import/gltf_meshes.h"
#include "scene/scene.h"

namespace sunstone::gltf {

class Nodes {
 public:
  Nodes(const Value &root, Accessors &accessors, Materials &materials, Meshes &meshes);

  // Adds what the file's scene shows. Transforms are composed in double precision.
  void import(Scene &scene);

 private:
  void check_hierarchy();
  std::vector<std::size_t> scene_roots();
  void add_node(const Value &node, const glm::dmat4 &world, Scene &scene);
  void add_instances(const Value &node, const glm::dmat4 &world, Scene &scene);
  void add_camera(const Value &node, const glm::dmat4 &world, Scene &scene);
  void add_shape(const Value &node, const Value &shape, const glm::dmat4 &world, Scene &scene);
  void add_light(const Value &node, const glm::dmat4 &world, Scene &scene);

  Value root_, nodes_, cameras_, lights_, shapes_;
  Accessors &accessors_;
  Materials &materials_;
  Meshes &meshes_;
  std::vector<int> parents_;  // -1: a root
  std::vector<std::vector<std::uint32_t>> children_;
};

}  // namespace sunstone::gltf
