// SPDX-License-Identifier: Apache-2.0
// Real models: each loads with the number of triangles that its table states, or is refused for the extension that it requires.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "import/import.h"

namespace sunstone {
namespace {

std::filesystem::path scenes_folder() {
  const char *given = std::getenv("SUNSTONE_SCENES");
  return given && *given ? std::filesystem::path(given) : std::filesystem::path(SUNSTONE_SOURCE_DIR) / "../shared/scenes";
}

std::string trimmed(const std::string &text) {
  const std::size_t first = text.find_first_not_of(" `"), last = text.find_last_not_of(" `");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

// The rows of the README's tables: cells of lines that begin with "| `".
std::vector<std::vector<std::string>> table_rows(const std::filesystem::path &readme) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream in(readme);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) cells.push_back(trimmed(cell));
    rows.push_back(cells);
  }
  return rows;
}

// "292 (232)" or "1,040,409": the flattened number.
std::size_t number(const std::string &text) {
  std::size_t value = 0;
  for (const char c : text) {
    if (c >= '0' && c <= '9')
      value = value * 10 + static_cast<std::size_t>(c - '0');
    else if (c != ',')
      break;
  }
  return value;
}

std::size_t flattened_triangles(const Scene &scene) {
  std::size_t count = 0;
  for (const Instance &instance : scene.instances)
    for (const Primitive &primitive : scene.meshes.at(static_cast<std::size_t>(instance.mesh)).primitives) count += primitive.indices.size() / 3;
  return count;
}

class GltfScenes : public testing::Test {
 protected:
  void SetUp() override {
    folder = scenes_folder() / "gltf";
    if (!std::filesystem::exists(folder / "README.md")) GTEST_SKIP() << "SKIP: no scenes at " << folder << "; set SUNSTONE_SCENES";
    rows = table_rows(folder / "README.md");
  }
  std::filesystem::path folder;
  std::vector<std::vector<std::string>> rows;
};

TEST_F(GltfScenes, HaveTheirNumberOfTriangles) {
  std::size_t loaded = 0, refused = 0;
  for (const auto &row : rows) {
    if (row[0].starts_with("compressed/")) continue;
    SCOPED_TRACE(row[0]);
    Notices notices;
    try {
      const Scene scene = import_scene(folder / row[0], {}, notices);
      // The table counts both scenes of this one, and `scene` names the second, a square.
      EXPECT_EQ(flattened_triangles(scene), row[0].starts_with("MultipleScenes/") ? 2 : number(row[2]));
      for (const Texture &texture : scene.textures) EXPECT_GE(texture.image, 0);
      loaded++;
    } catch (const Error &error) {
      EXPECT_NE(std::string(error.what()).find("extensionsRequired[0]: the file requires KHR_materials_iridescence"), std::string::npos)
          << error.what();
      refused++;
    }
  }
  EXPECT_GE(loaded, 44u);
  EXPECT_EQ(refused, 1u);  // IridescenceSuzanne
}

TEST_F(GltfScenes, CompressedOnesLoadOrNameTheExtension) {
  const std::vector<std::string> decodable = {"KHR_mesh_quantization", "EXT_texture_webp", "KHR_materials_pbrSpecularGlossiness"};
  std::size_t loaded = 0, refused = 0;
  for (const auto &row : rows) {
    if (!row[0].starts_with("compressed/")) continue;
    SCOPED_TRACE(row[0]);
    const bool expected = std::any_of(decodable.begin(), decodable.end(), [&](const std::string &name) { return row[1].starts_with(name); });
    Notices notices;
    try {
      const Scene scene = import_scene(folder / row[0], {}, notices);
      EXPECT_TRUE(expected);
      EXPECT_EQ(flattened_triangles(scene), row[0].find("Duck") != std::string::npos ? 4212u : 12u);
      for (const Texture &texture : scene.textures) EXPECT_GE(texture.image, 0);
      loaded++;
    } catch (const Error &error) {
      EXPECT_FALSE(expected) << error.what();
      const std::string extension = row[1].substr(0, row[1].find_first_of(" ,"));
      EXPECT_NE(std::string(error.what()).find(extension), std::string::npos) << error.what();
      refused++;
    }
  }
  EXPECT_EQ(loaded, 4u);
  EXPECT_EQ(refused, 5u);
}

TEST_F(GltfScenes, WarningsNameWhatIsNotRendered) {
  const auto warnings = [&](const char *file) {
    Notices notices;
    import_scene(folder / file, {}, notices);
    std::vector<std::string> texts;
    for (const Notice &notice : notices.all())
      if (notice.kind == Notice::Kind::warning) texts.push_back(notice.text);
    return texts;
  };
  using Texts = std::vector<std::string>;
  EXPECT_EQ(warnings("BoxTextured/BoxTextured.glb"), Texts{});
  EXPECT_EQ(warnings("SimpleInstancing/SimpleInstancing.glb"), Texts{});
  EXPECT_EQ(warnings("compressed/BoxTextured-SpecGloss/BoxTextured.gltf"), Texts{"KHR_materials_pbrSpecularGlossiness is not rendered"});
  EXPECT_EQ(warnings("ClearCoatTest/ClearCoatTest.glb"), Texts{"KHR_materials_clearcoat is not rendered"});
  EXPECT_EQ(warnings("SimpleSkin/SimpleSkin.gltf"), Texts{});
}

// Morph targets, a skin and 100 skins in one tree of joints: the same at one time, another at another, and what stands still stands.
TEST_F(GltfScenes, MoveWithTime) {
  const auto vertices = [&](const char *file, std::optional<double> time) {
    Notices notices;
    ImportOptions options;
    options.time = time;
    const Scene scene = import_scene(folder / file, options, notices);
    for (const Notice &notice : notices.all()) EXPECT_EQ(notice.kind, Notice::Kind::note) << file << ": " << notice.text;
    std::vector<glm::vec3> all;
    for (const Instance &instance : scene.instances)
      for (const Primitive &primitive : scene.meshes.at(static_cast<std::size_t>(instance.mesh)).primitives)
        all.insert(all.end(), primitive.positions.begin(), primitive.positions.end());
    return all;
  };
  for (const char *file : {"AnimatedMorphCube/AnimatedMorphCube.glb", "SimpleSkin/SimpleSkin.gltf", "RecursiveSkeletons/RecursiveSkeletons.glb"}) {
    SCOPED_TRACE(file);
    const std::vector<glm::vec3> rest = vertices(file, {}), early = vertices(file, 0.7), late = vertices(file, 1.2);
    EXPECT_EQ(early, vertices(file, 0.7));
    EXPECT_NE(early, late);
    EXPECT_EQ(early.size(), rest.size());
    EXPECT_EQ(vertices(file, 1000), vertices(file, 2000));
  }
  // Two corners of this strip belong to the joint that stands still; the last two have been turned by a quarter about (0, 1, 0) after a second.
  const std::vector<glm::vec3> rest = vertices("SimpleSkin/SimpleSkin.gltf", {}), bent = vertices("SimpleSkin/SimpleSkin.gltf", 1);
  for (std::size_t i = 0; i < 2; i++) EXPECT_EQ(rest.at(i), bent.at(i)) << i;
  EXPECT_LT(glm::distance(bent.at(8), glm::vec3(-1, 0.5f, 0)), 1e-6f);
  EXPECT_LT(glm::distance(bent.at(9), glm::vec3(-1, 1.5f, 0)), 1e-6f);
}

}  // namespace
}  // namespace sunstone
