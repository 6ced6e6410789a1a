// SPDX-License-Identifier: Apache-2.0
// The table of docs/obj-materials.md, and the options of textures.
#include <cmath>
#include <set>

#include "host/image/pictures.h"
#include "host/import/obj_files.h"
#include "import/obj_materials.h"

using namespace sunstone;
using namespace sunstone::test;

namespace {

const std::string triangle = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n";

Material material(const std::string &mtl) {
  const Imported in = import_text(triangle, "newmtl a\n" + mtl + "\n");
  EXPECT_EQ(in.error, "");
  EXPECT_EQ(in.warnings(), 0) << mtl << ": " << (in.notices.empty() ? "" : in.notices[0].text);
  return in.scene.materials.at(in.only().material);
}

// The guarded line of one statement of one material.
std::string guarded(const std::string &line) {
  GuardedMtl out;
  LineFaults faults("m.mtl");
  guard_mtl("newmtl a\n" + line + "\n", out, faults);
  const std::size_t at = out.text.find('\n');
  return out.text.substr(at + 1);
}

void write_png(const Folder &folder, const std::string &name, int channels) {
  const Encoded png = encode("png", 4, 4, channels, OIIO::TypeDesc::UINT8, byte_pattern(4, 4, channels));
  folder.write(name, {reinterpret_cast<const char *>(png.data()), png.size()});
}

}  // namespace

TEST(ObjMaterial, DiffuseIgnoresKs) {
  for (const char *model : {"illum 0", "illum 1"}) {
    const Material m = material(std::string("Kd 0.1 0.2 0.3\nKs 1 1 1\nNs 50\n") + model);
    EXPECT_EQ(m.base_color, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.f0, glm::vec3(0));
    EXPECT_EQ(m.f90, 0);
    EXPECT_EQ(m.roughness, 1);
    EXPECT_TRUE(m.double_sided);
  }
}

TEST(ObjMaterial, GlossyTakesItsRoughnessFromTheExponent) {
  const Material m = material("Kd 0.1 0.2 0.3\nKs 0.5\nNs 48\nillum 2");
  EXPECT_EQ(m.f0, glm::vec3(0.5f));
  EXPECT_EQ(m.f90, 1);
  EXPECT_NEAR(m.roughness * m.roughness, std::sqrt(2.0 / 50), 1e-6);
  EXPECT_EQ(material("Kd 1 1 1\nKs 0 0 0\nillum 2").f90, 0);
}

TEST(ObjMaterial, MirrorsAreSmoothMetals) {
  const Material m = material("Kd 0.01 0.01 0.01\nKs 0.95 0.9 0.8\nNs 1000\nillum 5");
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.roughness, 0);
  EXPECT_EQ(m.base_color, glm::vec3(0.95f, 0.9f, 0.8f));
  EXPECT_EQ(material("Kd 0.9 0.9 0.9\nKs 0.1 0.1 0.1\nillum 3").metallic, 0);
}

TEST(ObjMaterial, GlassIsSolidAndTfIsWhatABodyLetsThrough) {
  for (const char *model : {"4", "6", "7", "9"}) {
    const Material m = material(std::string("Kd 0.01 0.01 0.01\nTf 0.25 1 0.04\nNs 200\nNi 2.5\nd 0.1\nillum ") + model);
    EXPECT_EQ(m.transmission, 1);
    EXPECT_TRUE(m.volume);
    EXPECT_EQ(m.ior, 2.5f);
    EXPECT_EQ(m.roughness, 0);
    EXPECT_EQ(m.alpha, 1);
    EXPECT_NEAR(m.base_color.x * m.base_color.x, 0.25f, 1e-6);
    EXPECT_NEAR(m.base_color.z * m.base_color.z, 0.04f, 1e-6);
    EXPECT_NEAR(m.f0.x, std::pow(1.5 / 3.5, 2), 1e-6);
  }
}

TEST(ObjMaterial, DWinsOverTrInEitherOrder) {
  EXPECT_EQ(material("d 0.75\nTr 0.5").alpha, 0.75f);
  EXPECT_EQ(material("Tr 0.5\nd 0.75").alpha, 0.75f);
  EXPECT_EQ(material("Tr 0.25").alpha, 0.75f);
  EXPECT_EQ(material("Tr 0.25").alpha_mode, AlphaMode::blend);
  EXPECT_EQ(material("d 1").alpha_mode, AlphaMode::opaque);
}

TEST(ObjMaterial, PbrExtensionIsUsed) {
  const Material m = material("Kd 1 1 1\nKs 0 0 0\nKe 0.1 0.2 0.3\nPr 0.2\nPm 0.3");
  EXPECT_EQ(m.roughness, 0.2f);
  EXPECT_EQ(m.metallic, 0.3f);
  EXPECT_EQ(m.f0, glm::vec3(0.04f));
  EXPECT_EQ(m.emission, glm::vec3(0.1f, 0.2f, 0.3f));
}

TEST(ObjMaterial, NamesMayHoldBlanksAndTheFirstOfTwoWins) {
  const Imported in = import_text("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl my red one\nf 1 2 3\n",
                                  "newmtl my red one\nKd 1 0 0\nnewmtl my red one\nKd 0 1 0\n");
  EXPECT_EQ(in.scene.materials.at(in.only().material).base_color, glm::vec3(1, 0, 0));
  EXPECT_EQ(in.warnings("name that was there before"), 1);
}

TEST(ObjMaterial, OptionsOfTexturesAreFoundBeforeAndAfterTheName) {
  EXPECT_EQ(guarded("map_Kd -o 0.1 diffuse.jpg"), "map_Kd -o 0.1 0 0 -s 1 1 1 -bm 1 diffuse.jpg\n");
  EXPECT_EQ(guarded("map_Ks -s 0.5 2 specular.jpg"), "map_Ks -o 0 0 0 -s 0.5 2 1 -bm 1 specular.jpg\n");
  EXPECT_EQ(guarded("map_Kd -clamp on -texres 512 -blendu off in.jpg"), "map_Kd -o 0 0 0 -s 1 1 1 -bm 1 -clamp on in.jpg\n");
  EXPECT_EQ(guarded("norm -imfchan r a b.png -bm 1.5"), "norm -o 0 0 0 -s 1 1 1 -bm 1.5 -imfchan r a b.png\n");
  EXPECT_EQ(guarded("map_d -type sphere -mm 0.1 0.3 -t 1 2 3 alpha.jpg"), "map_d -o 0 0 0 -s 1 1 1 -bm 1 alpha.jpg\n");
  EXPECT_EQ(guarded("map_Kd .\\maps\\a.jpg"), "map_Kd -o 0 0 0 -s 1 1 1 -bm 1 ./maps/a.jpg\n");
  EXPECT_EQ(guarded("map_Kd -o"), "");
}

TEST(ObjMaterial, TexturesAreReadOnceAndTransformed) {
  const Folder folder;
  write_png(folder, "a.png", 3);
  folder.write("m.mtl", "newmtl a\nmap_Kd -o 0.25 0.5 -s 2 3 a.png\nmap_Ke a.png\nnorm -bm 0.5 -clamp on .\\a.png\nmap_Pr a.png\nmap_Pm a.png\n");
  const Imported in = import_file(folder.write("s.obj", triangle));
  EXPECT_EQ(in.warnings(), 0);
  const Material &m = in.scene.materials.at(0);
  ASSERT_TRUE(bool(m.base_color_texture));
  // In OBJ's terms (u, v) is looked up at (2 u + 0.25, 3 v + 0.5); rows run down with us.
  for (const glm::vec2 &uv : {glm::vec2(0, 0), glm::vec2(0.3f, 0.8f)}) {
    const glm::vec2 got = m.base_color_texture.transform * glm::vec3(uv.x, 1 - uv.y, 1);
    EXPECT_NEAR(got.x, 2 * uv.x + 0.25f, 1e-6);
    EXPECT_NEAR(1 - got.y, 3 * uv.y + 0.5f, 1e-6);
  }
  EXPECT_EQ(m.base_color, glm::vec3(1));
  EXPECT_EQ(m.emission, glm::vec3(1));
  EXPECT_EQ(m.normal_scale, 0.5f);
  EXPECT_EQ(in.scene.textures[m.normal_texture.texture].wrap_u, Wrap::clamp);
  EXPECT_EQ(in.scene.textures[m.emission_texture.texture].image, in.scene.textures[m.base_color_texture.texture].image);
  const Image &both = in.scene.images[in.scene.textures[m.metallic_roughness_texture.texture].image];
  ASSERT_EQ(both.channels, 3);
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(both.pixels)[4], byte_pattern(4, 4, 3)[3]);  // green of the second pixel: red of the picture
}

TEST(ObjMaterial, AlphaMapsTakeTheChannelThatIsMeant) {
  const Folder folder;
  write_png(folder, "rgba.png", 4);
  write_png(folder, "rgb.png", 3);
  const struct {
    const char *line;
    int channels, channel;
  } cases[] = {{"map_d rgba.png", 4, 3}, {"map_d -imfchan g rgba.png", 4, 1}, {"map_d rgb.png", 3, 0}, {"map_d -imfchan b rgb.png", 3, 2}};
  for (const auto &c : cases) {
    folder.write("m.mtl", std::string("newmtl a\n") + c.line + "\n");
    const Imported in = import_file(folder.write("s.obj", triangle));
    const Material &m = in.scene.materials.at(0);
    ASSERT_TRUE(bool(m.alpha_texture)) << c.line;
    EXPECT_EQ(m.alpha_mode, AlphaMode::blend);
    const Image &image = in.scene.images[in.scene.textures[m.alpha_texture.texture].image];
    ASSERT_EQ(image.channels, 1);
    EXPECT_EQ(std::get<std::vector<std::uint8_t>>(image.pixels)[5], byte_pattern(4, 4, c.channels)[5 * c.channels + c.channel]) << c.line;
  }
}

TEST(ObjMaterial, WhatIsNotRenderedIsSaidOnce) {
  const Imported in = import_text(triangle, "newmtl a\nbump a.png\nmap_Bump a.png\nPs 1\nmap_Ps x\nmap_Ns x\nrefl x\nwhat 1\never 2\n");
  EXPECT_EQ(in.warnings("bump maps"), 1);
  EXPECT_EQ(in.warnings("sheen"), 1);
  EXPECT_EQ(in.warnings("not a statement of MTL: ignored (and 1 more)"), 1);
  EXPECT_EQ(in.warnings(), 5);
}

TEST(ObjMaterial, PathsThatLeadOutAreNotOpened) {
  const Imported in = import_text(triangle, "newmtl a\nmap_Kd /etc/passwd\nmap_Ke ..\\..\\etc\\passwd\nnorm C:\\x.png\n");
  EXPECT_EQ(in.warnings("absolute path and is not read"), 2);
  EXPECT_EQ(in.warnings("outside the scene's folder"), 1);
  EXPECT_EQ(in.triangles(), 1u);
  EXPECT_TRUE(in.scene.images.empty());
}
