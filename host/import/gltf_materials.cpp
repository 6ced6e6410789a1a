// SPDX-License-Identifier: Apache-2.0
#include "import/gltf_materials.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "math/elementary.h"

namespace sunstone::gltf {

namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr float least_attenuation_color = 1e-6f;  // black within one attenuation distance, near enough, and its logarithm is finite
constexpr float largest_absorption = 1e9f;        // per metre

// KHR_texture_transform: translation * rotation * scale. The extension's text prints the rotation's GLSL columns as rows; its own example (the
// lower left quadrant, turned clockwise), its sample model and every renderer turn the UVs counter-clockwise on the picture, where v points down.
glm::mat3x2 transform_of(const Value &extension) {
  const glm::vec2 offset = extension["offset"].vec2({0, 0}), scale = extension["scale"].vec2({1, 1});
  float sine, cosine;
  kernel::sin_cos(extension["rotation"].real(0), &sine, &cosine);
  return {cosine * scale.x, -sine * scale.x, sine * scale.y, cosine * scale.y, offset.x, offset.y};
}

AlphaMode alpha_mode_of(const Value &value) {
  const std::string name = value.text("OPAQUE");
  if (name == "OPAQUE") return AlphaMode::opaque;
  if (name == "MASK") return AlphaMode::mask;
  if (name == "BLEND") return AlphaMode::blend;
  value.fail("\"" + printable(name) + "\" is none of OPAQUE, MASK, BLEND");
}

// KHR_materials_ior and KHR_materials_specular: what the dielectric reflects.
void read_specular(Material &material, const Value &ior_extension, const Value &specular_extension) {
  const Value ior = ior_extension["ior"];
  if (ior.real(1.5f) == 0) {
    // The extension's way to say that the Fresnel term is 1 everywhere, for materials that came from specular-glossiness.
    material.f0 = glm::vec3(1);
  } else {
    material.ior = ior.factor(1.5f, 1, largest);
    const float ratio = (material.ior - 1) / (material.ior + 1);
    material.f0 = glm::vec3(ratio * ratio);
  }
  const float specular = specular_extension["specularFactor"].factor(1, 0, 1);
  const glm::vec3 color = specular_extension["specularColorFactor"].factors(glm::vec3(1), 0, largest);
  for (int c = 0; c < 3; c++) material.f0[c] = std::min(material.f0[c] * color[c], 1.0f) * specular;
  material.f90 = specular;
}

// KHR_materials_volume. Thickness is for rasterizers: here it says only whether the surface bounds a solid. Distances are world metres.
void read_volume(Material &material, const Value &volume) {
  material.volume = volume["thicknessFactor"].factor(0, 0, largest) > 0;
  const Value distance_value = volume["attenuationDistance"];
  const glm::vec3 color = volume["attenuationColor"].factors(glm::vec3(1), 0, 1);
  if (!distance_value) return;  // infinite: no absorption
  const float distance = distance_value.real(0);
  if (!(distance > 0)) {
    distance_value.warn("is not above 0, so nothing is absorbed");
    return;
  }
  for (int c = 0; c < 3; c++)
    material.absorption[c] = std::min(std::max(-kernel::log_real(std::max(color[c], least_attenuation_color)), 0.0f) / distance, largest_absorption);
}

}  // namespace

TextureUse Materials::texture(const Value &info, Scene &scene) {
  if (!info) return {};
  info.expect_object();
  info.check_extensions({"KHR_texture_transform"});
  TextureUse use;
  Value set = info["texCoord"];
  if (const Value transform = info.extension("KHR_texture_transform")) {
    use.transform = transform_of(transform);
    if (transform["texCoord"]) set = transform["texCoord"];
  }
  const std::uint64_t uv_set = set.whole(0);
  const int number = images_.texture(info["index"], scene);
  if (uv_set > 1) {
    set.warn("only TEXCOORD_0 and TEXCOORD_1 are read, so this texture was left out");
    return {};
  }
  use.uv_set = static_cast<int>(uv_set);
  use.texture = number;
  return use;
}

Material Materials::read(const Value &value, Scene &scene) {
  value.expect_object();
  value.check_extensions({"KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_transmission",
                          "KHR_materials_volume", "KHR_materials_unlit"});
  Material material;
  material.name = value["name"].text();
  const Value pbr = value["pbrMetallicRoughness"];
  if (const Value color = pbr["baseColorFactor"]) {
    color.numbers(4);
    for (std::size_t c = 0; c < 3; c++) material.base_color[static_cast<int>(c)] = color[c].factor(1, 0, 1);
    material.alpha = color[std::size_t(3)].factor(1, 0, 1);
  }
  material.base_color_texture = texture(pbr["baseColorTexture"], scene);
  material.metallic = pbr["metallicFactor"].factor(1, 0, 1);
  material.roughness = pbr["roughnessFactor"].factor(1, 0, 1);
  material.metallic_roughness_texture = texture(pbr["metallicRoughnessTexture"], scene);
  material.normal_texture = texture(value["normalTexture"], scene);
  material.normal_scale = value["normalTexture"]["scale"].real(1);

  const float strength = value.extension("KHR_materials_emissive_strength")["emissiveStrength"].factor(1, 0, 1e18f);
  material.emission = value["emissiveFactor"].factors(glm::vec3(0), 0, 1) * strength;
  material.emission_texture = texture(value["emissiveTexture"], scene);
  material.alpha_mode = alpha_mode_of(value["alphaMode"]);
  material.alpha_cutoff = value["alphaCutoff"].factor(0.5f, 0, largest);
  material.double_sided = value["doubleSided"].boolean(false);
  material.unlit = static_cast<bool>(value.extension("KHR_materials_unlit"));

  const Value specular = value.extension("KHR_materials_specular");
  read_specular(material, value.extension("KHR_materials_ior"), specular);
  material.specular_texture = texture(specular["specularTexture"], scene);
  material.specular_color_texture = texture(specular["specularColorTexture"], scene);

  const Value transmission = value.extension("KHR_materials_transmission");
  material.transmission = transmission["transmissionFactor"].factor(0, 0, 1);
  material.transmission_texture = texture(transmission["transmissionTexture"], scene);
  if (const Value volume = value.extension("KHR_materials_volume")) read_volume(material, volume);
  return material;
}

int Materials::material(const Value &reference, Scene &scene) {
  if (!reference) return -1;
  const std::size_t index = reference.index(materials_.size(), "materials");
  if (numbers_[index] < 0) {
    Material material = read(materials_[index], scene);
    numbers_[index] = static_cast<int>(scene.materials.size());
    scene.materials.push_back(std::move(material));
  }
  return numbers_[index];
}

}  // namespace sunstone::gltf
