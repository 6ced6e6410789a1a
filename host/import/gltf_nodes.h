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

  // Adds what the file's scene shows, in the pose that the animation has at `time`, and with keys of how it moves in the `shutter` seconds from then on.
  // Transforms are composed in double precision.
  void import(const Animation &animation, double time, double shutter, Scene &scene);

 private:
  void check_hierarchy();
  std::vector<std::size_t> scene_roots();
  void place(const std::vector<std::size_t> &roots);
  // Poses and places of the nodes that may move, at one time.
  struct Key {
    std::vector<Pose> poses;
    std::vector<glm::dmat4> worlds;
  };
  Key key_at(const Animation &animation, double time);
  void find_moving(const Animation &animation);
  void make_keys(const Animation &animation, double time, double shutter);
  bool straight(const std::vector<Key> &keys, const Animation &animation, double time, double shutter);
  const glm::dmat4 &world(std::size_t node, std::size_t key) const;
  const Pose &pose(std::size_t node, std::size_t key) const;
  bool moves(std::size_t node) const;  // is its place another at any key?
  std::optional<Joints> joints_of(const Value &node, std::size_t key);
  void add_node(std::size_t number, Scene &scene);
  std::vector<MeshPose> mesh_poses(std::size_t number, bool skinned);
  void add_instances(std::size_t number, const Value &node, Scene &scene);
  void add_camera(std::size_t number, const Value &node, Scene &scene);
  void add_shape(std::size_t number, const Value &node, const Value &shape, Scene &scene);
  void add_light(std::size_t number, const Value &node, Scene &scene);

  Value root_, nodes_, cameras_, lights_, shapes_, skins_;
  Accessors &accessors_;
  Materials &materials_;
  Meshes &meshes_;
  std::vector<int> parents_;  // -1: a root
  std::vector<std::vector<std::uint32_t>> children_;
  std::vector<Pose> poses_;          // of every node, empty at rest
  std::vector<glm::dmat4> worlds_;   // of the nodes in order_
  std::vector<std::size_t> order_;   // those placed so far, parents first, in the file's order
  std::vector<std::size_t> moving_;  // those of them that the animation may move, in that order
  std::vector<int> place_in_moving_; // of every node; -1: it keeps still
  std::vector<Key> keys_;            // of the shutter's time: two at least, or none
};

}  // namespace sunstone::gltf
