// SPDX-License-Identifier: Apache-2.0
#include "import/obj_materials.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "import/obj_loader.h"
#include "import/obj_textures.h"

namespace sunstone {

namespace {

constexpr float diffuse_default = 0.8f;  // where neither Kd nor map_Kd is given
constexpr float exponent_default = 10;   // where Ks is given without Ns
constexpr float mirror_exponent = 100;   // from here on, mirrors and glass are perfectly smooth

glm::vec3 color(const tinyobj::real_t *values) { return {values[0], values[1], values[2]}; }
float largest(const glm::vec3 &v) { return std::max(std::max(v.x, v.y), v.z); }

// Blinn's exponent -> GGX alpha = sqrt(2 / (Ns + 2)) [Walter07], and from that the perceptual roughness.
float roughness_of(float exponent) { return std::sqrt(std::sqrt(2 / (exponent + 2))); }

// Reflectance at normal incidence from the index of refraction.
float f0_of(float ior) {
  const float r = (ior - 1) / (ior + 1);
  return r * r;
}

// One material, by the table in docs/obj-materials.md.
class Converter {
 public:
  Converter(const tinyobj::material_t &from, const std::set<std::string> &given) : from_(from), given_(given) {}

  Material run() {
    m_.double_sided = true;
    m_.base_color = has("Kd") ? color(from_.diffuse) : glm::vec3(has("map_Kd") ? 1 : diffuse_default);
    m_.emission = has("Ke") ? color(from_.emission) : glm::vec3(has("map_Ke") ? 1 : 0);
    m_.ior = has("Ni") ? from_.ior : 1.5f;
    if (has("norm")) m_.normal_scale = from_.normal_texopt.bump_multiplier;
    const int model = has("illum") ? from_.illum : 2;
    const bool glass = model == 4 || model == 6 || model == 7 || model == 9;
    if (glass)
      make_glass();
    else if (has("Pr") || has("Pm") || has("map_Pr") || has("map_Pm"))
      make_metallic_roughness();
    else if (model == 3 || model == 5 || model == 8)
      make_mirror();
    else if (model == 0 || model == 1)
      make_diffuse();
    else
      make_glossy();
    if (!glass) {
      m_.alpha = has("d") || has("Tr") ? from_.dissolve : 1;
      if (m_.alpha < 1 || has("map_d")) m_.alpha_mode = AlphaMode::blend;
    }
    return m_;
  }

 private:
  bool has(const char *statement) const { return given_.count(statement) > 0; }
  float exponent() const { return has("Ns") ? from_.shininess : exponent_default; }
  float smooth_roughness() const {
    return has("Pr") ? from_.roughness : !has("Ns") || from_.shininess >= mirror_exponent ? 0 : roughness_of(from_.shininess);
  }

  void specular(const glm::vec3 &f0) {
    m_.f0 = f0;
    m_.f90 = largest(f0) > 0 ? 1 : 0;
  }

  void make_diffuse() {
    m_.roughness = 1;
    specular(glm::vec3(0));
  }

  void make_glossy() {
    m_.roughness = roughness_of(exponent());
    specular(has("Ks") ? color(from_.specular) : glm::vec3(has("map_Ks") ? 1 : 0));
  }

  // A mirror that is rather bright than coloured from within is a metal of that brightness.
  void make_mirror() {
    make_glossy();
    m_.roughness = smooth_roughness();
    if (!has("Ks") || largest(color(from_.specular)) < largest(m_.base_color)) return;
    m_.metallic = 1;
    m_.base_color = color(from_.specular);
  }

  // Tf is what a body lets through, and light passes two surfaces of it.
  void make_glass() {
    const glm::vec3 filter = has("Tf") ? color(from_.transmittance) : glm::vec3(1);
    m_.base_color = {std::sqrt(filter.x), std::sqrt(filter.y), std::sqrt(filter.z)};
    m_.transmission = 1;
    m_.volume = true;
    m_.roughness = smooth_roughness();
    specular(glm::vec3(f0_of(m_.ior)));
  }

  void make_metallic_roughness() {
    m_.roughness = has("Pr") ? from_.roughness : has("map_Pr") ? 1 : roughness_of(exponent());
    m_.metallic = has("Pm") ? from_.metallic : has("map_Pm") ? 1 : 0;
    specular(glm::vec3(has("Ni") && from_.ior > 1 ? f0_of(from_.ior) : 0.04f));
  }

  const tinyobj::material_t &from_;
  const std::set<std::string> &given_;
  Material m_;
};

}  // namespace

Material default_obj_material() {
  Material m;
  m.name = "default";
  m.base_color = glm::vec3(diffuse_default);
  m.f0 = glm::vec3(0);
  m.f90 = 0;
  m.double_sided = true;
  return m;
}

std::vector<Material> make_obj_materials(const GuardedMtl &libraries, const LoadedObj &obj, const std::vector<bool> &used, ObjTextures &textures,
                                         const std::string &file) {
  std::vector<Material> materials;
  for (std::size_t i = 0; i < libraries.names.size(); i++) {
    const tinyobj::material_t &from = obj.materials[i];
    Material m = Converter(from, libraries.given[i]).run();
    m.name = libraries.names[i];
    if (used[i]) {
      const std::string place = file + ": material \"" + printable(m.name, 60) + "\"";
      const bool mirror = m.metallic == 1 && m.transmission == 0 && libraries.given[i].count("Pm") == 0 && libraries.given[i].count("map_Pm") == 0;
      // A mirror's colour is Ks, glass's is Tf, so map_Ks and nothing belong to them.
      if (m.transmission == 0)
        m.base_color_texture = mirror ? textures.color(from.specular_texname, from.specular_texopt, place)
                                      : textures.color(from.diffuse_texname, from.diffuse_texopt, place);
      if (!mirror && m.f90 > 0) m.specular_color_texture = textures.color(from.specular_texname, from.specular_texopt, place);
      m.emission_texture = textures.color(from.emissive_texname, from.emissive_texopt, place);
      m.normal_texture = textures.color(from.normal_texname, from.normal_texopt, place);
      m.alpha_texture = textures.scalar(from.alpha_texname, from.alpha_texopt, place);
      m.metallic_roughness_texture = textures.metallic_roughness(from, place);
      if (!m.alpha_texture && m.alpha == 1) m.alpha_mode = AlphaMode::opaque;
    }
    materials.push_back(std::move(m));
  }
  return materials;
}

}  // namespace sunstone
