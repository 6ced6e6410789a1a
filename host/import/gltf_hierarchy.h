// SPDX-License-Identifier: Apache-2.0
// Nodes as trees, walked without recursion: which of them the file's scene shows, where each is in the world, and how it moves while the shutter is open.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "import/gltf_animations.h"
#include "import/gltf_value.h"

namespace sunstone::gltf {

// A translation after a rotation after a scale.
glm::dmat4 compose(const glm::dvec3 &t, const glm::dvec4 &q, const glm::dvec3 &s);

// Unit quaternion; no rotation, and a warning, where it has no length.
glm::dvec4 unit_quaternion(const glm::dvec4 &q, const Value &who);

// Transforms are composed in double precision.
class Hierarchy {
 public:
  explicit Hierarchy(const Value &root);

  // Places all nodes in the pose that the animation has at `time`, with keys of how they move in the `shutter` seconds from then on. Returns those that the file's scene
  // shows, parents first, in the file's order; others are placed only where there are skins.
  std::vector<std::size_t> place(const Animation &animation, double time, double shutter);

  std::size_t keys() const { return keys_.empty() ? 1 : keys_.size(); }  // of the shutter's time; 1: nothing moves
  std::size_t keys(std::size_t node) const;                              // the same; 1: its place is one at all of them
  const glm::dmat4 &world(std::size_t node, std::size_t key) const;
  const Pose &pose(std::size_t node, std::size_t key) const;

 private:
  // Poses and places of the nodes that may move, at one time.
  struct Key {
    std::vector<Pose> poses;
    std::vector<glm::dmat4> worlds;
  };
  void check();
  std::vector<std::size_t> scene_roots() const;
  void place_below(const std::vector<std::size_t> &roots);
  Key key_at(const Animation &animation, double time) const;
  void find_moving(const Animation &animation);
  void make_keys(const Animation &animation, double time, double shutter);
  bool straight(const std::vector<Key> &keys, const Animation &animation, double time, double shutter) const;

  Value root_, nodes_;
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
