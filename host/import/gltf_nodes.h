// SPDX-License-Identifier: Apache-2.0
// What nodes show: instances, analytic shapes, cameras and punctual lights in world space.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "import/gltf_hierarchy.h"
#include "import/gltf_meshes.h"
#include "scene/scene.h"

namespace sunstone::gltf {

class Nodes {
 public:
  Nodes(const Value &root, Accessors &accessors, Materials &materials, Meshes &meshes);

  // Adds what the file's scene shows, in the pose that the animation has at `time`, and with keys of how it moves in the `shutter` seconds from then on.
  void import(const Animation &animation, double time, double shutter, Scene &scene);

 private:
  std::optional<Joints> joints_of(const Value &node, std::size_t key);
  void add_node(std::size_t number, Scene &scene);
  std::vector<MeshPose> mesh_poses(std::size_t number, bool skinned);
  void add_instances(std::size_t number, const Value &node, Scene &scene);
  void add_camera(std::size_t number, const Value &node, Scene &scene);
  void add_shape(std::size_t number, const Value &node, const Value &shape, Scene &scene);
  void add_light(std::size_t number, const Value &node, Scene &scene);

  Value nodes_, cameras_, lights_, shapes_, skins_;
  Hierarchy hierarchy_;
  Accessors &accessors_;
  Materials &materials_;
  Meshes &meshes_;
};

}  // namespace sunstone::gltf
