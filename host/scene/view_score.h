// SPDX-License-Identifier: Apache-2.0
// How much of a scene a camera sees: the visible area of its surfaces in square metres, counted in a small depth buffer.
#pragma once
#include <vector>

#include "scene/scene.h"

namespace sunstone {

// The triangles that are looked at: all of a small scene; of a large one, every one that is large and an even choice of the small ones.
class ViewSample {
 public:
  explicit ViewSample(const Scene &scene, const Bounds &bounds);

  // What `camera`, at its focus distance from the middle of the scene, sees at `aspect`. Three quarters of it is the area of what is visible, one
  // quarter that area as it faces the camera, so that of two views of the same surfaces the less slanted one is better. What lies deep in the scene
  // counts up to five times as much as what lies in front: the far walls of a room that is looked into, rather than its outside. Single-sided
  // triangles seen from behind are not there, as in the renderer.
  double score(const Camera &camera, float aspect);

 private:
  static constexpr int size = 40;
  struct Triangle {
    glm::vec3 corner[3];
    bool double_sided;
  };
  struct Pixel {
    float nearness;  // 1 / depth, 0 where nothing is seen
    float area, facing;
  };
  void draw(const glm::vec3 corner[3], bool double_sided);
  std::vector<Triangle> triangles_;
  std::vector<Pixel> pixels_;
  float radius_;                                       // of the scene
  float half_width_ = 0, half_height_ = 0, near_ = 0;  // of the camera at hand; where the scene begins
  std::size_t tests_ = 0;                              // of pixels against triangles
};

}  // namespace sunstone
