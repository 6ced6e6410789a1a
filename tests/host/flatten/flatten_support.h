// SPDX-License-Identifier: Apache-2.0
// Small scenes and random numbers for the tests of flatten.
#pragma once
#include <cstdint>

#include "flatten/flatten.h"

namespace sunstone {

// PCG's output function on a counter: independent numbers k * 2^-24 in [0, 1).
class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed * 0x9e3779b9u + 1) {}
  std::uint32_t bits() {
    state_ = state_ * 747796405u + 2891336453u;
    const std::uint32_t word = ((state_ >> ((state_ >> 28) + 4)) ^ state_) * 277803737u;
    return (word >> 22) ^ word;
  }
  float number() { return static_cast<float>(bits() >> 8) * 0x1p-24f; }
  float between(float lower, float upper) { return lower + (upper - lower) * number(); }

 private:
  std::uint32_t state_;
};

// A square of side 2 about the origin in the plane z = 0, front towards +z, two triangles, with normals and coordinates.
inline Primitive square(int material = -1) {
  Primitive p;
  p.material = material;
  p.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  p.normals.assign(4, glm::vec3(0, 0, 1));
  p.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.indices = {0, 1, 2, 0, 2, 3};
  return p;
}

inline glm::mat4x3 moved(glm::vec3 offset, float scale = 1) {
  glm::mat4x3 m(scale);
  m[3] = offset;
  return m;
}

inline Scene scene_of(const Primitive &primitive, const glm::mat4x3 &transform = glm::mat4x3(1)) {
  Scene scene;
  scene.name = "test";
  scene.meshes.push_back({"mesh", {primitive}});
  scene.instances.push_back({"node", 0, transform});
  return scene;
}

// A grid of n x n cells over [-1, 1]^2 with random heights, 2 n^2 triangles, smooth normals.
inline Primitive bumpy(int n, std::uint32_t seed) {
  Primitive p;
  Random random(seed);
  for (int y = 0; y <= n; y++)
    for (int x = 0; x <= n; x++) {
      p.positions.push_back({2.0f * float(x) / float(n) - 1, 2.0f * float(y) / float(n) - 1, random.between(0, 0.2f)});
      const glm::vec3 tilted(random.between(-0.3f, 0.3f), random.between(-0.3f, 0.3f), 1);
      p.normals.push_back(glm::normalize(tilted));
      p.uv[0].push_back({float(x) / float(n), float(y) / float(n)});
    }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; y++)
    for (int x = 0; x < n; x++)
      for (std::uint32_t i : {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1)}) p.indices.push_back(i);
  return p;
}

inline Image byte_image(int width, int height, int channels, std::uint32_t seed) {
  Image image;
  image.name = "bytes";
  image.width = width;
  image.height = height;
  image.channels = channels;
  Random random(seed);
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height * channels));
  for (auto &pixel : pixels) pixel = static_cast<std::uint8_t>(random.bits() >> 24);
  image.pixels = std::move(pixels);
  return image;
}

inline Image float_image(int width, int height, int channels, std::vector<float> pixels) {
  Image image;
  image.name = "floats";
  image.width = width;
  image.height = height;
  image.channels = channels;
  image.pixels = std::move(pixels);
  return image;
}

inline FlatScene flattened(const Scene &scene, const FlattenOptions &options = {}) {
  Notices notices;
  return flatten(scene, options, notices);
}

}  // namespace sunstone
