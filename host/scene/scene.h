// SPDX-License-Identifier: Apache-2.0
// A scene as the artist thinks of it: plain values, as an importer leaves them and flatten reads them.
// Units: metres, +Y up, right-handed, linear Rec. 709 radiance. Angles are in radians. Nothing here is validated by itself: scene/validate.h does that.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"

namespace sunstone {

enum class Wrap { repeat, mirror, clamp };

// A picture with the way it is looked up. Two textures may share an image.
struct Texture {
  int image = -1;  // into Scene::images; -1: could not be read (a warning was given), the same as no texture
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool linear = true;  // bilinear, else nearest
};

// How a material uses a texture: (u', v') = transform * (u, v, 1).
struct TextureUse {
  int texture = -1;  // into Scene::textures; -1: none
  int uv_set = 0;    // 0 or 1
  glm::mat3x2 transform{1, 0, 0, 1, 0, 0};  // columns: du, dv, offset
  explicit operator bool() const { return texture >= 0; }
};

enum class AlphaMode { opaque, mask, blend };

struct Material {
  std::string name;
  glm::vec3 base_color{1};
  float alpha = 1;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  float metallic = 0;
  float roughness = 1;      // perceptual, as in glTF: GGX alpha = roughness^2
  float ior = 1.5f;
  glm::vec3 f0{0.04f};      // of the dielectric at normal incidence
  float f90 = 1;            // at grazing incidence
  float transmission = 0;
  bool volume = false;      // solid: refraction and absorption; otherwise transmission is thin-walled
  glm::vec3 absorption{0};  // 1/metre
  glm::vec3 emission{0};    // radiance, strength multiplied in
  float normal_scale = 1;
  bool double_sided = false;
  bool unlit = false;
  TextureUse base_color_texture;          // rgb sRGB, a = alpha
  TextureUse metallic_roughness_texture;  // g roughness, b metallic, linear
  TextureUse normal_texture;              // linear
  TextureUse emission_texture;            // sRGB
  TextureUse transmission_texture;        // r, linear
  TextureUse specular_texture;            // a, linear: multiplies f0 and f90
  TextureUse specular_color_texture;      // rgb sRGB: multiplies f0
  TextureUse alpha_texture;               // r, linear: multiplies alpha (OBJ map_d)
};

// Vertices of a primitive that deforms, at one key of the shutter's time: arrays as the primitive has them.
struct PrimitiveKey {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
};

// One set of triangles with one material. Attribute arrays are empty or as long as `positions`.
struct Primitive {
  int material = -1;  // into Scene::materials; -1: the default material
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;   // unit length; empty: flat
  std::vector<glm::vec4> tangents;  // w = +1 or -1; empty: made after Mikkelsen where a normal map needs them
  std::vector<glm::vec2> uv[2];
  std::vector<glm::vec4> colors;    // linear
  std::vector<std::uint32_t> indices;  // 3 a triangle, always present
  std::vector<PrimitiveKey> keys;      // Scene::motion_steps of them, or none
};

struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;
  bool deforms() const {
    for (const Primitive &primitive : primitives)
      if (!primitive.keys.empty()) return true;
    return false;
  }
};

struct Instance {
  std::string name;
  int mesh = -1;
  glm::mat4x3 transform{1};  // mesh -> world (glm: four columns of three)
  std::vector<glm::mat4x3> keys{};  // Scene::motion_steps of them, or none
};

// A surface that is no mesh, in a space of its own: a sphere of radius 1 about the origin, or, in y = 0 with its front towards +y, a disk of radius 1, a
// quad from -1 to 1 in x and z, and all of the plane.
struct Shape {
  enum class Kind { sphere, disk, quad, plane } kind = Kind::sphere;
  std::string name;
  int material = -1;  // into Scene::materials; -1: the default material
  glm::mat4x3 transform{1};
  std::vector<glm::mat4x3> keys{};  // Scene::motion_steps of them, or none
};

struct LightKey {
  glm::vec3 position, direction;
};

struct Light {
  enum class Kind { point, spot, directional } kind = Kind::point;
  std::string name;
  glm::vec3 position{0};
  glm::vec3 direction{0, 0, -1};  // that it shines to, unit length
  glm::vec3 intensity{1};         // W/sr, or W/m^2 (directional), the file's number as it is
  float inner_angle = 0, outer_angle = 0.7853982f;  // spot, radians from the axis
  std::vector<LightKey> keys{};   // Scene::motion_steps of them, or none
};

struct Camera {
  std::string name;
  bool orthographic = false;
  glm::mat4x3 transform{1};      // camera -> world, rigid; looks along -z, +y up
  float yfov = 0.6981317f;       // perspective: vertical angle
  std::optional<float> aspect;   // width / height, where the file gives it; the picture's own otherwise
  float half_height = 1;         // orthographic, metres
  float half_width = 1;
  float lens_radius = 0;         // metres
  float focus_distance = 1;      // metres, used where lens_radius > 0
  std::vector<glm::mat4x3> keys{};  // Scene::motion_steps of them, or none
};

struct Environment {
  enum class Kind { none, constant, map } kind = Kind::none;
  glm::vec3 constant{0};
  std::shared_ptr<const Image> map;  // equirectangular, linear RGB float
  float rotation = 0;                // turns, about +y
  float strength = 1;
};

struct Bounds {
  glm::vec3 lower{INFINITY}, upper{-INFINITY};
  bool empty() const { return !(lower.x <= upper.x); }
};

struct Scene {
  std::string name;  // the file's stem
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Shape> shapes;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  Environment environment;
  std::vector<std::string> extensions;  // named by the file, for `info`
  // While the shutter is open: its time is cut into so many equal steps, and what moves has a key at the end of each, beside what it is at the beginning of the first.
  // Between two of them it moves in a straight line. A power of two; 0: everything is still.
  unsigned motion_steps = 0;
};

}  // namespace sunstone
