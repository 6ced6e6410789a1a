// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "scene/scene.h"
#include "shared/frame.h"

namespace sunstone {

// A camera for a picture of this size, by the arithmetic of kernels/math. Where the file's aspect differs from the picture's, the vertical angle is kept.
kernel::Camera flatten_camera(const Camera &camera, int width, int height);

// For FlatScene::camera_keys: none where it keeps still. `flatten` is the function above, wherever it stands.
inline std::vector<kernel::Camera> flatten_camera_keys(const Camera &camera, int width, int height, kernel::Camera (*flatten)(const Camera &, int, int)) {
  std::vector<kernel::Camera> keys;
  if (camera.keys.empty()) return keys;
  keys.push_back(flatten(camera, width, height));
  for (const glm::mat4x3 &key : camera.keys) {
    Camera then = camera;
    then.transform = key;
    keys.push_back(flatten(then, width, height));
  }
  return keys;
}

}  // namespace sunstone
