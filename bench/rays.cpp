// SPDX-License-Identifier: Apache-2.0
#include "bench/rays.h"

#include "math/elementary.h"
#include "math/vector.h"

namespace sunstone {
namespace {

using kernel::vec3;

vec3 vector_of(const float *v) { return kernel::make_vec3(v[0], v[1], v[2]); }
void store(float *to, vec3 v) {
  to[0] = v.x;
  to[1] = v.y;
  to[2] = v.z;
}

float unit(std::uint32_t seed, std::size_t i, std::uint32_t dimension) {
  return float(hash_number(std::uint32_t(i) * 4 + dimension + hash_number(seed)) >> 8) * 5.96046448e-08f;  // 2^-24
}

// Where a ray hit, a little in front of the surface, and the normal there.
struct Surface {
  vec3 point, normal;
};

vec3 to_world(const kernel::Instance &instance, vec3 p) {
  const float *m = instance.to_world;
  return kernel::make_vec3(m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                           m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]);
}

Surface surface_of(const FlatScene &scene, const TraceRay &ray, const kernel::Hit &hit) {
  const kernel::Triangle &triangle = scene.triangles[hit.primitive];
  vec3 corner[3];
  for (int k = 0; k < 3; k++) corner[k] = to_world(scene.instances[hit.instance], vector_of(scene.vertices[triangle.vertex[k]].position));
  vec3 normal = kernel::normalize3(kernel::cross3(kernel::sub3(corner[1], corner[0]), kernel::sub3(corner[2], corner[0])));
  const vec3 direction = vector_of(ray.direction);
  if (kernel::dot3(normal, direction) > 0) normal = kernel::negate3(normal);
  const vec3 point = kernel::add3(vector_of(ray.origin), kernel::scale3(direction, hit.t));
  const float offset =
      1e-5f * kernel::max_of3(kernel::make_vec3(scene.bounds.upper.x - scene.bounds.lower.x, scene.bounds.upper.y - scene.bounds.lower.y,
                                                scene.bounds.upper.z - scene.bounds.lower.z));
  return {kernel::add3(point, kernel::scale3(normal, offset)), normal};
}

TraceRay make_ray(vec3 origin, vec3 direction, float t_max) {
  TraceRay ray{};
  store(ray.origin, origin);
  store(ray.direction, direction);
  ray.t_max = t_max;
  return ray;
}

constexpr float far_away = 1e30f;

}  // namespace

std::vector<TraceRay> primary_rays(const kernel::Camera &camera, unsigned size) {
  const unsigned tiles = (size + 3) / 4;
  size = tiles * 4;
  std::vector<TraceRay> rays;
  rays.reserve(std::size_t(size) * size);
  for (unsigned tile = 0; tile < tiles * tiles; tile++)
    for (unsigned k = 0; k < 16; k++) {
      const unsigned x = tile % tiles * 4 + k % 4, y = tile / tiles * 4 + k / 4;
      const float sx = 2.0f * (float(x) + 0.5f) / float(size) - 1.0f, sy = 1.0f - 2.0f * (float(y) + 0.5f) / float(size);
      const vec3 aside = kernel::add3(kernel::scale3(vector_of(camera.right), sx), kernel::scale3(vector_of(camera.up), sy));
      if (camera.kind == SUN_CAMERA_ORTHOGRAPHIC)
        rays.push_back(make_ray(kernel::add3(vector_of(camera.position), aside), vector_of(camera.forward), far_away));
      else
        rays.push_back(make_ray(vector_of(camera.position), kernel::normalize3(kernel::add3(vector_of(camera.forward), aside)), far_away));
    }
  return rays;
}

std::vector<TraceRay> bounce_rays(const FlatScene &scene, std::span<const TraceRay> rays, std::span<const kernel::Hit> hits, std::uint32_t seed) {
  std::vector<TraceRay> bounced;
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (hits[i].instance == SUN_NONE) continue;
    const Surface surface = surface_of(scene, rays[i], hits[i]);
    const float z = 2.0f * unit(seed, i, 0) - 1.0f, radius = kernel::sqrt_or_zero(1.0f - z * z);
    float sine, cosine;
    kernel::sin_cos(6.28318531f * unit(seed, i, 1), &sine, &cosine);
    const vec3 ball = kernel::make_vec3(radius * cosine, radius * sine, z);
    bounced.push_back(make_ray(surface.point, kernel::normalize3(kernel::add3(kernel::scale3(surface.normal, 1.0001f), ball)), far_away));
  }
  return bounced;
}

std::vector<TraceRay> shadow_rays(const FlatScene &scene, std::span<const TraceRay> rays, std::span<const kernel::Hit> hits, std::uint32_t seed) {
  std::vector<TraceRay> shadows;
  const glm::vec3 lower = scene.bounds.lower, extent = scene.bounds.upper - scene.bounds.lower;
  for (std::size_t i = 0; i < rays.size(); i++) {
    if (hits[i].instance == SUN_NONE) continue;
    const Surface surface = surface_of(scene, rays[i], hits[i]);
    const vec3 target = kernel::make_vec3(lower.x + extent.x * (0.4f + 0.2f * unit(seed, i, 0)), lower.y + extent.y * 0.988f,
                                          lower.z + extent.z * (0.4f + 0.2f * unit(seed, i, 1)));
    shadows.push_back(make_ray(surface.point, kernel::sub3(target, surface.point), 0.999f));
  }
  return shadows;
}

kernel::Camera corner_camera(const Bounds &bounds) {
  const glm::vec3 extent = bounds.upper - bounds.lower;
  const vec3 eye = kernel::make_vec3(bounds.lower.x + 0.075f * extent.x, bounds.lower.y + 0.61f * extent.y, bounds.lower.z + 0.075f * extent.z);
  const vec3 target = kernel::make_vec3(bounds.lower.x + 0.575f * extent.x, bounds.lower.y + 0.21f * extent.y, bounds.lower.z + 0.575f * extent.z);
  const vec3 forward = kernel::normalize3(kernel::sub3(target, eye));
  const vec3 right = kernel::normalize3(kernel::cross3(forward, kernel::make_vec3(0.0f, 1.0f, 0.0f)));
  kernel::Camera camera{};
  camera.kind = SUN_CAMERA_PERSPECTIVE;
  store(camera.position, eye);
  store(camera.forward, forward);
  store(camera.right, kernel::scale3(right, 0.65f));
  store(camera.up, kernel::scale3(kernel::cross3(right, forward), 0.65f));
  return camera;
}

}  // namespace sunstone
