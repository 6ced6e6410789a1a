// SPDX-License-Identifier: Apache-2.0
#include "cli/verify_scene.h"

namespace sunstone {

namespace {

// A parallelogram from `corner` along `u` and `v`, its front where u x v points, with texture coordinates.
Primitive quad(glm::vec3 corner, glm::vec3 u, glm::vec3 v, int material) {
  Primitive p;
  p.material = material;
  p.positions = {corner, corner + u, corner + u + v, corner + v};
  p.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.indices = {0, 1, 2, 0, 2, 3};
  return p;
}

// An octahedron subdivided twice: enough to have a tree, and curved normals.
Primitive ball(int material) {
  Primitive p;
  p.material = material;
  const glm::vec3 axis[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const int face[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  constexpr int steps = 4;
  for (const auto &f : face)
    for (int i = 0; i < steps; i++)
      for (int j = 0; j < steps - i; j++)
        for (int half = 0; half < (j < steps - i - 1 ? 2 : 1); half++) {
          const int a[2][3][2] = {{{i, j}, {i + 1, j}, {i, j + 1}}, {{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
          for (const auto &corner : a[half]) {
            const float x = static_cast<float>(corner[0]) / steps, y = static_cast<float>(corner[1]) / steps;
            const glm::vec3 d = axis[f[0]] * (1 - x - y) + axis[f[1]] * x + axis[f[2]] * y;
            const float length = __builtin_sqrtf(d.x * d.x + d.y * d.y + d.z * d.z);
            p.normals.push_back(d / length);
            p.positions.push_back(d / length);
            p.indices.push_back(static_cast<std::uint32_t>(p.indices.size()));
          }
        }
  return p;
}

Image checker(int size, bool alpha) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < size; y++)
    for (int x = 0; x < size; x++) {
      const bool on = (x + y) % 2 != 0;
      const int shade = (x * 37 + y * 91) % 64;
      for (int c = 0; c < 3; c++) pixels.push_back(static_cast<std::uint8_t>((on ? 180 : 40) + (c == 1 ? shade : shade / 2)));
      if (alpha) pixels.push_back(static_cast<std::uint8_t>(on ? 255 : 64 + shade));
    }
  return {alpha ? "leaf" : "checker", size, size, alpha ? 4 : 3, std::move(pixels)};
}

// Adds a material that is double-sided, and what `set` makes of it.
template <class Set> int add_material(Scene &s, Set &&set) {
  Material m;
  m.double_sided = true;
  set(m);
  s.materials.push_back(m);
  return static_cast<int>(s.materials.size() - 1);
}

Light point_light() {
  Light light;
  light.position = {2, 2, 1};
  light.intensity = {2, 2, 3};
  return light;
}

Light spot_light() {
  Light light;
  light.kind = Light::Kind::spot;
  light.position = {-2, 3, 2};
  light.direction = {0.48f, -0.8f, -0.36f};
  light.intensity = {12, 6, 6};
  light.inner_angle = 0.2f;
  light.outer_angle = 0.4f;
  return light;
}

}  // namespace

Scene make_verify_scene(bool punctual) {
  Scene s;
  s.name = "verify";
  s.images = {checker(8, false), checker(8, true)};
  s.textures = {{0, Wrap::repeat, Wrap::mirror, true}, {1, Wrap::clamp, Wrap::repeat, false}};
  const auto material = [&](auto &&set) { return add_material(s, set); };
  const int floor = material([](Material &m) { m.base_color_texture.texture = 0, m.base_color_texture.transform = {3, 0, 0, 3, 0.25f, 0}, m.roughness = 0.6f; });
  const int wall = material([](Material &m) { m.base_color = {0.7f, 0.5f, 0.4f}, m.f0 = glm::vec3(0), m.f90 = 0; });
  const int glass = material([](Material &m) { m.transmission = 1, m.volume = true, m.roughness = 0, m.ior = 1.5f, m.absorption = {0.2f, 1.5f, 0.6f}; });
  const int frosted = material([](Material &m) { m.transmission = 1, m.volume = true, m.roughness = 0.5f, m.ior = 1.4f; });
  const int metal = material([](Material &m) { m.metallic = 1, m.roughness = 0.35f, m.base_color = {0.95f, 0.7f, 0.3f}; });
  const int mirror = material([](Material &m) { m.metallic = 1, m.roughness = 0, m.base_color = glm::vec3(0.9f); });
  const int leaf = material([](Material &m) { m.base_color_texture.texture = 1, m.alpha_mode = AlphaMode::blend; });
  const int pane = material([](Material &m) { m.transmission = 0.9f, m.roughness = 0, m.base_color = {0.6f, 0.8f, 1.0f}; });
  const int lamp = material([](Material &m) { m.base_color = glm::vec3(0), m.emission = {9, 8, 6}, m.double_sided = false; });
  Mesh room{"room", {quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, floor), quad({-3, 0, -3}, {6, 0, 0}, {0, 4, 0}, wall), quad({-0.7f, 3.6f, -0.6f}, {1.4f, 0, 0}, {0, 0, 1.2f}, lamp),
                     quad({-2.6f, 0.1f, 0.8f}, {1.2f, 0, 0.3f}, {0, 1.6f, 0}, leaf), quad({1.2f, 0.1f, 1.4f}, {1.4f, 0, -0.4f}, {0, 1.5f, 0}, pane)}};
  s.meshes.push_back(room);
  s.instances.push_back({"room", 0, glm::mat4x3(1)});
  const int kinds[] = {glass, frosted, metal, mirror};
  for (int k = 0; k < 4; k++) {
    s.meshes.push_back({"ball", {ball(kinds[k])}});
    // Each ball twice, once mirrored and squeezed. More than the limit of baking would need thousands: these are baked and instanced as flatten decides.
    for (int i = 0; i < 2; i++) {
      glm::mat4x3 m(1);
      const float r = i ? 0.3f : 0.5f;
      m[0] = {i ? -r : r, 0, 0};
      m[1] = {0, r, 0.1f * r};
      m[2] = {0, 0, r};
      m[3] = {-1.8f + 1.2f * static_cast<float>(k), i ? 1.5f : 0.55f, i ? -1.2f : -0.2f};
      s.instances.push_back({"ball", k + 1, m});
    }
  }
  // A mesh of many instances, which stays one.
  s.meshes.push_back({"bead", {ball(metal)}});
  for (int i = 0; i < 40; i++) {
    glm::mat4x3 m(0.08f);
    m[3] = {-2.4f + 0.12f * static_cast<float>(i), 0.08f, 1.9f + (i % 2 ? 0.1f : 0.0f)};
    s.instances.push_back({"bead", 5, m});
  }
  std::vector<float> sky;
  for (int y = 0; y < 8; y++)
    for (int x = 0; x < 16; x++) {
      const float bright = x == 3 && y == 1 ? 60.0f : 0.05f * static_cast<float>(8 - y);
      sky.insert(sky.end(), {bright, bright * 0.9f, bright * 1.1f});
    }
  s.environment.kind = Environment::Kind::map;
  s.environment.map = std::make_shared<const Image>(Image{"sky", 16, 8, 3, std::move(sky)});
  s.environment.rotation = 0.1f;
  if (punctual) {
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = {0.6f, -0.8f, 0};
    sun.intensity = {0.5f, 0.5f, 0.4f};
    s.lights = {point_light(), spot_light(), sun};
  }
  Camera camera;
  camera.transform[3] = {0.2f, 1.7f, 6};
  camera.lens_radius = 0.02f;
  camera.focus_distance = 6;
  s.cameras.push_back(camera);
  return s;
}

Scene make_verify_shapes() {
  Scene s;
  s.name = "verify shapes";
  s.images = {checker(8, false)};
  s.textures = {{0, Wrap::repeat, Wrap::mirror, false}};
  const int floor = add_material(s, [](Material &m) { m.base_color_texture.texture = 0, m.base_color_texture.transform = {3, 0, 0, 3, 0.25f, 0}, m.f0 = glm::vec3(0), m.f90 = 0; });
  const int ground = add_material(s, [](Material &m) { m.base_color = {0.3f, 0.4f, 0.2f}, m.f0 = glm::vec3(0), m.f90 = 0; });
  const int glass = add_material(s, [](Material &m) { m.transmission = 1, m.volume = true, m.roughness = 0, m.ior = 1.5f, m.absorption = {0.2f, 1.5f, 0.6f}; });
  const int gloss = add_material(s, [](Material &m) { m.base_color = {0.7f, 0.2f, 0.1f}, m.roughness = 0; });
  const int metal = add_material(s, [](Material &m) { m.metallic = 1, m.roughness = 0.35f, m.base_color = {0.95f, 0.7f, 0.3f}; });
  const int lamp = add_material(s, [](Material &m) { m.base_color = glm::vec3(0), m.emission = {3, 2.5f, 2}, m.double_sided = false; });
  const auto shape = [&](Shape::Kind kind, int material, const glm::mat4x3 &transform) { s.shapes.push_back({kind, "", material, transform}); };
  shape(Shape::Kind::quad, floor, {{3, 0, 0}, {0, 1, 0}, {0, 0, 3}, {0, 0, 0}});
  shape(Shape::Kind::plane, ground, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -0.5f, 0}});
  shape(Shape::Kind::sphere, glass, {{0.8f, 0, 0}, {0, 0.8f, 0}, {0, 0, 0.8f}, {-1.2f, 0.85f, 1}});
  shape(Shape::Kind::sphere, gloss, {{0.7f, 0, 0}, {0, 0.7f, 0}, {0, 0, 0.7f}, {1, 0.7f, -0.5f}});
  shape(Shape::Kind::sphere, metal, {{-0.6f, 0.1f, 0}, {0, 0.4f, 0.2f}, {0.1f, 0, 0.5f}, {1.4f, 0.5f, 1.6f}});  // sheared, and its own mirror image
  shape(Shape::Kind::disk, lamp, {{0.6f, 0.2f, 0}, {0.2f, -0.6f, 0.1f}, {0, 0.1f, 0.6f}, {0, 2.8f, -1}});
  s.environment.kind = Environment::Kind::constant;
  s.environment.constant = {0.2f, 0.3f, 0.5f};
  s.lights = {point_light(), spot_light()};
  Camera camera;
  camera.transform[3] = {0.2f, 1.4f, 6};
  s.cameras.push_back(camera);
  return s;
}

}  // namespace sunstone
