// SPDX-License-Identifier: Apache-2.0
#include "bench/big_scene.h"

#include <cstdint>

#include "bench/rays.h"
#include "math/elementary.h"
#include "math/vector.h"

namespace sunstone {
namespace {

using kernel::make_vec3;
using kernel::uint;
using kernel::vec3;

constexpr float pi = 3.14159265f;

float sine(float x) {
  float s, c;
  kernel::sin_cos(x, &s, &c);
  return s;
}
float cosine(float x) {
  float s, c;
  kernel::sin_cos(x, &s, &c);
  return c;
}
vec3 operator+(vec3 a, vec3 b) { return kernel::add3(a, b); }
vec3 operator*(vec3 a, float s) { return kernel::scale3(a, s); }

class Maker {
 public:
  // A grid of n x n cells spanned by u and v; the floor's bumps where `bumpy`.
  void grid(vec3 origin, vec3 u, vec3 v, uint n, bool bumpy) {
    const uint base = uint(scene.vertices.size());
    const vec3 normal = kernel::normalize3(kernel::cross3(u, v));
    for (uint j = 0; j <= n; j++)
      for (uint i = 0; i <= n; i++) {
        const float s = float(i) / float(n), t = float(j) / float(n);
        vertex(origin + u * s + v * t + normal * (bumpy ? 0.15f * sine(40.0f * s) * sine(37.0f * t) : 0.0f));
      }
    for (uint j = 0; j < n; j++)
      for (uint i = 0; i < n; i++) {
        const uint a = base + j * (n + 1) + i;
        triangle(a, a + 1, a + n + 2);
        triangle(a, a + n + 2, a + n + 1);
      }
  }

  void ball(vec3 centre, float radius, uint rings, float amplitude) {
    const uint base = uint(scene.vertices.size()), sectors = 2 * rings;
    for (uint j = 0; j <= rings; j++)
      for (uint i = 0; i <= sectors; i++) {
        const float theta = pi * float(j) / float(rings), phi = 2.0f * pi * float(i % sectors) / float(sectors);
        const vec3 d = make_vec3(sine(theta) * cosine(phi), cosine(theta), sine(theta) * sine(phi));
        const float bump = amplitude == 0.0f ? 0.0f : amplitude * sine(14.0f * d.x) * sine(14.0f * d.y + 1.0f) * sine(14.0f * d.z + 2.0f);
        vertex(centre + d * (radius * (1.0f + bump)));
      }
    for (uint j = 0; j < rings; j++)
      for (uint i = 0; i < sectors; i++) {
        const uint a = base + j * (sectors + 1) + i;
        if (j > 0) triangle(a, a + 1, a + sectors + 2);
        if (j < rings - 1) triangle(a, a + sectors + 2, a + sectors + 1);
      }
  }

  void blade(vec3 root, vec3 width, vec3 height) {
    const uint base = uint(scene.vertices.size());
    vertex(root);
    vertex(root + width);
    vertex(root + height);
    triangle(base, base + 1, base + 2);
  }

  // A prism of three sides.
  void rod(vec3 from, vec3 along) {
    const uint base = uint(scene.vertices.size());
    for (int k = 0; k < 3; k++) {
      const vec3 aside = make_vec3(0.02f * cosine(2.1f * float(k)), 0.02f * sine(2.1f * float(k)), 0.01f);
      vertex(from + aside);
      vertex(from + along + aside);
    }
    for (uint k = 0; k < 3; k++) {
      const uint a = base + 2 * k, b = base + 2 * ((k + 1) % 3);
      triangle(a, a + 1, b + 1);
      triangle(a, b + 1, b);
    }
  }

  float random() { return float(hash_number(++count_) >> 8) * 5.96046448e-08f; }
  float random(float lower, float upper) { return lower + (upper - lower) * random(); }

  FlatScene scene;

 private:
  void vertex(vec3 p) {
    kernel::Vertex v{};
    v.position[0] = p.x;
    v.position[1] = p.y;
    v.position[2] = p.z;
    v.normal[1] = 1.0f;
    scene.vertices.push_back(v);
    scene.bounds.lower = glm::min(scene.bounds.lower, glm::vec3(p.x, p.y, p.z));
    scene.bounds.upper = glm::max(scene.bounds.upper, glm::vec3(p.x, p.y, p.z));
  }
  void triangle(uint a, uint b, uint c) {
    scene.triangle_ids.push_back(uint(scene.triangles.size()));
    scene.triangle_object.push_back(1);
    scene.triangles.push_back({{a, b, c}, 0});
  }
  std::uint32_t count_ = 0;
};

}  // namespace

FlatScene make_big_scene() {
  Maker make;
  make.grid(make_vec3(-10, 0, -10), make_vec3(0, 0, 20), make_vec3(20, 0, 0), 200, true);
  make.grid(make_vec3(-10, 8, -10), make_vec3(20, 0, 0), make_vec3(0, 0, 20), 2, false);
  make.grid(make_vec3(-10, -1, -10), make_vec3(20, 0, 0), make_vec3(0, 9, 0), 2, false);
  make.grid(make_vec3(-10, -1, 10), make_vec3(0, 9, 0), make_vec3(20, 0, 0), 2, false);
  make.grid(make_vec3(-10, -1, -10), make_vec3(0, 9, 0), make_vec3(0, 0, 20), 2, false);
  make.grid(make_vec3(10, -1, -10), make_vec3(0, 0, 20), make_vec3(0, 9, 0), 2, false);
  for (int i = 0; i < 6; i++) {
    const float x = -6.0f + 4.0f * float(i % 3) + make.random(0, 2), y = make.random(1.5f, 2.5f);
    make.ball(make_vec3(x, y, i < 3 ? -5.0f : 1.0f), 1.2f, 120, 0.15f);
  }
  for (int cluster = 0; cluster < 40; cluster++) {
    const float x = make.random(-9, 9), z = make.random(-9, 9), spread = make.random(0.3f, 1.3f);
    for (int i = 0; i < 45; i++) {
      const float dx = make.random(-0.5f, 0.5f), dy = make.random(), dz = make.random(-0.5f, 0.5f);
      const float size = make.random() * make.random();
      make.ball(make_vec3(x + dx * spread, 0.3f + dy * spread, z + dz * spread), 0.03f + 0.1f * size, 8, 0.0f);
    }
  }
  for (int i = 0; i < 120000; i++) {
    const float radius = 5.0f * kernel::sqrt_or_zero(make.random()), angle = 2.0f * pi * make.random();
    const vec3 root = make_vec3(3.0f + radius * cosine(angle), 0.0f, 2.0f + radius * sine(angle));
    const float hx = make.random(-0.1f, 0.1f), hy = make.random(0.2f, 0.7f), hz = make.random(-0.1f, 0.1f);
    const float wx = make.random(-0.015f, 0.015f), wz = make.random(-0.015f, 0.015f);
    make.blade(root, make_vec3(wx, 0.0f, wz), make_vec3(hx, hy, hz));
  }
  for (int i = 0; i < 300; i++) {
    const float x = make.random(-9, 9), y = make.random(0, 7), z = make.random(-9, 9);
    const auto within = [](float value, float lower, float upper) { return kernel::clamp_real(value, lower, upper); };
    const float dx = within(x + make.random(-6, 6), -9.5f, 9.5f) - x, dy = within(y + make.random(-2, 2), 0.0f, 7.5f) - y;
    make.rod(make_vec3(x, y, z), make_vec3(dx, dy, within(z + make.random(-6, 6), -9.5f, 9.5f) - z));
  }
  FlatScene scene = std::move(make.scene);
  scene.meshes.push_back({0, uint(scene.triangles.size())});
  scene.instance_mesh.push_back(0);
  scene.instance_object.push_back(0);
  kernel::Instance instance{};
  for (int axis = 0; axis < 3; axis++) {
    instance.to_world[5 * axis] = instance.to_object[5 * axis] = 1.0f;
    instance.lower[axis] = scene.bounds.lower[axis];
    instance.upper[axis] = scene.bounds.upper[axis];
  }
  instance.flags = SUN_INSTANCE_IDENTITY;
  instance.first_emitter = SUN_NONE;
  scene.instances.push_back(instance);
  return scene;
}

}  // namespace sunstone
