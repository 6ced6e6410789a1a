// SPDX-License-Identifier: Apache-2.0
// Every scene of tests/data/malformed ends as the table of its README says.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "base/error.h"
#include "import/import.h"

namespace sunstone {
namespace {

struct Case {
  std::string file, verdict;
};
void PrintTo(const Case &c, std::ostream *out) { *out << c.file << " (" << c.verdict << ")"; }

std::filesystem::path malformed_folder() { return std::filesystem::path(SUNSTONE_SOURCE_DIR) / "tests/data/malformed"; }

// Rows "| `name` | VERDICT | ..." whose file is a scene.
std::vector<Case> cases() {
  std::vector<Case> out;
  std::ifstream in(malformed_folder() / "README.md");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| `")) continue;
    const std::size_t end = line.find('`', 3);
    const std::string file = line.substr(3, end - 3), rest = line.substr(end + 4);
    const std::string suffix = std::filesystem::path(file).extension();
    if (suffix == ".gltf" || suffix == ".glb" || suffix == ".obj") out.push_back({file, rest.substr(0, rest.find(' '))});
  }
  return out;
}

// What a refusal has to name, where the table asks for more than the file.
const std::map<std::string, std::string> &named() {
  static const std::map<std::string, std::string> places = {
      {"glb-empty.glb", "empty"},
      {"glb-header-only.glb", "cut off"},
      {"glb-truncated-json.glb", "cut off"},
      {"glb-truncated-bin-header.glb", "cut off"},
      {"glb-truncated-bin.glb", "cut off"},
      {"glb-wrong-magic.glb", "not a GLB file"},
      {"glb-version-1.glb", "version 1 is not supported"},
      {"glb-bin-before-json.glb", "the first chunk has to be JSON"},
      {"json-not-json.gltf", "at byte"},
      {"json-deep-nesting.gltf", "extras[0][0]"},
      {"json-wrong-types.gltf", ": nodes: "},
      {"json-duplicate-keys.gltf", ": scene: "},
      {"json-number-overflow.gltf", "cameras[0].perspective.yfov"},
      {"json-name-not-utf8.gltf", "nodes[0].name"},
      {"json-version-1.gltf", "glTF 1.0 is not supported"},
      {"json-no-asset.gltf", "asset.version: is missing"},
      {"buffer-missing-file.gltf", "no-such-file.bin"},
      {"buffer-uri-absolute.gltf", "buffers[0].uri"},
      {"buffer-uri-traversal.gltf", "buffers[0].uri"},
      {"buffer-data-uri-bad-base64.gltf", "buffers[0].uri: broken data URI"},
      {"buffer-shorter-than-declared.gltf", "buffers[0]: byteLength is 100000, but the data has 92 bytes"},
      {"bufferview-out-of-range.gltf", "bufferViews[2]"},
      {"bufferview-offset-overflow.gltf", "bufferViews[0]"},
      {"accessor-beyond-view.gltf", "accessors[0]"},
      {"accessor-count-1e9.gltf", "accessors[0]"},
      {"accessor-count-2p53.gltf", "accessors[0].count"},
      {"accessor-count-negative.gltf", "accessors[2].count"},
      {"accessor-unknown-component.gltf", "accessors[0].componentType: 5124"},
      {"accessor-stride-too-small.gltf", "bufferViews[0].byteStride"},
      {"sparse-index-out-of-range.gltf", "accessors[0].sparse.indices: index 900"},
      {"sparse-count-huge.gltf", "accessors[0].sparse.count"},
      {"index-out-of-range.gltf", "meshes[0].primitives[0].indices: index 60000, but there are 4 vertices"},
      {"index-component-float.gltf", "accessors[2].componentType"},
      {"mesh-no-primitives.gltf", "meshes[0].primitives"},
      {"mesh-attribute-counts-differ.gltf", "meshes[0].primitives[0].attributes.TEXCOORD_0"},
      {"node-cycle.gltf", "nodes["},
      {"node-two-parents.gltf", "nodes["},
      {"node-mesh-out-of-range.gltf", "nodes[0].mesh: index 9, but there is 1 mesh"},
      {"node-matrix-15.gltf", "nodes[0].matrix"},
      {"node-matrix-nan.gltf", "nodes[0].matrix[0]: broken JSON at byte"},
      {"scene-out-of-range.gltf", ": scene: index 4, but there is 1 scene"},
      {"camera-yfov-zero.gltf", "cameras[0].perspective.yfov"},
      {"camera-aspect-negative.gltf", "cameras[0].perspective.aspectRatio"},
      {"light-index-out-of-range.gltf", "nodes[2].extensions.KHR_lights_punctual.light: index 3"},
      {"material-out-of-range.gltf", "meshes[0].primitives[0].material: index 5"},
      {"material-texture-missing.gltf", "materials[0].emissiveTexture.index: index 2"},
      {"extension-required-unknown.gltf", "VENDOR_unheard_of"},
  };
  return places;
}

bool one_line_of_text(const std::string &text) {
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return false;
  return text.size() < 1000;
}

// Nothing that flatten reads may be out of range or not finite, apart from triangles that no index uses any more.
void expect_sound(const Scene &scene) {
  for (const Instance &instance : scene.instances) {
    ASSERT_LT(static_cast<std::size_t>(instance.mesh), scene.meshes.size());
    for (int c = 0; c < 4; c++)
      for (int r = 0; r < 3; r++) EXPECT_TRUE(std::isfinite(instance.transform[c][r]));
  }
  for (const Mesh &mesh : scene.meshes) {
    for (const Primitive &primitive : mesh.primitives) {
      for (const std::uint32_t index : primitive.indices) {
        ASSERT_LT(index, primitive.positions.size());
        for (int c = 0; c < 3; c++) EXPECT_TRUE(std::isfinite(primitive.positions[index][c]));
      }
      EXPECT_LT(primitive.material, static_cast<int>(scene.materials.size()));
    }
  }
  for (const Light &light : scene.lights)
    for (int c = 0; c < 3; c++) EXPECT_GE(light.intensity[c], 0.0f);
  for (const Material &material : scene.materials) {
    for (int c = 0; c < 3; c++) {
      EXPECT_GE(material.emission[c], 0.0f);
      EXPECT_TRUE(material.base_color[c] >= 0 && material.base_color[c] <= 1) << material.base_color[c];
      EXPECT_TRUE(material.f0[c] >= 0 && material.f0[c] <= 1);
    }
    EXPECT_TRUE(material.roughness >= 0 && material.roughness <= 1);
    EXPECT_TRUE(material.metallic >= 0 && material.metallic <= 1);
  }
}

class Malformed : public testing::TestWithParam<Case> {};

TEST_P(Malformed, EndsAsItsVerdictSays) {
  const auto &[file, verdict] = GetParam();
  Notices notices;
  std::size_t warnings = 0;
  std::string refusal;
  try {
    const Scene scene = import_scene(malformed_folder() / file, {}, notices);
    expect_sound(scene);
  } catch (const Error &error) {
    refusal = error.what();
  }
  for (const Notice &notice : notices.all()) {
    EXPECT_TRUE(one_line_of_text(notice.place + notice.text)) << notice.text;
    warnings += notice.kind == Notice::Kind::warning;
  }
  if (verdict == "REFUSE") {
    ASSERT_FALSE(refusal.empty());
  } else if (verdict == "VALID") {
    EXPECT_EQ(refusal, "");
    EXPECT_EQ(warnings, file == "valid-extension-used-unknown.gltf" ? 1u : 0u);
  } else if (verdict == "WARN") {
    EXPECT_TRUE(!refusal.empty() || warnings > 0);
  } else {
    ASSERT_EQ(verdict, "EITHER");
  }
  if (!refusal.empty()) {
    EXPECT_TRUE(one_line_of_text(refusal)) << refusal;
    const auto place = named().find(file);
    EXPECT_NE(refusal.find(file), std::string::npos) << refusal;
    if (place != named().end()) {
      EXPECT_NE(refusal.find(place->second), std::string::npos) << refusal;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Malformed, testing::ValuesIn(cases()), [](const testing::TestParamInfo<Case> &info) {
  std::string name = info.param.file;
  for (char &c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

TEST(MalformedTable, HasEveryScene) { EXPECT_EQ(cases().size(), 91u); }

}  // namespace
}  // namespace sunstone
