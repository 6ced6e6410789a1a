// SPDX-License-Identifier: Apache-2.0
// An animation of the file: curves of nodes, read and checked once, asked for poses at any time.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "import/gltf_accessors.h"
#include "import/gltf_curves.h"

namespace sunstone::gltf {

// What an animation makes of a node at one time; absent is what it leaves as it is stored.
struct Pose {
  std::optional<glm::dvec3> translation, scale;
  std::optional<glm::dvec4> rotation;
  std::optional<std::vector<double>> weights;  // of its mesh's morph targets
};

class Animation {
 public:
  Animation() = default;  // everything is at rest

  // The animation of that name or number (empty: the first). The file has to have one.
  Animation(const Value &root, Accessors &accessors, const std::string &choice);

  Pose pose(std::size_t node, double time) const;
  bool moves(std::size_t node) const { return curves_.contains(node); }
  double first() const { return first_; }  // seconds, over all curves
  double last() const { return last_; }

 private:
  enum class Path { translation, rotation, scale, weights };
  void read_channel(const Value &channel, const Value &samplers, const Value &root, Accessors &accessors);

  std::map<std::size_t, std::map<Path, Curve>> curves_;  // by node
  double first_ = 0, last_ = 0;
};

}  // namespace sunstone::gltf
