// SPDX-License-Identifier: Apache-2.0
// Valid files, damaged at random but always alike: each mutant gives a sound scene or an Error, never a crash. Meant for the sanitizers.
#include <gtest/gtest.h>

#include <random>

#include "base/file.h"
#include "host/import/gltf_builder.h"

namespace sunstone {
namespace {

std::vector<char> whole(const std::filesystem::path &path) {
  const std::vector<std::byte> data = read_file(path);
  return {reinterpret_cast<const char *>(data.data()), reinterpret_cast<const char *>(data.data()) + data.size()};
}

// A number of the generator's below n; std::uniform_int_distribution may differ between libraries.
std::size_t below(std::mt19937 &random, std::size_t n) { return random() % n; }

void damage(std::vector<char> &bytes, std::mt19937 &random) {
  if (bytes.empty()) return;
  switch (below(random, 6)) {
    case 0:
      bytes.resize(below(random, bytes.size()));
      break;
    case 1: {  // a digit for another, so that the JSON stays JSON
      for (int tries = 0; tries < 200; tries++) {
        char &c = bytes[below(random, bytes.size())];
        if (c >= '0' && c <= '9') {
          c = static_cast<char>('0' + below(random, 10));
          break;
        }
      }
      break;
    }
    case 2: {  // a piece twice
      const std::size_t at = below(random, bytes.size()), count = std::min(bytes.size() - at, 1 + below(random, 40));
      const std::vector<char> piece(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at + count));
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), piece.begin(), piece.end());
      break;
    }
    case 3: {  // a piece less
      const std::size_t at = below(random, bytes.size()), count = std::min(bytes.size() - at, 1 + below(random, 40));
      bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(at + count));
      break;
    }
    default:
      for (std::size_t n = 1 + below(random, 4); n > 0; n--) bytes[below(random, bytes.size())] ^= static_cast<char>(1 << below(random, 8));
  }
}

TEST(GltfMutants, NeverCrash) {
  const std::filesystem::path folder = std::filesystem::path(SUNSTONE_SOURCE_DIR) / "tests/data/malformed";
  std::vector<std::pair<std::string, std::vector<char>>> seeds;
  for (const char *name : {"valid-minimal.glb", "valid-glb-unknown-chunk.glb", "valid-negative-scale.gltf", "valid-zero-area-triangles.gltf",
                           "image-png-truncated.gltf", "sparse-index-out-of-range.gltf", "light-spot-inverted-cone.gltf"})
    seeds.emplace_back(name, whole(folder / name));
  {
    // One that has a little of everything.
    test::GltfBuilder file;
    file.primitive()["indices"] = file.accessor<std::uint8_t>("SCALAR", {0, 1, 2});
    file.primitive()["attributes"]["NORMAL"] = file.accessor<std::int8_t>("VEC3", {0, 0, 127, 0, 127, 0, 127, 0, 0}, true);
    file.primitive()["attributes"]["TANGENT"] = file.accessor<float>("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1});
    file.primitive()["attributes"]["COLOR_0"] = file.accessor<std::uint16_t>("VEC4", std::vector<std::uint16_t>(12, 65535), true);
    file.primitive()["targets"] = {{{"POSITION", file.accessor<float>("VEC3", std::vector<float>(9, 0.5f))}}};
    file.root["meshes"][0]["weights"] = {0.5};
    file.root["materials"] = {
        {{"extensions", {{"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 2}}}, {"KHR_materials_ior", {{"ior", 1.4}}}}}}};
    file.primitive()["material"] = 0;
    const int offsets = file.accessor<float>("VEC3", {1, 0, 0, 0, 1, 0});
    file.root["nodes"] = {{{"children", {1, 2}}},
                          {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", offsets}}}}}}}},
                          {{"mesh", 0}, {"rotation", {0, 0, 1, 1}}}};
    seeds.emplace_back("everything.glb", file.glb());
  }
  {
    // A skin whose joint is turned, a morph target whose weight changes, and something that goes along a spline.
    test::GltfBuilder file;
    const std::vector<float> unit = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::vector<float> twice = unit;
    twice.insert(twice.end(), unit.begin(), unit.end());
    file.root["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {0, 1, 0}}}, {{"mesh", 0}}};
    file.root["scenes"][0]["nodes"] = {0, 1, 3};
    file.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", file.accessor<float>("MAT4", twice)}}};
    file.primitive()["attributes"]["JOINTS_0"] = file.accessor<std::uint8_t>("VEC4", {0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    file.primitive()["attributes"]["WEIGHTS_0"] = file.accessor<std::uint8_t>("VEC4", {128, 127, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, true);
    file.primitive()["targets"] = {{{"POSITION", file.accessor<float>("VEC3", std::vector<float>(9, 0.5f))}}};
    const int times = file.accessor<float>("SCALAR", {0, 1, 2});
    const int turns = file.accessor<std::int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, 32767, 0, 32767, 0, 0, 0}, true), weights = file.accessor<std::uint8_t>("SCALAR", {0, 255, 0}, true);
    const int spline = file.accessor<float>("VEC3", std::vector<float>(27, 0.25f));
    file.root["animations"] = {{{"samplers", {{{"input", times}, {"output", turns}}, {{"input", times}, {"output", weights}, {"interpolation", "STEP"}},
                                              {{"input", times}, {"output", spline}, {"interpolation", "CUBICSPLINE"}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}, {{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}},
                                              {{"sampler", 2}, {"target", {{"node", 3}, {"path", "translation"}}}}}}}};
    file.options.time = 0.75;
    EXPECT_EQ(file.import().instances.size(), 2u);
    seeds.emplace_back("moving.glb", file.glb());
  }
  const test::TemporaryFolder temporary;
  std::mt19937 random(1);
  std::size_t imported = 0, refused = 0, moving = 0;
  for (int mutant = 0; mutant < 2700; mutant++) {
    auto [name, bytes] = seeds[static_cast<std::size_t>(mutant) % seeds.size()];
    for (std::size_t n = 1 + below(random, 3); n > 0; n--) damage(bytes, random);
    const std::filesystem::path path = temporary.write(name, bytes);
    Notices notices;
    try {
      ImportOptions options;
      if (name == "moving.glb") {
        options.time = 0.75;
        options.shutter = 0.5;
      }
      const Scene scene = import_scene(path, options, notices);
      for (const Instance &instance : scene.instances) ASSERT_LT(static_cast<std::size_t>(instance.mesh), scene.meshes.size());
      moving += scene.motion_steps > 0;
      imported++;
    } catch (const Error &error) {
      ASSERT_NE(std::string(error.what()), "");
      refused++;
    }
  }
  // Neither all alike: the mutants reach the parts behind the JSON.
  EXPECT_GT(imported, 100u);
  EXPECT_GT(refused, 100u);
  EXPECT_GT(moving, 5u);
  RecordProperty("imported", static_cast<int>(imported));
  RecordProperty("refused", static_cast<int>(refused));
}

}  // namespace
}  // namespace sunstone
