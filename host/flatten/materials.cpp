// SPDX-License-Identifier: Apache-2.0
#include "flatten/materials.h"

#include <algorithm>

namespace sunstone {
namespace {

using kernel::uint;

// GGX alpha below which a lobe is treated as a mirror.
constexpr float smooth_alpha = 1e-3f;

void copy3(const glm::vec3 &from, float *to) {
  for (int c = 0; c < 3; c++) to[c] = from[c];
}

bool any_positive(const float *rgb) { return rgb[0] > 0 || rgb[1] > 0 || rgb[2] > 0; }

// By record: is it on any triangle of an instance, or on a shape, and the least alpha among the vertex colours there.
struct Use {
  bool shown = false;
  float least_color_alpha = 1;
};

std::vector<Use> uses_of(const Scene &scene) {
  std::vector<bool> mesh_shown(scene.meshes.size());
  for (const Instance &instance : scene.instances) mesh_shown[static_cast<std::size_t>(instance.mesh)] = true;
  std::vector<Use> uses(scene.materials.size() + 1);
  for (std::size_t m = 0; m < scene.meshes.size(); m++)
    for (const Primitive &primitive : scene.meshes[m].primitives) {
      if (!mesh_shown[m] || primitive.indices.empty()) continue;
      Use &use = uses[material_number(scene, primitive.material)];
      use.shown = true;
      for (const glm::vec4 &color : primitive.colors) use.least_color_alpha = std::min(use.least_color_alpha, color.w);
    }
  for (const Shape &shape : scene.shapes) uses[material_number(scene, shape.material)].shown = true;
  return uses;
}

kernel::Material record_of(const Material &material) {
  kernel::Material record{};
  copy3(material.base_color, record.base_color);
  record.base_color[3] = material.alpha;
  copy3(material.unlit ? material.base_color : material.emission, record.emission);
  record.alpha_cutoff = material.alpha_cutoff;
  record.metallic = material.metallic;
  record.roughness = material.roughness;
  record.transmission = material.transmission;
  record.ior = material.ior;
  copy3(material.f0, record.f0);
  record.f90 = material.f90;
  copy3(material.absorption, record.absorption);
  record.normal_scale = material.normal_scale;
  if (material.double_sided) record.flags |= SUN_MATERIAL_DOUBLE_SIDED;
  if (material.alpha_mode == AlphaMode::mask) record.flags |= SUN_MATERIAL_ALPHA_MASK;
  if (material.alpha_mode == AlphaMode::blend) record.flags |= SUN_MATERIAL_ALPHA_BLEND;
  if (material.unlit) record.flags |= SUN_MATERIAL_UNLIT;
  if (material.volume && !material.unlit) record.flags |= SUN_MATERIAL_VOLUME;
  if (any_positive(record.emission)) record.flags |= SUN_MATERIAL_EMISSIVE;
  const bool specular = record.f90 > 0 || any_positive(record.f0) || record.metallic > 0 || record.transmission > 0;
  if (specular && !material.unlit) record.flags |= SUN_MATERIAL_SPECULAR;
  std::fill(std::begin(record.slot), std::end(record.slot), SUN_NONE);
  return record;
}

void fill_slots(const Material &material, TextureLibrary &library, kernel::Material &record) {
  const bool has_alpha = material.alpha_mode != AlphaMode::opaque;
  record.slot[SUN_SLOT_BASE_COLOR] = library.use(material.base_color_texture, true);
  record.slot[SUN_SLOT_ALPHA] = has_alpha ? library.use(material.alpha_texture, false) : SUN_NONE;
  if (material.unlit) {
    record.slot[SUN_SLOT_EMISSION] = record.slot[SUN_SLOT_BASE_COLOR];
  } else {
    // A texture that scales a factor of 0 is never looked up.
    if (record.flags & SUN_MATERIAL_EMISSIVE) record.slot[SUN_SLOT_EMISSION] = library.use(material.emission_texture, true);
    record.slot[SUN_SLOT_METALLIC_ROUGHNESS] = library.use(material.metallic_roughness_texture, false);
    record.slot[SUN_SLOT_NORMAL] = library.use(material.normal_texture, false);
    if (record.transmission > 0) record.slot[SUN_SLOT_TRANSMISSION] = library.use(material.transmission_texture, false);
    if (record.f90 > 0 || any_positive(record.f0)) record.slot[SUN_SLOT_SPECULAR] = library.use(material.specular_texture, false);
    if (any_positive(record.f0)) record.slot[SUN_SLOT_SPECULAR_COLOR] = library.use(material.specular_color_texture, true);
  }
  if (std::any_of(std::begin(record.slot), std::end(record.slot), [](uint ref) { return ref != SUN_NONE; })) record.flags |= SUN_MATERIAL_TEXTURED;
}

}  // namespace

void flatten_materials(const Scene &scene, TextureLibrary &library, FlatScene &flat) {
  Material absent;  // white, diffuse but for the usual 4 % at the surface
  absent.double_sided = true;
  const std::vector<Use> uses = uses_of(scene);
  flat.materials.reserve(uses.size());
  for (std::size_t i = 0; i < uses.size(); i++) {
    const Material &material = i < scene.materials.size() ? scene.materials[i] : absent;
    flat.materials.push_back(record_of(material));
    if (uses[i].shown) fill_slots(material, library, flat.materials.back());
  }
}

void finish_materials(const Scene &scene, FlatScene &flat) {
  std::map<uint, TextureRange> ranges;
  const auto range_of = [&](uint ref) {
    if (ref == SUN_NONE) return TextureRange{};
    const uint texture = flat.texture_refs[ref].texture;
    const auto [found, added] = ranges.try_emplace(texture);
    if (added) found->second = texture_range(flat, flat.textures[texture]);
    return found->second;
  };
  const std::vector<Use> uses = uses_of(scene);
  for (std::size_t i = 0; i < uses.size(); i++) {
    if (!uses[i].shown) continue;
    kernel::Material &record = flat.materials[i];
    if (record.flags & SUN_MATERIAL_EMISSIVE) {
      const TextureRange range = range_of(record.slot[SUN_SLOT_EMISSION]);
      bool some = false;
      for (std::size_t c = 0; c < 3; c++) some = some || record.emission[c] * range.mean[c] > 0;
      if (!some) record.flags &= ~SUN_MATERIAL_EMISSIVE;
    }
    bool passable = false;
    if (record.flags & (SUN_MATERIAL_ALPHA_MASK | SUN_MATERIAL_ALPHA_BLEND)) {
      const float textures = range_of(record.slot[SUN_SLOT_BASE_COLOR]).least[3] * range_of(record.slot[SUN_SLOT_ALPHA]).least[0];
      float least = record.base_color[3] * textures * uses[i].least_color_alpha;
      // Filtering may round below the least texel.
      if (textures != 1 || uses[i].least_color_alpha != 1) least *= 0.999f;
      passable = least < (record.flags & SUN_MATERIAL_ALPHA_MASK ? record.alpha_cutoff : 1.0f);
      if (!passable) record.flags &= ~(SUN_MATERIAL_ALPHA_MASK | SUN_MATERIAL_ALPHA_BLEND);
    }
    if (record.transmission > 0 && !(record.flags & (SUN_MATERIAL_VOLUME | SUN_MATERIAL_UNLIT))) {
      const uint texture = record.slot[SUN_SLOT_METALLIC_ROUGHNESS];
      const float roughness = texture == SUN_NONE ? record.roughness : record.roughness * range_of(texture).least[1] * 0.999f;
      passable = passable || roughness * roughness < smooth_alpha;
    }
    if (passable) record.flags |= SUN_MATERIAL_PASSABLE;
    flat.has_passable = flat.has_passable || passable;
    flat.has_specular = flat.has_specular || (record.flags & SUN_MATERIAL_SPECULAR);
    flat.has_textures = flat.has_textures || (record.flags & SUN_MATERIAL_TEXTURED);
  }
}

}  // namespace sunstone
