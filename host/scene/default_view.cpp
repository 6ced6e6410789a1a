// SPDX-License-Identifier: Apache-2.0
#include "scene/default_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "math/elementary.h"
#include "scene/validate.h"
#include "scene/view_score.h"

namespace sunstone {

namespace {

constexpr float forty_degrees = 0.6981317f;
constexpr float half_view = 0.36397023f;  // tan 20 degrees
constexpr float margin = 1.05f;

// A rigid frame that looks from `from` along -back.
glm::mat4x3 frame(const glm::vec3 &from, const glm::vec3 &back, const glm::vec3 &up) {
  const glm::vec3 right = glm::normalize(glm::cross(up, back));
  return glm::mat4x3(right, glm::cross(back, right), back, from);
}

// Looks at the middle of the bounds from `toward` and stands just so far away that all eight corners are in the picture.
Camera framing(const Bounds &bounds, const glm::vec3 &toward, float aspect) {
  const glm::vec3 middle = 0.5f * bounds.lower + 0.5f * bounds.upper, half = 0.5f * bounds.upper - 0.5f * bounds.lower;
  Camera camera;
  camera.name = "default";
  camera.yfov = forty_degrees;
  camera.transform = frame(middle, toward, {0, 1, 0});
  float distance = 0;
  for (int k = 0; k < 8; k++) {
    const glm::vec3 corner(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z);
    const float x = std::abs(glm::dot(corner, camera.transform[0])), y = std::abs(glm::dot(corner, camera.transform[1]));
    distance = std::max(distance, glm::dot(corner, toward) + margin * std::max(x / (half_view * aspect), y / half_view));
  }
  const float apart = std::max(std::max(std::abs(middle.x), std::abs(middle.y)), std::abs(middle.z)) * 1e-5f;
  distance = std::max(distance, apart > 0 ? apart : 1.0f);  // a single point, too, is looked at from somewhere else
  camera.transform[3] = middle + distance * toward;
  camera.focus_distance = distance;
  return camera;
}

struct Direction {
  float azimuth, elevation;  // degrees, from +z towards +x, and up
  double weight;             // of two views that show about the same, the one that people expect
};

// Three-quarter views all round, thirty degrees off the axes and twenty up; straight on; and from above. Things face +z in glTF, and are
// shown from there or from the right of it unless another side shows half as much again: a box that is open at the back.
std::vector<Direction> directions() {
  std::vector<Direction> list;
  const auto add = [&](float azimuth, float elevation, double weight) {
    const float turned = azimuth > 180 ? 360 - azimuth : azimuth;
    list.push_back({azimuth, elevation, weight - (turned > 90 ? 0.35 : 0.1) * turned / 180});
  };
  for (const float azimuth : {30.0f, 330.0f, 60.0f, 300.0f, 120.0f, 240.0f, 150.0f, 210.0f}) add(azimuth, 20, 1.02);
  for (int i = 0; i < 8; i++) add(45 * static_cast<float>(i), 0, 0.98);
  for (int i = 0; i < 4; i++) add(45 + 90 * static_cast<float>(i), 50, 0.9);
  return list;
}

glm::vec3 direction_vector(const Direction &d) {
  constexpr float degree = 0.0174532924f;
  float sin_azimuth, cos_azimuth, sin_elevation, cos_elevation;
  kernel::sin_cos(d.azimuth * degree, &sin_azimuth, &cos_azimuth);
  kernel::sin_cos(d.elevation * degree, &sin_elevation, &cos_elevation);
  return glm::normalize(glm::vec3(cos_elevation * sin_azimuth, sin_elevation, cos_elevation * cos_azimuth));
}

bool lit(const glm::vec3 &color) { return color.x > 0 || color.y > 0 || color.z > 0; }

// Whether anything in the scene gives light: an environment, a light, or a surface that some instance has.
bool emits(const Scene &scene) {
  if (scene.environment.kind != Environment::Kind::none) return true;  // a black one, too, is somebody's choice
  if (std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light &light) { return lit(light.intensity); })) return true;
  for (const Instance &instance : scene.instances)
    for (const Primitive &p : scene.meshes[instance.mesh].primitives)
      if (p.material >= 0 && lit(scene.materials[p.material].emission)) return true;
  for (const Shape &shape : scene.shapes)
    if (shape.material >= 0 && lit(scene.materials[shape.material].emission)) return true;
  return false;
}

}  // namespace

Camera default_camera(const Scene &scene, float aspect) {
  const Bounds bounds = scene_bounds(scene);
  if (bounds.empty()) {
    Camera camera = look_camera({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, forty_degrees);
    camera.name = "default";
    return camera;
  }
  ViewSample sample(scene, bounds);
  Camera best;
  double best_score = -1;
  for (const Direction &direction : directions()) {
    const Camera camera = framing(bounds, direction_vector(direction), aspect);
    const double score = sample.score(camera, aspect) * direction.weight;
    if (score > best_score * (1 + 1e-6)) {
      best_score = score;
      best = camera;
    }
  }
  return best;
}

Camera look_camera(glm::vec3 from, glm::vec3 at, glm::vec3 up, float yfov) {
  const glm::dvec3 back = glm::dvec3(from) - glm::dvec3(at);
  const double distance = glm::length(back);
  if (!std::isfinite(distance) || !(distance > 0)) throw UsageError("--look-from, --look-at", "are the same point, or not finite");
  const double across = glm::length(glm::cross(glm::dvec3(up), back)) / distance;
  if (!(across > 1e-6 * glm::length(glm::dvec3(up)))) throw UsageError("--up", "is parallel to the direction of view", "choose the other axis");
  Camera camera;
  camera.name = "look";
  camera.yfov = yfov;
  camera.transform = frame(from, glm::vec3(back / distance), up);
  camera.focus_distance = static_cast<float>(distance);
  return camera;
}

// The overcast sky of the CIE [Moon42], L = (1 + 2 sin elevation) / 3 of the zenith's, over a ground of 1/5. A sky that is the same all around would
// be a white furnace: white objects could not be seen in it.
static Environment soft_sky() {
  constexpr int width = 4, height = 64;
  std::vector<float> pixels;
  for (int y = 0; y < height; y++) {
    float sine, cosine;
    kernel::sin_cos((static_cast<float>(y) + 0.5f) / height * SUN_PI, &sine, &cosine);  // of the angle from the zenith
    const float radiance = y < height / 2 ? (1.0f + 2.0f * cosine) / 3.0f : 0.2f;
    pixels.insert(pixels.end(), width * 3, radiance);
  }
  Environment sky;
  sky.kind = Environment::Kind::map;
  sky.map = std::make_shared<const Image>(Image{"soft sky", width, height, 3, std::move(pixels)});
  return sky;
}

void add_defaults(Scene &scene, float aspect, const std::string &file, bool camera_wanted, Notices &notices) {
  if (!emits(scene)) {
    scene.environment = soft_sky();
    notices.note(file, !scene.lights.empty()
                           ? "its lights are all black; lit by a soft sky (CIE overcast, radiance 1 at the zenith)"
                           : "has no light, no emissive surface and no environment; lit by a soft sky (CIE overcast, radiance 1 at the zenith)");
  }
  if (camera_wanted && scene.cameras.empty()) {
    const Camera camera = default_camera(scene, aspect);
    const glm::vec3 from = camera.transform[3];
    char text[120];
    std::snprintf(text, sizeof text, "has no camera; seen from (%.4g, %.4g, %.4g)", double(from.x), double(from.y), double(from.z));
    notices.note(file, text);
    scene.cameras.push_back(camera);
  }
}

}  // namespace sunstone
