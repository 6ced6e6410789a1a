// SPDX-License-Identifier: Apache-2.0
// The glTF importer by small files: accessors, primitives, nodes, cameras, lights.
#include <gtest/gtest.h>

#include <cmath>

#include "host/import/gltf_builder.h"

namespace sunstone {
namespace {

using nlohmann::json;
using test::GltfBuilder;
using Indices = std::vector<std::uint32_t>;

const Primitive &only_primitive(const Scene &scene) {
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes.at(0).primitives.size(), 1u);
  return scene.meshes.at(0).primitives.at(0);
}

void expect_near(const glm::mat4x3 &got, const glm::mat4x3 &want, float tolerance) {
  for (int c = 0; c < 4; c++)
    for (int r = 0; r < 3; r++) EXPECT_NEAR(got[c][r], want[c][r], tolerance) << "column " << c << ", row " << r;
}

TEST(GltfAccessors, PlainTriangle) {
  const Scene scene = GltfBuilder().import();
  const Primitive &p = only_primitive(scene);
  EXPECT_EQ(p.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(p.indices, (Indices{0, 1, 2}));
  EXPECT_TRUE(p.normals.empty());
  EXPECT_EQ(p.material, -1);
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.name, "test");
}

// Component types of texture coordinates: integers as they are, or normalised by the rule of the specification's table.
template <class T>
std::vector<glm::vec2> read_uv(const std::vector<T> &values, bool normalized) {
  GltfBuilder file;
  file.primitive()["attributes"]["TEXCOORD_0"] = file.accessor("VEC2", values, normalized);
  return only_primitive(file.import()).uv[0];
}

TEST(GltfAccessors, EveryComponentType) {
  EXPECT_EQ(read_uv<std::int8_t>({-128, 127, -127, 0, 1, 64}, true), (std::vector<glm::vec2>{{-1, 1}, {-1, 0}, {1 / 127.0f, 64 / 127.0f}}));
  EXPECT_EQ(read_uv<std::uint8_t>({0, 255, 51, 1, 2, 3}, true), (std::vector<glm::vec2>{{0, 1}, {0.2f, 1 / 255.0f}, {2 / 255.0f, 3 / 255.0f}}));
  EXPECT_EQ(read_uv<std::int16_t>({-32768, 32767, 1, 0, 0, 0}, true), (std::vector<glm::vec2>{{-1, 1}, {1 / 32767.0f, 0}, {0, 0}}));
  EXPECT_EQ(read_uv<std::uint16_t>({0, 65535, 1, 0, 0, 0}, true), (std::vector<glm::vec2>{{0, 1}, {1 / 65535.0f, 0}, {0, 0}}));
  EXPECT_EQ(read_uv<std::int8_t>({-128, 127, 0, 0, 0, 0}, false)[0], glm::vec2(-128, 127));
  EXPECT_EQ(read_uv<std::uint8_t>({200, 7, 0, 0, 0, 0}, false)[0], glm::vec2(200, 7));
  EXPECT_EQ(read_uv<std::int16_t>({-32768, 32767, 0, 0, 0, 0}, false)[0], glm::vec2(-32768, 32767));
  EXPECT_EQ(read_uv<std::uint16_t>({65535, 7, 0, 0, 0, 0}, false)[0], glm::vec2(65535, 7));
  EXPECT_EQ(read_uv<float>({0.25f, -3.5f, 0, 0, 0, 0}, false)[0], glm::vec2(0.25f, -3.5f));
}

template <class T>
void expect_indices() {
  GltfBuilder file;
  file.primitive()["indices"] = file.accessor<T>("SCALAR", {2, 0, 1, 0, 2, 1});
  EXPECT_EQ(only_primitive(file.import()).indices, (Indices{2, 0, 1, 0, 2, 1}));
}

TEST(GltfAccessors, EveryIndexType) {
  expect_indices<std::uint8_t>();
  expect_indices<std::uint16_t>();
  expect_indices<std::uint32_t>();
}

TEST(GltfAccessors, Strided) {
  GltfBuilder file;
  // Positions and texture coordinates interleaved in one view: 20 bytes a vertex.
  const int view = file.view<float>({0, 0, 0, 5, 6, 2, 0, 0, 7, 8, 0, 2, 0, 9, 10});
  file.root["bufferViews"][view]["byteStride"] = 20;
  json &accessors = file.root["accessors"];
  accessors.push_back({{"bufferView", view}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
  accessors.push_back({{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5126}, {"type", "VEC2"}, {"count", 3}});
  file.primitive()["attributes"] = {{"POSITION", 1}, {"TEXCOORD_1", 2}};
  const Scene scene = file.import();
  EXPECT_EQ(only_primitive(scene).positions, (std::vector<glm::vec3>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}));
  EXPECT_EQ(only_primitive(scene).uv[1], (std::vector<glm::vec2>{{5, 6}, {7, 8}, {9, 10}}));
  // The last element needs no whole stride behind it, but one more element does not fit.
  accessors[2]["count"] = 4;
  EXPECT_NE(file.refusal().find("accessors[2]"), std::string::npos);
}

TEST(GltfAccessors, Sparse) {
  GltfBuilder file;
  const int indices = file.view<std::uint8_t>({0, 2}), values = file.view<float>({9, 9, 9, 7, 8, 9});
  file.root["accessors"][0]["sparse"] = {
      {"count", 2}, {"indices", {{"bufferView", indices}, {"componentType", 5121}}}, {"values", {{"bufferView", values}}}};
  EXPECT_EQ(only_primitive(file.import()).positions, (std::vector<glm::vec3>{{9, 9, 9}, {1, 0, 0}, {7, 8, 9}}));
  // Over zeros, where there is no view.
  file.root["accessors"][0].erase("bufferView");
  EXPECT_EQ(only_primitive(file.import()).positions, (std::vector<glm::vec3>{{9, 9, 9}, {0, 0, 0}, {7, 8, 9}}));
  // Descending indices.
  file.root["accessors"][0]["sparse"]["indices"]["bufferView"] = file.view<std::uint8_t>({2, 0});
  EXPECT_NE(file.refusal().find("accessors[0].sparse.indices: they do not ascend"), std::string::npos);
}

TEST(GltfAccessors, HugeCountsWithoutDataAreRefused) {
  GltfBuilder file;
  file.root["accessors"][0].erase("bufferView");
  file.root["accessors"][0]["count"] = 4000000000u;
  EXPECT_NE(file.refusal().find("accessors[0]"), std::string::npos);
}

TEST(GltfAccessors, QuantizedMesh) {
  GltfBuilder file;
  file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  file.primitive()["attributes"]["POSITION"] = file.accessor<std::int16_t>("VEC3", {0, 0, 0, 100, 0, 0, 0, -32767, 0});
  file.primitive()["attributes"]["NORMAL"] = file.accessor<std::int8_t>("VEC3", {0, 0, 127, 0, 127, 127, 0, 0, -127}, true);
  const Scene scene = file.import();
  EXPECT_EQ(only_primitive(scene).positions[2], glm::vec3(0, -32767, 0));
  EXPECT_EQ(only_primitive(scene).normals[0], glm::vec3(0, 0, 1));
  EXPECT_NEAR(only_primitive(scene).normals[1].y, std::sqrt(0.5f), 1e-6f);
}

TEST(GltfPrimitives, StripsAndFans) {
  GltfBuilder file;
  file.primitive()["indices"] = file.accessor<std::uint8_t>("SCALAR", {0, 1, 2, 1, 0});
  file.primitive()["mode"] = 5;  // glTF 2.0, 3.7.2.1: (v0 v1 v2) (v1 v3 v2) (v2 v3 v4)
  EXPECT_EQ(only_primitive(file.import()).indices, (Indices{0, 1, 2, 1, 1, 2, 2, 1, 0}));
  file.primitive()["mode"] = 6;  // (v1 v2 v0) (v2 v3 v0) (v3 v4 v0)
  EXPECT_EQ(only_primitive(file.import()).indices, (Indices{1, 2, 0, 2, 1, 0, 1, 0, 0}));
}

TEST(GltfPrimitives, LinesAndPointsAreSkippedWithOneWarningEach) {
  GltfBuilder file;
  for (int i = 0; i < 3; i++)
    for (int mode = 0; mode < 4; mode++) file.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
  Notices notices;
  const Scene scene = file.import(notices);
  EXPECT_EQ(only_primitive(scene).indices.size(), 3u);
  EXPECT_EQ(notices.all().size(), 2u);
}

TEST(GltfPrimitives, Colours) {
  GltfBuilder file;
  file.primitive()["attributes"]["COLOR_0"] = file.accessor<std::uint8_t>("VEC4", {255, 0, 51, 255, 0, 0, 0, 0, 255, 255, 255, 51}, true);
  EXPECT_EQ(only_primitive(file.import()).colors, (std::vector<glm::vec4>{{1, 0, 0.2f, 1}, {0, 0, 0, 0}, {1, 1, 1, 0.2f}}));
  file.primitive()["attributes"]["COLOR_0"] = file.accessor<float>("VEC3", {0.5f, 2, 0, 0, 0, 0, 1, 1, 1});
  EXPECT_EQ(only_primitive(file.import()).colors[0], glm::vec4(0.5f, 2, 0, 1));
}

TEST(GltfPrimitives, NormalsWithoutDirectionAreThoseOfTheFaces) {
  GltfBuilder file;
  file.primitive()["attributes"]["NORMAL"] = file.accessor<float>("VEC3", {0, 0, 0, 0, 3, 0, NAN, 0, 0});
  Notices notices;
  const Scene scene = file.import(notices);
  EXPECT_EQ(only_primitive(scene).normals, (std::vector<glm::vec3>{{0, 0, 1}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(notices.all().size(), 1u);
}

TEST(GltfPrimitives, MorphTargetsAtTheirDefaultWeights) {
  GltfBuilder file;
  const int delta = file.accessor<float>("VEC3", {0, 0, 2, 0, 0, 4, 0, 0, 0});
  file.primitive()["targets"] = {{{"POSITION", delta}}};
  file.root["meshes"][0]["weights"] = {0.5};
  file.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"weights", {1.0}}}, {{"mesh", 0}}};
  file.root["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = file.import();
  ASSERT_EQ(scene.meshes.size(), 2u);  // nodes of equal weights share one
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
  EXPECT_EQ(scene.meshes[0].primitives[0].positions, (std::vector<glm::vec3>{{0, 0, 1}, {1, 0, 2}, {0, 1, 0}}));
  EXPECT_EQ(scene.meshes[1].primitives[0].positions, (std::vector<glm::vec3>{{0, 0, 2}, {1, 0, 4}, {0, 1, 0}}));
}

TEST(GltfNodes, TransformsCompose) {
  GltfBuilder file;
  // Parent: moved by (10, 0, 0), turned by 90 degrees about z. Child: twice the size, moved by (1, 2, 3).
  const double h = std::sqrt(0.5);
  file.root["nodes"] = {{{"translation", {10, 0, 0}}, {"rotation", {0, 0, h, h}}, {"children", {1, 2}}},
                        {{"mesh", 0}, {"translation", {1, 2, 3}}, {"scale", {2, 2, 2}}},
                        {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 5, 6, 7, 1}}}};
  const Scene scene = file.import();
  ASSERT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  expect_near(scene.instances[0].transform, {{0, 2, 0}, {-2, 0, 0}, {0, 0, 2}, {10 - 2, 1, 3}}, 1e-6f);
  expect_near(scene.instances[1].transform, {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}, {10 - 6, 5, 7}}, 1e-6f);
}

TEST(GltfNodes, Instancing) {
  GltfBuilder file;
  file.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  const int t = file.accessor<float>("VEC3", {1, 0, 0, 0, 1, 0}), s = file.accessor<float>("VEC3", {2, 2, 2, 3, 3, 3});
  const int r = file.accessor<std::int8_t>("VEC4", {0, 0, 0, 127, 127, 0, 0, 0}, true);  // none; half a turn about x
  file.root["nodes"][0] = {{"mesh", 0},
                           {"translation", {0, 0, 5}},
                           {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", t}, {"SCALE", s}, {"ROTATION", r}}}}}}}};
  const Scene scene = file.import();
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].transform, (glm::mat4x3{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 5}}));
  EXPECT_EQ(scene.instances[1].transform, (glm::mat4x3{{3, 0, 0}, {0, -3, 0}, {0, 0, -3}, {0, 1, 5}}));
  EXPECT_EQ(scene.extensions, std::vector<std::string>{"EXT_mesh_gpu_instancing"});
}

TEST(GltfNodes, HierarchyFaults) {
  GltfBuilder file;
  file.root["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {3}}}, {{"children", {2}}}};
  EXPECT_NE(file.refusal().find("nodes[2]: is a child of nodes[1] and of nodes[3]"), std::string::npos) << file.refusal();
  file.root["nodes"] = {{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}};
  EXPECT_NE(file.refusal().find("is its own ancestor"), std::string::npos) << file.refusal();
  file.root["nodes"] = {{{"mesh", 0}, {"children", {0}}}};
  EXPECT_NE(file.refusal().find("nodes[0]: is its own ancestor"), std::string::npos) << file.refusal();
  file.root["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}};
  file.root["scenes"][0]["nodes"] = {0, 1};
  EXPECT_NE(file.refusal().find("scenes[0].nodes[1]: nodes[1] is no root"), std::string::npos) << file.refusal();
}

TEST(GltfNodes, DeepChainsNeedNoStack) {
  GltfBuilder file;
  json nodes = json::array();
  for (int i = 0; i < 50000; i++) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}, {"translation", {1, 2, 3}}});
  file.root["nodes"] = nodes;
  EXPECT_EQ(file.import().instances.at(0).transform[3], glm::vec3(1, 2, 3));
}

TEST(GltfNodes, Cameras) {
  GltfBuilder file;
  const double h = std::sqrt(0.5);
  file.root["cameras"] = {{{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 0.75}, {"aspectRatio", 1.5}, {"znear", 0.1}}}},
                          {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 4}, {"zfar", 10}, {"znear", 0}}}}};
  // Seen from +x: turned by 90 degrees about y, and scaled, which a camera does not take over.
  file.root["nodes"] = {{{"mesh", 0}},
                        {{"camera", 0}, {"translation", {7, 0, 0}}, {"rotation", {0, h, 0, h}}, {"scale", {3, 3, 3}}},
                        {{"camera", 1}, {"name", "plan"}}};
  file.root["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = file.import();
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_FALSE(scene.cameras[0].orthographic);
  EXPECT_EQ(scene.cameras[0].yfov, 0.75f);
  EXPECT_EQ(scene.cameras[0].aspect, 1.5f);
  expect_near(scene.cameras[0].transform, {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}, {7, 0, 0}}, 1e-6f);
  EXPECT_EQ(scene.cameras[1].name, "plan");
  EXPECT_TRUE(scene.cameras[1].orthographic);
  EXPECT_EQ(scene.cameras[1].half_width, 2);
  EXPECT_EQ(scene.cameras[1].half_height, 4);
}

TEST(GltfNodes, Lights) {
  GltfBuilder file;
  const double h = std::sqrt(0.5);
  file.root["extensionsUsed"] = {"KHR_lights_punctual"};
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"color", {1, 0.5, 0.25}}, {"intensity", 8}, {"name", "bulb"}},
                                                              {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
                                                              {{"type", "directional"}, {"intensity", 3}}};
  json nodes = {{{"mesh", 0}}};
  for (int i = 0; i < 3; i++)
    nodes.push_back(
        {{"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}, {"rotation", {-h, 0, 0, h}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  file.root["nodes"] = nodes;
  file.root["scenes"][0]["nodes"] = {0, 1, 2, 3};
  const Scene scene = file.import();
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].kind, Light::Kind::point);
  EXPECT_EQ(scene.lights[0].name, "bulb");
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(8, 4, 2));
  EXPECT_EQ(scene.lights[0].position, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[1].kind, Light::Kind::spot);
  EXPECT_EQ(scene.lights[1].inner_angle, 0.25f);
  EXPECT_EQ(scene.lights[1].outer_angle, 0.5f);
  EXPECT_EQ(scene.lights[2].kind, Light::Kind::directional);
  EXPECT_EQ(scene.lights[2].intensity, glm::vec3(3));
  // -z turned by -90 degrees about x shines straight down.
  for (int i : {1, 2})
    for (int c = 0; c < 3; c++) EXPECT_NEAR(scene.lights[i].direction[c], c == 1 ? -1.0f : 0.0f, 1e-7f);
}

TEST(GltfShapes, OfTheExtensionAndOfOurOwn) {
  using Kind = Shape::Kind;
  GltfBuilder file;
  file.root["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_implicit_shapes"};
  file.root["extensions"]["KHR_implicit_shapes"]["shapes"] = {{{"type", "box"}}, {{"type", "sphere"}, {"sphere", {{"radius", 3}}}}, {{"type", "sphere"}}};
  const auto node = [](const json &shape) { return json{{"name", "n"}, {"translation", {1, 2, 3}}, {"extras", {{"sunstone_shape", shape}}}}; };
  file.root["nodes"] = {node({{"shape", 1}, {"material", 1}}),
                        node({{"shape", 2}}),
                        node({{"type", "disk"}, {"radius", 0.25}, {"material", 0}}),
                        node({{"type", "quad"}, {"size", {4, 6}}}),
                        node({{"type", "quad"}}),
                        node({{"type", "plane"}}),
                        json{{"extras", "any text"}},
                        json{{"extras", {{"other", 1}}}}};
  file.root["nodes"][3]["scale"] = {2, 1, -1};
  file.root["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5, 6, 7};
  file.root.erase("meshes");
  const Scene scene = file.import();
  ASSERT_EQ(scene.shapes.size(), 6u);
  const Kind kinds[] = {Kind::sphere, Kind::sphere, Kind::disk, Kind::quad, Kind::quad, Kind::plane};
  const glm::vec3 sizes[] = {{3, 3, 3}, {0.5f, 0.5f, 0.5f}, {0.25f, 0.25f, 0.25f}, {4, 2, -3}, {0.5f, 0.5f, 0.5f}, {1, 1, 1}};
  for (std::size_t i = 0; i < 6; i++) {
    EXPECT_EQ(scene.shapes[i].kind, kinds[i]) << i;
    expect_near(scene.shapes[i].transform, {{sizes[i].x, 0, 0}, {0, sizes[i].y, 0}, {0, 0, sizes[i].z}, {1, 2, 3}}, 1e-6f);
  }
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.shapes[0].material)].name, "b");
  EXPECT_EQ(scene.materials[static_cast<std::size_t>(scene.shapes[2].material)].name, "a");
  EXPECT_EQ(scene.shapes[1].material, -1);
}

TEST(GltfShapes, WrongOnesAreNamed) {
  GltfBuilder file;
  file.root["extensions"]["KHR_implicit_shapes"]["shapes"] = {{{"type", "box"}}, {{"type", "sphere"}, {"sphere", {{"radius", -1}}}}, {{"sphere", 1}}};
  const auto refusal = [&](const json &shape) {
    file.root["nodes"][0]["extras"]["sunstone_shape"] = shape;
    return file.refusal();
  };
  const std::string place = "test.glb: nodes[0].extras.sunstone_shape";
  for (const auto &[shape, told] : std::vector<std::pair<json, std::string>>{
           {7, place + ": has to be an object"},
           {json::object(), place + ".type: is missing"},
           {{{"type", "torus"}}, place + ".type: \"torus\" is none of disk, quad, plane"},
           {{{"type", 3}}, place + ".type: has to be a string"},
           {{{"shape", 9}}, place + ".shape: index 9, but there are 3 shapes"},
           {{{"shape", 0}}, "extensions.KHR_implicit_shapes.shapes[0].type: \"box\" is not rendered"},
           {{{"shape", 1}}, "shapes[1].sphere.radius: a size has to be above 0"},
           {{{"shape", 2}}, "shapes[2].type: is missing"},
           {{{"shape", 1}, {"type", "disk"}}, place + ".type: stands beside"},
           {{{"type", "disk"}, {"radius", 0}}, place + ".radius: a size has to be above 0"},
           {{{"type", "quad"}, {"size", {1}}}, place + ".size: has 1 number"},
           {{{"type", "quad"}, {"size", {1, "2"}}}, place + ".size[1]: has to be a number"},
           {{{"type", "plane"}, {"material", 0}}, place + ".material: index 0, but there are 0 materials"}})
    EXPECT_NE(refusal(shape).find(told), std::string::npos) << shape << ": " << refusal(shape);
}

TEST(GltfFile, RequiredExtensionsThatAreLackingAreNamed) {
  GltfBuilder file;
  for (const char *name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_texture_basisu", "KHR_materials_sheen", "X\n"}) {
    file.root["extensionsRequired"] = {"KHR_texture_transform", name};
    EXPECT_NE(file.refusal().find(std::string("test.glb: extensionsRequired[1]: the file requires ") + (name[0] == 'X' ? "X\\x0a" : name)),
              std::string::npos)
        << file.refusal();
  }
}

TEST(GltfFile, CompressedPrimitivesWithAndWithoutOtherData) {
  GltfBuilder file;
  file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  EXPECT_EQ(file.warnings().size(), 1u);
  file.root["accessors"][0].erase("bufferView");
  EXPECT_NE(file.refusal().find("KHR_draco_mesh_compression"), std::string::npos);
}

TEST(GltfFile, Versions) {
  GltfBuilder file;
  for (const auto &[version, good] : std::vector<std::pair<json, bool>>{
           {"2.0", true}, {"2.7", true}, {"1.0", false}, {"3.0", false}, {"2", false}, {"2.x", false}, {"", false}, {2.0, false}}) {
    file.root["asset"]["version"] = version;
    EXPECT_EQ(file.refusal().empty(), good) << version << ": " << file.refusal();
  }
  file.root["asset"] = {{"version", "2.1"}, {"minVersion", "2.1"}};
  EXPECT_NE(file.refusal().find("asset.minVersion"), std::string::npos);
}

}  // namespace
}  // namespace sunstone
