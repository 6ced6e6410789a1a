// SPDX-License-Identifier: Apache-2.0
#include "scene/view_score.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace sunstone {

namespace {

constexpr std::size_t small_triangles = 6000, large_triangles = 6000;
constexpr std::size_t most_tests =
    300000;  // of pixels against triangles, a view: thousands of triangles that each fill the picture are not all looked at
constexpr float smallest_cosine = 0.1f;  // more slanted surfaces count as this, or one row of pixels would outweigh the picture

bool double_sided(const Scene &scene, const Primitive &primitive) {
  if (primitive.material < 0) return false;
  const Material &material = scene.materials[primitive.material];
  return material.double_sided || material.transmission > 0 || material.volume;
}

// The longest side of a triangle's box, a cheap stand-in for its size.
float extent(const glm::vec3 corner[3]) {
  const glm::vec3 e = glm::max(glm::max(corner[0], corner[1]), corner[2]) - glm::min(glm::min(corner[0], corner[1]), corner[2]);
  return std::max(std::max(e.x, e.y), e.z);
}

}  // namespace

ViewSample::ViewSample(const Scene &scene, const Bounds &bounds) : pixels_(size * size), radius_(0.5f * glm::length(bounds.upper - bounds.lower)) {
  std::size_t total = 0;
  for (const Instance &instance : scene.instances)
    for (const Primitive &p : scene.meshes[instance.mesh].primitives) total += p.indices.size() / 3;
  const std::size_t stride = std::max<std::size_t>(1, total / small_triangles);
  const glm::vec3 size3 = bounds.upper - bounds.lower;
  const float large = std::max(std::max(size3.x, size3.y), size3.z) / 16;
  std::size_t number = 0, large_found = 0;
  for (const Instance &instance : scene.instances) {
    const glm::mat4x3 &m = instance.transform;
    const float scale = std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
    const bool mirrored = glm::dot(glm::cross(m[0], m[1]), m[2]) < 0;
    for (const Primitive &p : scene.meshes[instance.mesh].primitives) {
      const bool both = double_sided(scene, p);
      for (std::size_t t = 0; t < p.indices.size(); t += 3, number++) {
        const bool chosen = number % stride == 0;
        if (!chosen && large_found >= large_triangles) {  // on to the next that is chosen
          const std::size_t skip = std::min(stride - number % stride, (p.indices.size() - t) / 3) - 1;
          t += 3 * skip;
          number += skip;
          continue;
        }
        glm::vec3 corner[3] = {p.positions[p.indices[t]], p.positions[p.indices[t + 1]], p.positions[p.indices[t + 2]]};
        if (!chosen && extent(corner) * scale < large) continue;
        if (!chosen) large_found++;
        for (glm::vec3 &c : corner) c = m * glm::vec4(c, 1);
        if (mirrored) std::swap(corner[1], corner[2]);
        triangles_.push_back({{corner[0], corner[1], corner[2]}, both});
      }
    }
  }
}

double ViewSample::score(const Camera &camera, float aspect) {
  float sine, cosine;
  kernel::sin_cos(0.5f * camera.yfov, &sine, &cosine);
  half_height_ = sine / cosine;
  half_width_ = half_height_ * aspect;
  near_ = camera.focus_distance - radius_;
  tests_ = 0;
  std::fill(pixels_.begin(), pixels_.end(), Pixel{});
  const glm::vec3 right = camera.transform[0], up = camera.transform[1], back = camera.transform[2], eye = camera.transform[3];
  for (const Triangle &triangle : triangles_) {
    glm::vec3 corner[3];
    for (int k = 0; k < 3; k++) {
      const glm::vec3 d = triangle.corner[k] - eye;
      corner[k] = {glm::dot(d, right), glm::dot(d, up), -glm::dot(d, back)};
    }
    if (corner[0].z > 0 && corner[1].z > 0 && corner[2].z > 0) draw(corner, triangle.double_sided);
    if (tests_ > most_tests) break;
  }
  double area = 0, facing = 0;
  for (const Pixel &pixel : pixels_) {
    area += pixel.area;
    facing += pixel.facing;
  }
  return 0.75 * area + 0.25 * facing;
}

// Depth runs along z, away from the camera. 1 / depth is linear over the picture.
void ViewSample::draw(const glm::vec3 corner[3], bool double_sided) {
  glm::vec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const float length = glm::length(normal);
  if (!(length > 0)) return;
  normal /= length;
  // (The camera's frame is turned inside out along z, so a front face has its normal along the view.)
  if (!double_sided && glm::dot(normal, corner[0]) <= 0) return;
  float x[3], y[3], nearness[3];
  for (int k = 0; k < 3; k++) {
    nearness[k] = 1 / corner[k].z;
    x[k] = (corner[k].x * nearness[k] / half_width_ * 0.5f + 0.5f) * size;
    y[k] = (corner[k].y * nearness[k] / half_height_ * 0.5f + 0.5f) * size;
  }
  const auto put = [&](int px, int py, float near) {
    Pixel &pixel = pixels_[py * size + px];
    if (!(near > pixel.nearness)) return;
    const glm::vec3 along((px + 0.5f) / size * 2 * half_width_ - half_width_, (py + 0.5f) / size * 2 * half_height_ - half_height_, 1);
    const float view = glm::length(along), cosine = std::max(std::abs(glm::dot(normal, along)) / view, smallest_cosine);
    const float deep = 0.25f + std::clamp((1 / near - near_) / (2 * radius_), 0.0f, 1.0f);
    const float across = 2 * half_width_ / size / near * (2 * half_height_ / size) / near * deep;  // the pixel's area at that depth, weighted
    pixel = {near, across / (cosine * view), across / view};
  };
  const int x0 = std::max(0, static_cast<int>(std::ceil(std::min({x[0], x[1], x[2]}) - 0.5f)));
  const int x1 = std::min(size - 1, static_cast<int>(std::floor(std::max({x[0], x[1], x[2]}) - 0.5f)));
  const int y0 = std::max(0, static_cast<int>(std::ceil(std::min({y[0], y[1], y[2]}) - 0.5f)));
  const int y1 = std::min(size - 1, static_cast<int>(std::floor(std::max({y[0], y[1], y[2]}) - 0.5f)));
  const float twice = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (twice == 0) return;
  if (x1 - x0 < 1 && y1 - y0 < 1) {  // no larger than a pixel or two: it stands for its neighbours that were left out
    const int px = static_cast<int>((x[0] + x[1] + x[2]) / 3), py = static_cast<int>((y[0] + y[1] + y[2]) / 3);
    if (px >= 0 && px < size && py >= 0 && py < size) put(px, py, (nearness[0] + nearness[1] + nearness[2]) / 3);
    return;
  }
  tests_ += std::size_t(std::max(0, x1 - x0 + 1)) * std::max(0, y1 - y0 + 1);
  const float scale = 1 / twice;
  for (int py = y0; py <= y1; py++) {
    const float cy = py + 0.5f;
    for (int px = x0; px <= x1; px++) {
      const float cx = px + 0.5f;
      const float u = ((x[1] - cx) * (y[2] - cy) - (x[2] - cx) * (y[1] - cy)) * scale;
      const float v = ((x[2] - cx) * (y[0] - cy) - (x[0] - cx) * (y[2] - cy)) * scale;
      const float w = 1 - u - v;
      if (u >= 0 && v >= 0 && w >= 0) put(px, py, u * nearness[0] + v * nearness[1] + w * nearness[2]);
    }
  }
}

}  // namespace sunstone
