// SPDX-License-Identifier: Apache-2.0
// The hierarchy of nodes, walked without recursion: instances, analytic shapes, cameras and punctual lights in world space.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "import/gltf_animations.h"
#include "import/gltf_meshes.h"
#include "scene/scene.h"

namespace sunstone::gltf {

class Nodes {
 public:
  Nodes(const Value &root, Accessors &accessors, Materials &materials, Meshes &meshes);

  // Adds what the file's scene shows, in the pose that the animation has at `time`. Transforms are composed in double precision.
  void import(const Animation &animation, double time, Scene &scene);

 private:
  void check_hierarchy();
  std::vector<std::size_t> scene_roots();
  void place(const std::vector<std::size_t> &roots);
  std::optional<Joints> joints_of(const Value &node);
  void add_node(std::size_t number, Scene &scene);
  void add_instances(const Value &node, const std::optional<std::vector<double>> &weights, const glm::dmat4 &world, Scene &scene);
  void add_camera(const Value &node, const glm::dmat4 &world, Scene &scene);
  void add_shape(const Value &node, const Value &shape, const glm::dmat4 &world, Scene &scene);
  void add_light(const Value &node, const glm::dmat4 &world, Scene &scene);

  Value root_, nodes_, cameras_, lights_, shapes_, skins_;
  Accessors &accessors_;
  Materials &materials_;
  Meshes &meshes_;
  std::vector<int> parents_;  // -1: a root
  std::vector<std::vector<std::uint32_t>> children_;
  std::vector<Pose> poses_;          // of every node, empty at rest
  std::vector<glm::dmat4> worlds_;   // of the nodes in order_
  std::vector<std::size_t> order_;   // those placed so far, parents first, in the file's order
};

}  // namespace sunstone::gltf
