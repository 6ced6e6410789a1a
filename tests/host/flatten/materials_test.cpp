// SPDX-License-Identifier: Apache-2.0
#include "flatten/materials.h"

#include <gtest/gtest.h>

#include "host/flatten/flatten_support.h"

namespace sunstone {
namespace {

Scene scene_with(const Material &material) {
  Scene scene = scene_of(square(0));
  scene.materials.push_back(material);
  return scene;
}
kernel::uint flags_of(const Scene &scene) { return flattened(scene).materials[0].flags; }

// An image of 2 x 2 with this alpha in one texel and 1 in the others; white, or `grey`.
Image alpha_image(std::uint8_t alpha, std::uint8_t grey = 255) {
  Image image = byte_image(2, 2, 4, 0);
  image.pixels = std::vector<std::uint8_t>{grey, grey, grey, 255, grey, grey, grey, alpha, grey, grey, grey, 255, grey, grey, grey, 255};
  return image;
}
Scene alpha_scene(AlphaMode mode, std::uint8_t alpha) {
  Material material;
  material.alpha_mode = mode;
  material.base_color_texture.texture = 0;
  Scene scene = scene_with(material);
  scene.images.push_back(alpha_image(alpha));
  scene.textures.push_back({0});
  return scene;
}

TEST(FlattenMaterials, TheDefaultIsWhiteAndDoubleSided) {
  const FlatScene flat = flattened(scene_of(square()));
  ASSERT_EQ(flat.materials.size(), 1u);
  const kernel::Material &material = flat.materials[flat.triangles[0].material];
  EXPECT_EQ(material.base_color[1], 1.0f);
  EXPECT_EQ(material.roughness, 1.0f);
  EXPECT_EQ(material.metallic, 0.0f);
  EXPECT_EQ(material.f0[2], 0.04f);
  EXPECT_TRUE(material.flags & SUN_MATERIAL_DOUBLE_SIDED);
  for (kernel::uint slot : material.slot) EXPECT_EQ(slot, SUN_NONE);
}

TEST(FlattenMaterials, SpecularOnlyWhereALobeIs) {
  Material material;
  EXPECT_TRUE(flags_of(scene_with(material)) & SUN_MATERIAL_SPECULAR);
  material.f0 = glm::vec3(0);
  material.f90 = 0;
  EXPECT_FALSE(flags_of(scene_with(material)) & SUN_MATERIAL_SPECULAR);
  EXPECT_FALSE(flattened(scene_with(material)).has_specular);
  material.metallic = 0.1f;
  EXPECT_TRUE(flags_of(scene_with(material)) & SUN_MATERIAL_SPECULAR);
}

TEST(FlattenMaterials, UnlitShowsItsBaseColourAsEmission) {
  Scene scene = alpha_scene(AlphaMode::opaque, 255);
  scene.materials[0].unlit = true;
  scene.materials[0].base_color = {0.25f, 0.5f, 1};
  const FlatScene flat = flattened(scene);
  EXPECT_EQ(flat.materials[0].flags & (SUN_MATERIAL_UNLIT | SUN_MATERIAL_EMISSIVE | SUN_MATERIAL_SPECULAR),
            SUN_MATERIAL_UNLIT | SUN_MATERIAL_EMISSIVE);
  EXPECT_EQ(flat.materials[0].emission[1], 0.5f);
  EXPECT_EQ(flat.materials[0].slot[SUN_SLOT_EMISSION], flat.materials[0].slot[SUN_SLOT_BASE_COLOR]);
  EXPECT_NE(flat.materials[0].slot[SUN_SLOT_EMISSION], SUN_NONE);
  EXPECT_EQ(flat.emitters.size(), 2u);
}

TEST(FlattenMaterials, AlphaThatNeverPassesIsOpaque) {
  for (AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
    EXPECT_EQ(flags_of(alpha_scene(mode, 255)) & (SUN_MATERIAL_PASSABLE | SUN_MATERIAL_ALPHA_MASK | SUN_MATERIAL_ALPHA_BLEND), 0u);
    EXPECT_TRUE(flags_of(alpha_scene(mode, 100)) & SUN_MATERIAL_PASSABLE);
  }
  EXPECT_FALSE(flags_of(alpha_scene(AlphaMode::mask, 200)) & SUN_MATERIAL_PASSABLE);  // above the cutoff everywhere
  EXPECT_TRUE(flags_of(alpha_scene(AlphaMode::blend, 254)) & SUN_MATERIAL_PASSABLE);
  EXPECT_FALSE(flags_of(alpha_scene(AlphaMode::opaque, 0)) & SUN_MATERIAL_PASSABLE);
}

TEST(FlattenMaterials, AlphaOfFactorsColoursAndMapsCounts) {
  Material material;
  material.alpha_mode = AlphaMode::mask;
  material.alpha = 0.5f;
  EXPECT_FALSE(flags_of(scene_with(material)) & SUN_MATERIAL_PASSABLE);  // alpha at the cutoff is there
  material.alpha = 0.49f;
  EXPECT_TRUE(flags_of(scene_with(material)) & SUN_MATERIAL_PASSABLE);
  material.alpha = 1;
  material.alpha_mode = AlphaMode::blend;
  Scene scene = scene_with(material);
  scene.meshes[0].primitives[0].colors.assign(4, glm::vec4(1, 1, 1, 1));
  EXPECT_FALSE(flags_of(scene) & SUN_MATERIAL_PASSABLE);
  scene.meshes[0].primitives[0].colors[2].w = 0.9f;
  EXPECT_TRUE(flags_of(scene) & SUN_MATERIAL_PASSABLE);
  EXPECT_TRUE(flattened(scene).has_passable);
  scene = scene_with(material);
  scene.images.push_back(alpha_image(255, 128));
  scene.textures.push_back({0});
  scene.materials[0].alpha_texture.texture = 0;
  EXPECT_TRUE(flags_of(scene) & SUN_MATERIAL_PASSABLE);
}

TEST(FlattenMaterials, ThinTransmissionPassesWhereItCouldBeSmooth) {
  Material material;
  material.transmission = 1;
  material.roughness = 0.1f;
  material.metallic_roughness_texture.texture = 0;
  Scene scene = scene_with(material);
  scene.textures.push_back({0});
  scene.images.push_back(alpha_image(255, 255));
  EXPECT_FALSE(flags_of(scene) & SUN_MATERIAL_PASSABLE);  // alpha = 0.01 everywhere
  scene.images[0] = alpha_image(255, 20);
  EXPECT_TRUE(flags_of(scene) & SUN_MATERIAL_PASSABLE);
}

TEST(FlattenMaterials, BlackEmissionTexturesDontEmit) {
  Material material;
  material.emission = glm::vec3(2);
  material.emission_texture.texture = 0;
  Scene scene = scene_with(material);
  scene.textures.push_back({0});
  scene.images.push_back(alpha_image(255, 0));
  EXPECT_FALSE(flags_of(scene) & SUN_MATERIAL_EMISSIVE);
  EXPECT_TRUE(flattened(scene).emitters.empty());
  scene.images[0] = alpha_image(255, 1);
  EXPECT_TRUE(flags_of(scene) & SUN_MATERIAL_EMISSIVE);
}

TEST(FlattenMaterials, UnreadableImagesAreNoTextures) {
  Scene scene = alpha_scene(AlphaMode::blend, 0);
  scene.textures[0].image = -1;
  const FlatScene flat = flattened(scene);
  EXPECT_TRUE(flat.textures.empty());
  EXPECT_FALSE(flat.has_textures);
  EXPECT_EQ(flat.materials[0].slot[SUN_SLOT_BASE_COLOR], SUN_NONE);
}

TEST(FlattenMaterials, EqualReferencesAreOne) {
  Scene scene = alpha_scene(AlphaMode::opaque, 255);
  scene.materials.push_back(scene.materials[0]);
  scene.meshes[0].primitives.push_back(square(1));
  scene.materials.push_back(scene.materials[0]);
  scene.materials[2].base_color_texture.transform[2] = {0.5f, 0};
  scene.meshes[0].primitives.push_back(square(2));
  const FlatScene flat = flattened(scene);
  EXPECT_EQ(flat.textures.size(), 1u);
  ASSERT_EQ(flat.texture_refs.size(), 2u);
  EXPECT_EQ(flat.materials[0].slot[SUN_SLOT_BASE_COLOR], flat.materials[1].slot[SUN_SLOT_BASE_COLOR]);
  EXPECT_EQ(flat.texture_refs[1].m[2], 0.5f);
  EXPECT_EQ(flat.texture_refs[1].m[4], 1.0f);
}

}  // namespace
}  // namespace sunstone
