// SPDX-License-Identifier: Apache-2.0
#include "support/scenes.h"

#include <cmath>

#include "scene/default_view.h"

namespace sunstone::test {

Material matt(glm::vec3 albedo) {
  Material m;
  m.name = "matt";
  m.base_color = albedo;
  m.f0 = glm::vec3(0);
  m.f90 = 0;
  m.double_sided = true;
  return m;
}

Material lamp(glm::vec3 radiance) {
  Material m = matt(glm::vec3(0));
  m.name = "lamp";
  m.emission = radiance;
  m.double_sided = false;
  return m;
}

Material metal(glm::vec3 color, float roughness) {
  Material m;
  m.name = "metal";
  m.base_color = color;
  m.metallic = 1;
  m.roughness = roughness;
  m.double_sided = true;
  return m;
}

Material glass(glm::vec3 absorption, float roughness) {
  Material m;
  m.name = "glass";
  m.roughness = roughness;
  m.transmission = 1;
  m.volume = true;
  m.absorption = absorption;
  return m;
}

Material thin_glass(glm::vec3 color, float roughness) {
  Material m;
  m.name = "thin glass";
  m.base_color = color;
  m.roughness = roughness;
  m.transmission = 1;
  m.double_sided = true;
  return m;
}

Primitive quad(glm::vec3 center, glm::vec3 right, glm::vec3 up) {
  Primitive p;
  p.positions = {center - right - up, center + right - up, center + right + up, center - right + up};
  p.normals.assign(4, glm::normalize(glm::cross(right, up)));
  p.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.indices = {0, 1, 2, 0, 2, 3};
  return p;
}

Primitive box(glm::vec3 lower, glm::vec3 upper, bool inward) {
  Primitive all;
  const glm::vec3 center = (lower + upper) * 0.5f, half = (upper - lower) * 0.5f;
  for (int axis = 0; axis < 3; axis++)
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 out(0), a(0), b(0);
      out[axis] = side * half[axis];
      a[(axis + 1) % 3] = half[(axis + 1) % 3];
      b[(axis + 2) % 3] = half[(axis + 2) % 3];
      const bool turn = (side < 0) != inward;  // cross(a, b) points to +axis
      const Primitive face = quad(center + out, turn ? b : a, turn ? a : b);
      const auto first = static_cast<std::uint32_t>(all.positions.size());
      all.positions.insert(all.positions.end(), face.positions.begin(), face.positions.end());
      all.normals.insert(all.normals.end(), face.normals.begin(), face.normals.end());
      all.uv[0].insert(all.uv[0].end(), face.uv[0].begin(), face.uv[0].end());
      for (const std::uint32_t i : face.indices) all.indices.push_back(first + i);
    }
  return all;
}

Primitive sphere(glm::vec3 center, float radius, int rings) {
  Primitive p;
  const int segments = 2 * rings;
  for (int ring = 0; ring <= rings; ring++)
    for (int segment = 0; segment <= segments; segment++) {
      const double v = double(ring) / rings, u = double(segment) / segments;
      const double theta = v * M_PI, phi = u * 2 * M_PI;
      const glm::vec3 n(glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)));
      p.positions.push_back(center + radius * n);
      p.normals.push_back(glm::normalize(n));
      p.uv[0].push_back(glm::vec2(float(u), float(v)));
    }
  const auto at = [&](int ring, int segment) { return static_cast<std::uint32_t>(ring * (segments + 1) + segment); };
  for (int ring = 0; ring < rings; ring++)
    for (int segment = 0; segment < segments; segment++) {
      if (ring > 0) p.indices.insert(p.indices.end(), {at(ring, segment), at(ring + 1, segment), at(ring, segment + 1)});
      if (ring + 1 < rings) p.indices.insert(p.indices.end(), {at(ring, segment + 1), at(ring + 1, segment), at(ring + 1, segment + 1)});
    }
  return p;
}

int add(Scene &scene, Primitive primitive, const Material &material, const glm::mat4x3 &transform) {
  primitive.material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(material);
  Mesh mesh;
  mesh.name = material.name;
  mesh.primitives.push_back(std::move(primitive));
  scene.meshes.push_back(std::move(mesh));
  const int number = static_cast<int>(scene.meshes.size()) - 1;
  place(scene, number, transform);
  return number;
}

void place(Scene &scene, int mesh, const glm::mat4x3 &transform) {
  Instance instance;
  instance.name = "node";
  instance.mesh = mesh;
  instance.transform = transform;
  scene.instances.push_back(instance);
}

void add_shape(Scene &scene, Shape::Kind kind, const Material &material, const glm::mat4x3 &transform) {
  scene.materials.push_back(material);
  scene.shapes.push_back({kind, "shape", static_cast<int>(scene.materials.size()) - 1, transform});
}

void add_point_light(Scene &scene, glm::vec3 position, glm::vec3 intensity) {
  Light light;
  light.position = position;
  light.intensity = intensity;
  scene.lights.push_back(light);
}

Light spot_light(glm::vec3 position) {
  Light spot;
  spot.kind = Light::Kind::spot;
  spot.position = position;
  spot.direction = glm::normalize(glm::vec3(-0.5f, -0.7f, -0.6f));
  spot.intensity = {6, 7, 8};
  spot.inner_angle = 0.3f;
  spot.outer_angle = 0.6f;
  return spot;
}

Light sun_light() {
  Light sun;
  sun.kind = Light::Kind::directional;
  sun.direction = glm::normalize(glm::vec3(-0.3f, -1, -0.4f));
  sun.intensity = {1.0f, 0.9f, 0.8f};
  return sun;
}

void add_camera(Scene &scene, glm::vec3 from, glm::vec3 at, float yfov_degrees) {
  const glm::vec3 along = glm::normalize(at - from);
  const glm::vec3 up = std::abs(along.y) > 0.99f ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
  scene.cameras.push_back(look_camera(from, at, up, glm::radians(yfov_degrees)));
}

void add_flat_camera(Scene &scene, glm::vec3 from, float half_height) {
  Camera camera;
  camera.name = "flat";
  camera.orthographic = true;
  camera.half_height = camera.half_width = half_height;
  camera.transform[3] = from;
  scene.cameras.push_back(camera);
}

void set_sky(Scene &scene, glm::vec3 radiance) {
  scene.environment.kind = Environment::Kind::constant;
  scene.environment.constant = radiance;
}

void set_sky_map(Scene &scene, Image map) {
  scene.environment.kind = Environment::Kind::map;
  scene.environment.map = std::make_shared<const Image>(std::move(map));
}

glm::mat4x3 scaled(glm::vec3 scale, glm::vec3 offset) {
  glm::mat4x3 m(0);
  for (int c = 0; c < 3; c++) m[c][c] = scale[c];
  m[3] = offset;
  return m;
}

Image pattern(int width, int height, int channels, std::uint32_t seed) {
  Image image;
  image.name = "pattern";
  image.width = width;
  image.height = height;
  image.channels = channels;
  std::vector<std::uint8_t> bytes;
  std::uint32_t state = seed * 2654435761u + 1;
  for (int i = 0; i < width * height * channels; i++) {
    state = state * 747796405u + 2891336453u;
    bytes.push_back(static_cast<std::uint8_t>(64 + (state >> 24) * 3 / 4));
  }
  image.pixels = std::move(bytes);
  return image;
}

Image bumps(int width, int height) {
  Image image;
  image.name = "bumps";
  image.width = width;
  image.height = height;
  image.channels = 3;
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const int slope = (x + y) % 3 - 1;
      bytes.push_back(static_cast<std::uint8_t>(128 + 60 * slope));
      bytes.push_back(static_cast<std::uint8_t>(128 - 40 * slope));
      bytes.push_back(230);
    }
  image.pixels = std::move(bytes);
  return image;
}

Image sky_map(int width, int height, glm::vec3 sun) {
  Image image;
  image.name = "sky";
  image.width = width;
  image.height = height;
  image.channels = 3;
  std::vector<float> values;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      const bool bright = y == height / 4 && (x == width / 3 || x == width / 3 + 1);
      const float up = 1.0f - static_cast<float>(y) / static_cast<float>(height);
      const glm::vec3 value = bright ? sun : glm::vec3(0.2f + 0.3f * up, 0.25f + 0.4f * up, 0.3f + 0.6f * up);
      for (int c = 0; c < 3; c++) values.push_back(value[c]);
    }
  image.pixels = std::move(values);
  return image;
}

TextureUse use_picture(Scene &scene, Image image, bool linear) {
  scene.images.push_back(std::move(image));
  Texture texture;
  texture.image = static_cast<int>(scene.images.size()) - 1;
  texture.linear = linear;
  scene.textures.push_back(texture);
  TextureUse use;
  use.texture = static_cast<int>(scene.textures.size()) - 1;
  return use;
}

Scene room_of_one_side() {
  Scene scene;
  Material wall = matt({0.7f, 0.6f, 0.5f});
  wall.double_sided = false;
  add(scene, box({-1, 0, -1}, {1, 1.6f, 1}, true), wall);
  add(scene, quad({0, 1.3f, 0}, {0.4f, 0, 0}, {0, 0, 0.4f}), lamp({5, 6, 7}));
  add(scene, quad({0, -0.01f, 1.5f}, {2, 0, 0}, {0, 0, -3}), matt({0.6f, 0.6f, 0.7f}));
  return scene;
}

Scene matt_room() {
  Scene scene;
  add(scene, box({-1, 0, -1}, {1, 1.6f, 1}, true), matt({0.7f, 0.6f, 0.5f}));
  add(scene, quad({0, 1.5f, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}), lamp({3, 4, 5}));
  add(scene, box({-0.5f, 0.01f, -0.6f}, {0, 0.5f, -0.1f}), matt({0.4f, 0.6f, 0.8f}));
  add_camera(scene, {0, 0.8f, 0.95f}, {0, 0.6f, 0}, 70);
  return scene;
}

Scene everything() {
  Scene scene;
  scene.name = "everything";

  Material floor = matt(glm::vec3(0.9f));
  floor.f0 = glm::vec3(0.04f);
  floor.f90 = 1;
  floor.roughness = 0.4f;
  floor.base_color_texture = use_picture(scene, pattern(8, 8, 3, 1));
  floor.base_color_texture.transform = glm::mat3x2(3, 0, 0, 3, 0, 0);
  floor.metallic_roughness_texture = use_picture(scene, pattern(4, 4, 3, 2), false);
  floor.normal_texture = use_picture(scene, bumps(16, 16));
  add(scene, quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}), floor);

  add(scene, sphere({-1.2f, 0.5f, 0.2f}, 0.5f, 12), glass({0.2f, 1.5f, 2.5f}));
  add(scene, sphere({-0.3f, 0.35f, 1.1f}, 0.35f, 10), glass({1.0f, 0.3f, 0.1f}, 0.3f));
  add(scene, quad({1.1f, 0.7f, 0.9f}, {0.5f, 0, 0.2f}, {0, 0.6f, 0}), thin_glass({0.6f, 0.9f, 0.7f}));
  add(scene, quad({0.2f, 0.6f, -0.9f}, {0.6f, 0, 0.1f}, {0, 0.6f, 0}), thin_glass({0.9f, 0.9f, 0.9f}, 0.35f));

  Material cut = matt({0.8f, 0.3f, 0.2f});
  cut.alpha_mode = AlphaMode::mask;
  cut.base_color_texture = use_picture(scene, pattern(8, 8, 4, 3), false);
  cut.alpha_cutoff = 0.55f;
  add(scene, quad({0.3f, 0.5f, 0.6f}, {0.4f, 0, 0}, {0, 0.5f, 0}), cut);
  Material veil = matt({0.3f, 0.5f, 0.9f});
  veil.alpha_mode = AlphaMode::blend;
  veil.alpha = 0.45f;
  add(scene, quad({-0.6f, 0.6f, 1.6f}, {0.5f, 0, 0}, {0, 0.4f, 0}), veil);

  // A mesh that is used often is an instance; one of them mirrored.
  const int gem = add(scene, sphere({0, 0, 0}, 0.2f, 8), metal({0.95f, 0.7f, 0.4f}, 0.25f), scaled({1, 1, 1}, {1.3f, 0.2f, -0.3f}));
  place(scene, gem, scaled({-1.5f, 1, 1}, {0.7f, 0.22f, 1.5f}));
  place(scene, gem, scaled({1, 2, 0.7f}, {1.8f, 0.4f, 0.4f}));
  Primitive crowd = sphere({0, 0, 0}, 0.1f, 40);
  const int many = add(scene, crowd, matt({0.2f, 0.7f, 0.3f}), scaled({1, 1, 1}, {-1.8f, 0.1f, 1.0f}));
  place(scene, many, scaled({-1, 1.5f, 1}, {-1.9f, 0.15f, 1.5f}));
  place(scene, many, scaled({2, 2, 2}, {-2.0f, 0.2f, -0.5f}));

  Material panel = lamp({6, 5, 4});
  panel.emission_texture = use_picture(scene, pattern(4, 4, 3, 5));
  add(scene, quad({0, 2.6f, 0}, {0.6f, 0, 0}, {0, 0, 0.6f}), panel);
  add_point_light(scene, {-2, 2, 2}, {1.5f, 1.2f, 1.0f});
  Light spot;
  spot.kind = Light::Kind::spot;
  spot.position = {2, 2.5f, 2};
  spot.direction = glm::normalize(glm::vec3(-0.5f, -0.7f, -0.5f));
  spot.intensity = {3, 4, 6};
  spot.inner_angle = 0.2f;
  spot.outer_angle = 0.5f;
  scene.lights.push_back(spot);
  Light sun;
  sun.kind = Light::Kind::directional;
  sun.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  sun.intensity = glm::vec3(0.3f);
  scene.lights.push_back(sun);
  set_sky_map(scene, sky_map(16, 8, {20, 18, 15}));
  add_camera(scene, {0.3f, 1.3f, 4.6f}, {0, 0.6f, 0}, 38);
  return scene;
}

std::filesystem::path scene_file(const std::string &name) { return std::filesystem::path(SUNSTONE_SOURCE_DIR) / "scenes" / name; }

}  // namespace sunstone::test
