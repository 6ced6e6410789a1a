// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/error.h"
#include "shared/motion.h"

namespace sunstone {

namespace {

constexpr float largest_coordinate = 1e18f;  // its square still fits a float
constexpr float largest_uv = 1e6f;           // beyond it, a float no longer says where in the picture
constexpr float largest_radiance = 1e18f;

std::string item(const char *list, std::size_t index, const std::string &name = {}) {
  return std::string(list) + "[" + std::to_string(index) + "]" + (name.empty() ? "" : " \"" + printable(name, 60) + "\"");
}

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", static_cast<double>(value));
  return text;
}

bool usable(const glm::vec3 &p) {
  return std::abs(p.x) <= largest_coordinate && std::abs(p.y) <= largest_coordinate && std::abs(p.z) <= largest_coordinate;  // false for NaN too
}

bool finite(const glm::mat4x3 &m) {
  for (int c = 0; c < 4; c++)
    if (!usable(m[c])) return false;
  return true;
}

// Whether the transform flattens space. Skew is measured against the columns' lengths, so that a uniform scale of any size is none of it.
bool singular(const glm::mat4x3 &m) {
  const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
  const double determinant = std::abs(glm::dot(glm::cross(x, y), z));
  return !(determinant > 1e-12 * glm::length(x) * glm::length(y) * glm::length(z)) || !(determinant > 1e-36);
}

// Shapes are kept to sizes whose areas, squared, are floats.
bool fits_shape(const glm::mat4x3 &m) {
  if (!finite(m) || singular(m)) return false;
  for (int axis = 0; axis < 3; axis++) {
    const double length = glm::length(glm::dvec3(m[axis]));
    if (!(length >= 1e-9 && length <= 1e9)) return false;
  }
  return true;
}

// The same fault in many places makes one line: how often, where first.
class Tally {
 public:
  void add(const std::string &what, const std::string &where) {
    Entry &entry = entries_[what];
    if (entry.count++ == 0) entry.first = where;
  }
  void report(const std::string &file, Notices &notices) const {
    for (const auto &[what, entry] : entries_)
      notices.warning(file, entry.first + ": " + what + (entry.count > 1 ? " (and " + std::to_string(entry.count - 1) + " more like it)" : ""));
  }

 private:
  struct Entry {
    std::size_t count = 0;
    std::string first;
  };
  std::map<std::string, Entry> entries_;
};

class Validator {
 public:
  Validator(Scene &scene, const std::string &file, Notices &notices) : scene_(scene), file_(file), notices_(notices) {}

  void run() {
    if (scene_.motion_steps > SUN_MOST_MOTION_STEPS || (scene_.motion_steps & (scene_.motion_steps - 1))) fail("motion", std::to_string(scene_.motion_steps) + " steps of the shutter's time");
    images();
    materials();
    meshes();
    instances();
    shapes();
    lights();
    cameras();
    environment();
    tally_.report(file_, notices_);
  }

 private:
  [[noreturn]] void fail(const std::string &where, const std::string &reason) const { throw Error(file_ + ": " + where, reason); }

  void index(long long value, std::size_t count, bool may_be_none, const std::string &where, const char *what) const {
    if (value == -1 && may_be_none) return;
    if (value < 0 || value >= static_cast<long long>(count))
      fail(where, std::string(what) + ": index " + std::to_string(value) + ", but there are " + std::to_string(count));
  }

  void clamp(float &value, float lower, float upper, float fallback, const char *what, const std::string &where) {
    if (value >= lower && value <= upper) return;
    const float taken = std::isnan(value) ? fallback : std::clamp(value, lower, upper);
    tally_.add(std::string(what) + " is out of range and was taken as " + number(taken), where);
    value = taken;
  }
  void clamp(glm::vec3 &value, float lower, float upper, float fallback, const char *what, const std::string &where) {
    for (int i = 0; i < 3; i++) clamp(value[i], lower, upper, fallback, what, where);
  }

  void images() {
    for (std::size_t i = 0; i < scene_.images.size(); i++) {
      const Image &image = scene_.images[i];
      const std::size_t values = std::visit([](const auto &pixels) { return pixels.size(); }, image.pixels);
      if (image.width <= 0 || image.height <= 0 || image.channels < 1 || image.channels > 4 ||
          std::int64_t(image.width) > max_image_pixels / image.height || values != std::size_t(image.width) * image.height * image.channels)
        fail(item("images", i, image.name), "its size and its pixels do not agree");
    }
    for (std::size_t i = 0; i < scene_.textures.size(); i++)
      index(scene_.textures[i].image, scene_.images.size(), true, item("textures", i), "image");
  }

  void texture_use(TextureUse &use, const std::string &where, const char *what) {
    index(use.texture, scene_.textures.size(), true, where, what);
    if (use.uv_set < 0 || use.uv_set > 1)
      fail(where, std::string(what) + ": texture coordinate set " + std::to_string(use.uv_set) + "; 0 and 1 are there");
    for (int c = 0; c < 3; c++)
      for (int r = 0; r < 2; r++)
        if (!(std::abs(use.transform[c][r]) <= largest_uv)) {
          tally_.add(std::string(what) + " has a texture transform that is out of range and was ignored", where);
          use.transform = TextureUse{}.transform;
        }
  }

  void materials() {
    for (std::size_t i = 0; i < scene_.materials.size(); i++) {
      Material &m = scene_.materials[i];
      const std::string where = item("materials", i, m.name);
      clamp(m.base_color, 0, 1, 0.5f, "the base colour", where);
      clamp(m.alpha, 0, 1, 1, "alpha", where);
      clamp(m.alpha_cutoff, 0, largest_radiance, 0.5f, "the alpha cutoff", where);
      clamp(m.metallic, 0, 1, 0, "metallic", where);
      clamp(m.roughness, 0, 1, 1, "roughness", where);
      clamp(m.ior, 1, 100, 1.5f, "the index of refraction", where);
      clamp(m.f0, 0, 1, 0.04f, "the specular colour", where);
      clamp(m.f90, 0, 1, 1, "the specular strength", where);
      clamp(m.transmission, 0, 1, 0, "transmission", where);
      clamp(m.absorption, 0, largest_radiance, 0, "absorption", where);
      clamp(m.emission, 0, largest_radiance, 0, "emission", where);
      clamp(m.normal_scale, -1000, 1000, 1, "the normal scale", where);
      texture_use(m.base_color_texture, where, "base_color_texture");
      texture_use(m.metallic_roughness_texture, where, "metallic_roughness_texture");
      texture_use(m.normal_texture, where, "normal_texture");
      texture_use(m.emission_texture, where, "emission_texture");
      texture_use(m.transmission_texture, where, "transmission_texture");
      texture_use(m.specular_texture, where, "specular_texture");
      texture_use(m.specular_color_texture, where, "specular_color_texture");
      texture_use(m.alpha_texture, where, "alpha_texture");
    }
  }

  void meshes() {
    std::size_t dropped = 0, total = 0;
    std::string first;
    std::vector<int> kept(scene_.meshes.size(), -1);
    std::vector<Mesh> meshes;
    for (std::size_t i = 0; i < scene_.meshes.size(); i++) {
      Mesh &mesh = scene_.meshes[i];
      for (std::size_t k = 0; k < mesh.primitives.size(); k++) {
        const std::string where = item("meshes", i, mesh.name) + "." + item("primitives", k);
        total += mesh.primitives[k].indices.size() / 3;
        const std::size_t here = primitive(mesh.primitives[k], where);
        if (here && dropped == 0) first = where;
        dropped += here;
      }
      std::erase_if(mesh.primitives, [](const Primitive &p) { return p.indices.empty(); });
      if (mesh.primitives.empty()) continue;
      kept[i] = static_cast<int>(meshes.size());
      meshes.push_back(std::move(mesh));
    }
    if (dropped)
      notices_.warning(file_, first + ": " + std::to_string(dropped) + " of " + std::to_string(total) +
                                  " triangles dropped: a corner is not finite, or further out than 1e18");
    for (std::size_t i = 0; i < scene_.instances.size(); i++) {
      Instance &instance = scene_.instances[i];
      index(instance.mesh, kept.size(), false, item("instances", i, instance.name), "mesh");
      instance.mesh = kept[instance.mesh];
    }
    std::erase_if(scene_.instances, [](const Instance &instance) { return instance.mesh < 0; });
    scene_.meshes = std::move(meshes);
  }

  // Checks one primitive and drops its bad triangles. Returns how many.
  std::size_t primitive(Primitive &p, const std::string &where) {
    index(p.material, scene_.materials.size(), true, where, "material");
    const std::size_t count = p.positions.size();
    const auto length = [&](std::size_t size, const char *what) {
      if (size != 0 && size != count) fail(where, std::to_string(count) + " positions, but " + std::to_string(size) + " " + what);
    };
    length(p.normals.size(), "normals");
    length(p.tangents.size(), "tangents");
    length(p.uv[0].size(), "texture coordinates");
    length(p.uv[1].size(), "texture coordinates of set 1");
    length(p.colors.size(), "colours");
    key_count(p.keys.size(), where);
    for (const PrimitiveKey &key : p.keys)
      if (key.positions.size() != count || key.normals.size() != p.normals.size()) fail(where, "a key of its motion has another number of vertices");
    if (count > 0xffffffffu) fail(where, std::to_string(count) + " vertices are more than 2^32 - 1");
    if (p.indices.size() % 3 != 0) fail(where, std::to_string(p.indices.size()) + " indices are not a multiple of 3");
    for (const std::uint32_t i : p.indices)
      if (i >= count) fail(where, "vertex index " + std::to_string(i) + ", but there are " + std::to_string(count) + " vertices");

    std::size_t out = 0;
    for (std::size_t t = 0; t + 2 < p.indices.size(); t += 3) {
      bool good = true;
      for (int k = 0; k < 3; k++) {
        good = good && usable(p.positions[p.indices[t + k]]);
        for (const PrimitiveKey &key : p.keys) good = good && usable(key.positions[p.indices[t + k]]);
      }
      if (!good) continue;
      for (int k = 0; k < 3; k++) p.indices[out + k] = p.indices[t + k];
      out += 3;
    }
    const std::size_t dropped = (p.indices.size() - out) / 3;
    p.indices.resize(out);
    if (out == 0) return dropped;
    for (glm::vec3 &position : p.positions)
      if (!usable(position)) position = p.positions[p.indices[0]];  // no triangle uses it: anywhere within the bounds
    normals(p.positions, p.indices, p.normals, where);
    for (PrimitiveKey &key : p.keys) {
      for (glm::vec3 &position : key.positions)
        if (!usable(position)) position = key.positions[p.indices[0]];
      normals(key.positions, p.indices, key.normals, where);
    }
    bool good_tangents = unit_tangents(p.tangents);
    for (const PrimitiveKey &key : p.keys) good_tangents = good_tangents && key.tangents.size() == p.tangents.size() && unit_tangents(key.tangents);
    if (!good_tangents) {
      if (!p.tangents.empty()) tally_.add("has tangents that are no unit vectors: they are made anew", where);
      p.tangents.clear();
    }
    for (std::vector<glm::vec2> &set : p.uv)
      for (glm::vec2 &uv : set)
        if (!(std::abs(uv.x) <= largest_uv && std::abs(uv.y) <= largest_uv)) {
          tally_.add("has texture coordinates that are out of range: taken as 0", where);
          uv = glm::vec2(0);
        }
    for (glm::vec4 &color : p.colors)
      for (int c = 0; c < 4; c++)
        if (!(color[c] >= 0 && color[c] <= 1)) {
          tally_.add("has vertex colours out of 0 to 1: clamped", where);
          color[c] = std::isnan(color[c]) ? 1 : std::clamp(color[c], 0.0f, 1.0f);
        }
    return dropped;
  }

  // All that moves has a key at the end of each step.
  void key_count(std::size_t keys, const std::string &where) const {
    if (keys != 0 && keys != scene_.motion_steps) fail(where, std::to_string(keys) + " keys of its motion, but the shutter's time has " + std::to_string(scene_.motion_steps) + " steps");
  }

  static bool unit_tangents(const std::vector<glm::vec4> &tangents) {
    return std::all_of(tangents.begin(), tangents.end(), [](const glm::vec4 &t) {
      const float length2 = t.x * t.x + t.y * t.y + t.z * t.z;
      return length2 > 0.25f && length2 < 4.0f && (t.w == 1 || t.w == -1);
    });
  }

  // Brings normals to unit length; one without a direction takes that of the faces around it.
  void normals(const std::vector<glm::vec3> &positions, const std::vector<std::uint32_t> &indices, std::vector<glm::vec3> &normals, const std::string &where) {
    std::vector<std::size_t> lost;
    for (std::size_t i = 0; i < normals.size(); i++) {
      glm::vec3 &n = normals[i];
      const double length = usable(n) ? std::sqrt(double(n.x) * n.x + double(n.y) * n.y + double(n.z) * n.z) : 0;
      if (!(length > 1e-15))
        lost.push_back(i);
      else if (std::abs(length - 1) > 1e-6)
        n = glm::vec3(glm::dvec3(n) / length);
    }
    if (lost.empty()) return;
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
    for (std::size_t t = 0; t < indices.size(); t += 3) {
      const glm::dvec3 a(positions[indices[t]]), b(positions[indices[t + 1]]), c(positions[indices[t + 2]]);
      const glm::dvec3 area = glm::cross(b - a, c - a);
      for (int k = 0; k < 3; k++) sums[indices[t + k]] += area;
    }
    for (const std::size_t i : lost) {
      const double length = glm::length(sums[i]);
      normals[i] = length > 0 && std::isfinite(length) ? glm::vec3(sums[i] / length) : glm::vec3(0, 1, 0);
    }
    std::vector<bool> used(positions.size());
    for (const std::uint32_t i : indices) used[i] = true;
    if (std::any_of(lost.begin(), lost.end(), [&](std::size_t i) { return used[i]; }))
      tally_.add("has normals of no direction: made from the faces", where);
  }

  void instances() {
    std::size_t bad = 0;
    std::string first;
    const auto too_far = [&](const Instance &instance, const glm::mat4x3 &transform) {
      if (!finite(transform)) return true;
      for (const Primitive &p : scene_.meshes[instance.mesh].primitives) {
        for (const glm::vec3 &position : p.positions)
          if (!usable(transform * glm::vec4(position, 1))) return true;
        for (const PrimitiveKey &key : p.keys)
          for (const glm::vec3 &position : key.positions)
            if (!usable(transform * glm::vec4(position, 1))) return true;
      }
      return false;
    };
    // What moves may vanish for a moment, as it does where it grows from nothing.
    const auto unfit = [&](const Instance &instance) {
      if (too_far(instance, instance.transform)) return true;
      bool vanishes = singular(instance.transform);
      for (const glm::mat4x3 &key : instance.keys) {
        if (too_far(instance, key)) return true;
        vanishes = vanishes && singular(key);
      }
      return vanishes;
    };
    std::vector<Instance> kept;
    for (std::size_t i = 0; i < scene_.instances.size(); i++) {
      Instance &instance = scene_.instances[i];
      key_count(instance.keys.size(), item("instances", i, instance.name));
      const bool identity = instance.transform == glm::mat4x3(1) && instance.keys.empty();
      if (identity || !unfit(instance))
        kept.push_back(std::move(instance));
      else if (bad++ == 0)
        first = item("instances", i, instance.name);
    }
    scene_.instances = std::move(kept);
    if (bad)
      notices_.warning(file_, first + ": dropped, its transform is singular, not finite or leads too far out" +
                                  (bad > 1 ? " (and " + std::to_string(bad - 1) + " more like it)" : ""));
  }

  void shapes() {
    std::size_t bad = 0;
    std::string first;
    std::vector<Shape> kept;
    for (std::size_t i = 0; i < scene_.shapes.size(); i++) {
      Shape &shape = scene_.shapes[i];
      const std::string where = item("shapes", i, shape.name);
      index(shape.material, scene_.materials.size(), true, where, "material");
      key_count(shape.keys.size(), where);
      if (!fits_shape(shape.transform) || !std::all_of(shape.keys.begin(), shape.keys.end(), fits_shape)) {
        if (bad++ == 0) first = where;
        continue;
      }
      if (shape.material >= 0) {
        const Material &m = scene_.materials[shape.material];
        if (shape.kind == Shape::Kind::plane && (m.unlit || m.emission.x > 0 || m.emission.y > 0 || m.emission.z > 0))
          fail(where, "an infinite plane cannot emit light: its power has no end" + std::string(m.unlit ? " (unlit surfaces emit their colour)" : ""));
        if (m.normal_texture) tally_.add("has a normal map, which analytic shapes do not take: ignored", where);
      }
      kept.push_back(std::move(shape));
    }
    scene_.shapes = std::move(kept);
    if (bad)
      notices_.warning(file_, first + ": dropped, its transform is singular, not finite, leads too far out, or makes it smaller than 1e-9 or larger than 1e9 m" +
                                  (bad > 1 ? " (and " + std::to_string(bad - 1) + " more like it)" : ""));
  }

  void lights() {
    for (std::size_t i = 0; i < scene_.lights.size(); i++) {
      Light &light = scene_.lights[i];
      const std::string where = item("lights", i, light.name);
      clamp(light.intensity, 0, largest_radiance, 0, "the intensity", where);
      const auto place = [&](const glm::vec3 &position, glm::vec3 &direction) {
        if (!usable(position)) fail(where, "its position is not finite");
        const double length = usable(direction) ? glm::length(glm::dvec3(direction)) : 0;
        if (!(length > 1e-15)) fail(where, "it shines in no direction");
        if (std::abs(length - 1) > 1e-6) direction = glm::vec3(glm::dvec3(direction) / length);
      };
      place(light.position, light.direction);
      key_count(light.keys.size(), where);
      for (LightKey &key : light.keys) place(key.position, key.direction);
      if (light.kind != Light::Kind::spot) continue;
      clamp(light.outer_angle, 1e-4f, 1.5707964f, 0.7853982f, "the outer angle of the cone", where);
      clamp(light.inner_angle, 0, light.outer_angle, 0, "the inner angle of the cone", where);
    }
  }

  void cameras() {
    for (std::size_t i = 0; i < scene_.cameras.size(); i++) {
      Camera &camera = scene_.cameras[i];
      const std::string where = item("cameras", i, camera.name);
      key_count(camera.keys.size(), where);
      const auto bad = [](const glm::mat4x3 &transform) { return !finite(transform) || singular(transform); };
      if (bad(camera.transform) || std::any_of(camera.keys.begin(), camera.keys.end(), bad)) fail(where, "its transform is singular or not finite");
      if (!camera.orthographic && !(camera.yfov > 0 && camera.yfov < 3.1415925f))
        fail(where, "a vertical angle of " + number(camera.yfov) + " radians");
      if (camera.aspect && !(*camera.aspect > 0 && *camera.aspect < 1e6f)) fail(where, "an aspect ratio of " + number(*camera.aspect));
      if (camera.orthographic &&
          !(camera.half_width > 0 && camera.half_height > 0 && camera.half_width < largest_coordinate && camera.half_height < largest_coordinate))
        fail(where, "a view of " + number(camera.half_width) + " x " + number(camera.half_height));
      clamp(camera.lens_radius, 0, largest_coordinate, 0, "the lens radius", where);
      clamp(camera.focus_distance, 1e-9f, largest_coordinate, 1, "the focus distance", where);
    }
  }

  void environment() {
    Environment &e = scene_.environment;
    clamp(e.constant, 0, largest_radiance, 0, "the radiance", "environment");
    clamp(e.strength, 0, largest_radiance, 1, "the strength", "environment");
    if (!std::isfinite(e.rotation)) fail("environment", "its rotation is not finite");
    if (e.kind != Environment::Kind::map) return;
    if (!e.map || e.map->channels != 3 || !e.map->is_float() || e.map->width <= 0 || e.map->height <= 0 ||
        std::get<std::vector<float>>(e.map->pixels).size() != std::size_t(e.map->width) * e.map->height * 3)
      fail("environment", "its map is not a picture of three floats a pixel");
    for (const float value : std::get<std::vector<float>>(e.map->pixels))
      if (!(value >= 0 && value <= 3.40282347e38f)) fail("environment", "its map holds a value that is negative or not finite");
  }

  Scene &scene_;
  const std::string &file_;
  Notices &notices_;
  Tally tally_;
};

void grow(Bounds &bounds, const glm::vec3 &p) {
  bounds.lower = glm::min(bounds.lower, p);
  bounds.upper = glm::max(bounds.upper, p);
}

Bounds mesh_bounds(const Mesh &mesh) {
  Bounds bounds;
  for (const Primitive &p : mesh.primitives)
    for (const std::uint32_t i : p.indices) grow(bounds, p.positions[i]);
  return bounds;
}

}  // namespace

void validate(Scene &scene, const std::string &file, Notices &notices) { Validator(scene, file, notices).run(); }

Bounds scene_bounds(const Scene &scene) {
  constexpr std::size_t exact_corners = std::size_t(1) << 24;  // beyond these the boxes of meshes are transformed, a little too large
  std::vector<std::optional<Bounds>> local(scene.meshes.size());
  std::size_t spent = 0;
  Bounds bounds;
  for (const Instance &instance : scene.instances) {
    const Mesh &mesh = scene.meshes[instance.mesh];
    if (!local[instance.mesh]) local[instance.mesh] = mesh_bounds(mesh);
    const Bounds &box = *local[instance.mesh];
    if (box.empty()) continue;
    if (instance.transform == glm::mat4x3(1)) {
      grow(bounds, box.lower);
      grow(bounds, box.upper);
      continue;
    }
    std::size_t corners = 0;
    for (const Primitive &p : mesh.primitives) corners += p.indices.size();
    if (spent + corners <= exact_corners) {
      spent += corners;
      for (const Primitive &p : mesh.primitives)
        for (const std::uint32_t i : p.indices) grow(bounds, instance.transform * glm::vec4(p.positions[i], 1));
    } else {
      for (int k = 0; k < 8; k++)
        grow(bounds, instance.transform *
                         glm::vec4(k & 1 ? box.upper.x : box.lower.x, k & 2 ? box.upper.y : box.lower.y, k & 4 ? box.upper.z : box.lower.z, 1));
    }
  }
  for (const Shape &shape : scene.shapes) {
    const Bounds box = shape_bounds(shape);
    if (box.empty()) continue;
    grow(bounds, box.lower);
    grow(bounds, box.upper);
  }
  return bounds;
}

Bounds shape_bounds(const Shape &shape) {
  Bounds bounds;
  if (shape.kind == Shape::Kind::plane) return bounds;
  const glm::mat4x3 &m = shape.transform;
  for (int axis = 0; axis < 3; axis++) {
    const float x = m[0][axis], y = m[1][axis], z = m[2][axis];
    const float reach = shape.kind == Shape::Kind::quad   ? std::abs(x) + std::abs(z)
                        : shape.kind == Shape::Kind::disk ? std::sqrt(x * x + z * z)
                                                          : std::sqrt((x * x + y * y) + z * z);
    bounds.lower[axis] = m[3][axis] - reach;
    bounds.upper[axis] = m[3][axis] + reach;
  }
  return bounds;
}

}  // namespace sunstone
