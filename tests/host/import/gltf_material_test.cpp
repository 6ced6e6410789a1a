// SPDX-License-Identifier: Apache-2.0
// Materials, textures and URIs of the glTF importer.
#include <gtest/gtest.h>

#include <cmath>

#include "host/import/gltf_builder.h"
#include "import/gltf_buffers.h"

namespace sunstone {
namespace {

using nlohmann::json;
using test::GltfBuilder;

// A 2x1 picture (red, green) as an uncompressed TGA, its rows from the top.
const std::vector<std::uint8_t> tga = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 24, 0x20, 0, 0, 255, 0, 255, 0};

GltfBuilder with_material(json material) {
  GltfBuilder file;
  file.root["materials"] = {std::move(material)};
  file.primitive()["material"] = 0;
  return file;
}

Material read(json material) {
  const Scene scene = with_material(std::move(material)).import();
  return scene.materials.at(0);
}

void expect_near(const glm::vec3 &got, const glm::vec3 &want, float tolerance) {
  for (int c = 0; c < 3; c++) EXPECT_NEAR(got[c], want[c], tolerance);
}

TEST(GltfMaterials, Defaults) {
  const Material m = read(json::object());
  EXPECT_EQ(m.metallic, 1);  // unlike Scene's own default
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.base_color, glm::vec3(1));
  EXPECT_EQ(m.ior, 1.5f);
  expect_near(m.f0, glm::vec3(0.04f), 1e-7f);
  EXPECT_EQ(m.f90, 1);
  EXPECT_FALSE(m.double_sided || m.unlit || m.volume);
  EXPECT_EQ(m.alpha_mode, AlphaMode::opaque);
}

TEST(GltfMaterials, Core) {
  const Material m =
      read({{"name", "red"},
            {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.25, 0.75}}, {"metallicFactor", 0.125}, {"roughnessFactor", 0.375}}},
            {"emissiveFactor", {0.5, 1, 0}},
            {"alphaMode", "MASK"},
            {"alphaCutoff", 0.25},
            {"doubleSided", true},
            {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}}, {"KHR_materials_unlit", json::object()}}}});
  EXPECT_EQ(m.name, "red");
  EXPECT_EQ(m.base_color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(m.alpha, 0.75f);
  EXPECT_EQ(m.metallic, 0.125f);
  EXPECT_EQ(m.roughness, 0.375f);
  EXPECT_EQ(m.emission, glm::vec3(4, 8, 0));
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, 0.25f);
  EXPECT_TRUE(m.double_sided && m.unlit);
}

TEST(GltfMaterials, IorAndSpecular) {
  const Material m =
      read({{"extensions",
             {{"KHR_materials_ior", {{"ior", 2.0}}}, {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0, 20}}}}}}});
  EXPECT_EQ(m.ior, 2);
  expect_near(m.f0, {0.5f / 9, 0, 0.5f}, 1e-7f);  // ((2-1)/(2+1))^2 = 1/9; blue is clamped at 1 before the factor
  EXPECT_EQ(m.f90, 0.5f);
  expect_near(read({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}).f0, glm::vec3(1), 0);
}

TEST(GltfMaterials, TransmissionAndVolume) {
  const json volume = {{"thicknessFactor", 0.1}, {"attenuationColor", {0.5, 1, 0}}, {"attenuationDistance", 2}};
  Material m = read({{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}, {"KHR_materials_volume", volume}}}});
  EXPECT_EQ(m.transmission, 0.75f);
  EXPECT_TRUE(m.volume);
  EXPECT_NEAR(m.absorption.x, std::log(2.0) / 2, 1e-6);
  EXPECT_EQ(m.absorption.y, 0);
  EXPECT_NEAR(m.absorption.z, std::log(1e6) / 2, 1e-4);  // black: clamped, so finite
  m = read(
      {{"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}, {"KHR_materials_volume", {{"attenuationColor", {0.5, 1, 0}}}}}}});
  EXPECT_FALSE(m.volume);                 // no thickness: thin-walled
  EXPECT_EQ(m.absorption, glm::vec3(0));  // no distance: infinite
}

TEST(GltfMaterials, FactorsOutOfRangeAreClampedWithWarnings) {
  Notices notices;
  const Scene scene = with_material({{"pbrMetallicRoughness", {{"roughnessFactor", 7}, {"metallicFactor", -2}}}}).import(notices);
  EXPECT_EQ(scene.materials.at(0).roughness, 1);
  EXPECT_EQ(scene.materials.at(0).metallic, 0);
  ASSERT_EQ(notices.all().size(), 2u);
  EXPECT_EQ(notices.all()[0].place, "test.glb: materials[0].pbrMetallicRoughness.metallicFactor");
}

TEST(GltfMaterials, UnknownExtensionsAreNamedOnce) {
  GltfBuilder file = with_material({{"extensions", {{"KHR_materials_sheen", json::object()}, {"VENDOR_x\x1b", json::object()}}}});
  file.root["materials"].push_back(file.root["materials"][0]);
  json second = file.primitive();
  second["material"] = 1;
  file.root["meshes"][0]["primitives"].push_back(second);
  EXPECT_EQ(file.warnings(), (std::vector<std::string>{"test.glb: KHR_materials_sheen is not rendered",
                                                       "test.glb: the extension VENDOR_x\\x1b is not supported and was ignored"}));
}

GltfBuilder textured(json info) {
  GltfBuilder file = with_material({{"pbrMetallicRoughness", {{"baseColorTexture", std::move(info)}}}});
  file.root["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}}};
  file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  file.root["images"] = {{{"bufferView", file.view(tga)}, {"mimeType", "image/x-tga"}}};
  return file;
}

TEST(GltfTextures, ImageInABuffer) {
  const Scene scene = textured({{"index", 0}, {"texCoord", 1}}).import();
  const TextureUse &use = scene.materials.at(0).base_color_texture;
  ASSERT_EQ(use.texture, 0);
  EXPECT_EQ(use.uv_set, 1);
  EXPECT_EQ(use.transform, (glm::mat3x2{1, 0, 0, 1, 0, 0}));
  const Texture &texture = scene.textures.at(0);
  EXPECT_EQ(texture.wrap_u, Wrap::clamp);
  EXPECT_EQ(texture.wrap_v, Wrap::mirror);
  EXPECT_FALSE(texture.linear);
  const Image &image = scene.images.at(static_cast<std::size_t>(texture.image));
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 1);
  EXPECT_EQ(std::get<0>(image.pixels).at(0), 255);  // red first
  EXPECT_EQ(std::get<0>(image.pixels).at(1), 0);
}

// KHR_texture_transform's sample model: the arrow, drawn to point at (0.778, 0.778) from the upper left corner, meets the "correct" mark.
TEST(GltfTextures, TransformTurnsCounterClockwise) {
  const auto apply = [](json transform, glm::vec2 uv) {
    const Scene scene = textured({{"index", 0}, {"extensions", {{"KHR_texture_transform", std::move(transform)}}}}).import();
    return scene.materials.at(0).base_color_texture.transform * glm::vec3(uv, 1);
  };
  const glm::vec2 tip(0.7778f, 0.7778f);
  const auto expect_at_tip = [&](glm::vec2 got) {
    EXPECT_NEAR(got.x, tip.x, 2e-3f);
    EXPECT_NEAR(got.y, tip.y, 2e-3f);
  };
  expect_at_tip(apply({{"rotation", 0.39269908169872414}}, {0.5f - 0.07904822f, 0.5f + 0.51626748f}));
  expect_at_tip(apply({{"scale", {1.5, 1.5}}}, {0.5f + 0.01854497f, 0.5f + 0.01854497f}));
  // Exactly: offset, then rotation by a quarter, then scale. (u, v) -> (0.25 + 3 v, 0.5 - 2 u).
  const glm::vec2 got = apply({{"offset", {0.25, 0.5}}, {"rotation", 1.5707963267948966}, {"scale", {2, 3}}}, {1, 1});
  EXPECT_NEAR(got.x, 3.25f, 1e-6f);
  EXPECT_NEAR(got.y, -1.5f, 1e-6f);
}

TEST(GltfTextures, TransformOverridesTheSet) {
  const Scene scene = textured({{"index", 0}, {"texCoord", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", 1}}}}}}).import();
  EXPECT_EQ(scene.materials.at(0).base_color_texture.uv_set, 1);
}

TEST(GltfTextures, EverySlot) {
  const json slot = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}}}}}};
  json normal = slot;
  normal["scale"] = 0.5;
  GltfBuilder file = textured(slot);
  json &m = file.root["materials"][0];
  m["pbrMetallicRoughness"]["metallicRoughnessTexture"] = m["emissiveTexture"] = m["occlusionTexture"] = slot;
  m["normalTexture"] = normal;
  m["extensions"] = {{"KHR_materials_transmission", {{"transmissionTexture", slot}}},
                     {"KHR_materials_specular", {{"specularTexture", slot}, {"specularColorTexture", slot}}}};
  const Scene scene = file.import();
  const Material &got = scene.materials.at(0);
  EXPECT_EQ(got.normal_scale, 0.5f);
  for (const TextureUse *use : {&got.base_color_texture, &got.metallic_roughness_texture, &got.normal_texture, &got.emission_texture,
                                &got.transmission_texture, &got.specular_texture, &got.specular_color_texture}) {
    EXPECT_EQ(use->texture, 0);
    EXPECT_EQ(use->transform[2], glm::vec2(0.5f, 0.25f));
  }
  EXPECT_EQ(scene.images.size(), 1u);
}

TEST(GltfTextures, FaultsInImagesAreWarnings) {
  for (const json &image : std::vector<json>{{{"uri", "none.png"}},
                                             {{"uri", "/etc/passwd"}},
                                             {{"uri", "../../x.png"}},
                                             {{"uri", "http://example.org/x.png"}},
                                             {{"uri", "data:image/png;base64,AAAA"}},
                                             {{"uri", "data:image/png;base64,A"}},
                                             {{"uri", "a%00b.png"}},
                                             {{"bufferView", 77}},
                                             json::object()}) {
    GltfBuilder file = textured({{"index", 0}});
    file.root["images"][0] = image;
    Notices notices;
    const Scene scene = file.import(notices);
    EXPECT_EQ(scene.textures.at(0).image, -1) << image;
    ASSERT_EQ(notices.all().size(), 1u) << image;
    EXPECT_TRUE(notices.all()[0].place.starts_with("test.glb: images[0]")) << notices.all()[0].place;
  }
}

TEST(GltfTextures, WebpAndBasisuFallBack) {
  GltfBuilder file = textured({{"index", 0}});
  file.root["images"].push_back({{"uri", "none.ktx2"}});
  file.root["textures"][0]["extensions"]["KHR_texture_basisu"]["source"] = 1;
  EXPECT_EQ(file.warnings(), std::vector<std::string>{"test.glb: KHR_texture_basisu is not supported: another image is read instead"});
  file.root["textures"][0]["extensions"] = {{"EXT_texture_webp", {{"source", 0}}}};
  file.root["textures"][0]["source"] = 1;
  EXPECT_EQ(file.import().textures.at(0).image, 0);
}

TEST(GltfUris, Base64IsStrict) {
  const auto text = [](std::string_view encoded) -> std::optional<std::string> {
    const auto bytes = gltf::decode_base64(encoded);
    if (!bytes) return {};
    return std::string(reinterpret_cast<const char *>(bytes->data()), bytes->size());
  };
  // RFC 4648, section 10.
  EXPECT_EQ(text(""), "");
  EXPECT_EQ(text("Zg=="), "f");
  EXPECT_EQ(text("Zm8="), "fo");
  EXPECT_EQ(text("Zm9v"), "foo");
  EXPECT_EQ(text("Zm9vYg=="), "foob");
  EXPECT_EQ(text("Zm9vYmE="), "fooba");
  EXPECT_EQ(text("Zm9vYmFy"), "foobar");
  for (const char *broken : {"Z", "Zg", "Zg=", "Zg===", "====", "Z===", "Zh==", "Zm9=", "Zm9v\n", "Zm 9", "Zg==Zg==", "Zm9_", "=Zg="})
    EXPECT_EQ(text(broken), std::nullopt) << broken;
}

TEST(GltfUris, PercentEncoding) {
  EXPECT_EQ(gltf::decode_percent("a%20b%2Fc%e2%9D%A4"), "a b/c\xe2\x9d\xa4");
  EXPECT_EQ(gltf::decode_percent("100%"), "100%");
  EXPECT_EQ(gltf::decode_percent("%zz%4"), "%zz%4");
}

}  // namespace
}  // namespace sunstone
