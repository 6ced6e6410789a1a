// SPDX-License-Identifier: Apache-2.0
#include "flatten/camera.h"

#include "flatten/weld.h"
#include "math/elementary.h"
#include "math/vector.h"

namespace sunstone {

kernel::Camera flatten_camera(const Camera &camera, int width, int height) {
  kernel::Camera out{};
  const glm::vec3 right = unit_vector(glm::dvec3(camera.transform[0]));
  const glm::vec3 up = unit_vector(glm::dvec3(camera.transform[1]));
  const glm::vec3 back = unit_vector(glm::dvec3(camera.transform[2]));
  // The vertical extent is kept, and the picture's shape gives the horizontal one: pixels are square.
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  float half_height = camera.half_height;
  if (!camera.orthographic) {
    float sine, cosine;
    kernel::sin_cos(0.5f * camera.yfov, &sine, &cosine);
    half_height = sine / cosine;
  }
  const float half_width = half_height * aspect;
  for (int c = 0; c < 3; c++) {
    out.position[c] = camera.transform[3][c];
    out.right[c] = right[c] * half_width;
    out.up[c] = up[c] * half_height;
    out.forward[c] = -back[c];
  }
  out.kind = camera.orthographic ? SUN_CAMERA_ORTHOGRAPHIC : SUN_CAMERA_PERSPECTIVE;
  out.lens_radius = camera.lens_radius;
  out.focus_distance = camera.focus_distance;
  return out;
}

}  // namespace sunstone
