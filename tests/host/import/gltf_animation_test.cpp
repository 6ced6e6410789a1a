// SPDX-License-Identifier: Apache-2.0
// Poses against closed forms: the ways between key frames, morph targets and skins at a time; and what a broken animation or skin is told.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"
#include "import/gltf_curves.h"
#include "shared/motion.h"

namespace sunstone::test {
namespace {

using Json = nlohmann::json;
using gltf::Curve;

constexpr double pi = 3.14159265358979323846;

glm::dvec4 about_z(double degrees) { return {0, 0, std::sin(degrees * pi / 360), std::cos(degrees * pi / 360)}; }

// One channel of node 0, its times as floats, its values as given.
template <class T>
GltfBuilder animated(const char *path, const char *way, const std::vector<float> &times, const std::string &type, const std::vector<T> &values, bool normalized = false) {
  GltfBuilder b;
  const int input = b.accessor<float>("SCALAR", times), output = b.accessor<T>(type, values, normalized);
  b.root["animations"] = {{{"name", "go"},
                           {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}},
                           {"samplers", {{{"input", input}, {"output", output}, {"interpolation", way}}}}}};
  b.options.time = 0;
  return b;
}

Scene at(GltfBuilder b, double time) {
  b.options.time = time;
  return b.import();
}

glm::vec3 place_at(const GltfBuilder &b, double time) { return at(b, time).instances.at(0).transform[3]; }

void expect_near(const glm::vec3 &a, const glm::vec3 &b, float tolerance = 1e-6f) {
  for (int c = 0; c < 3; c++) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

// Two targets for the triangle: the first lifts it by 1 along z, the second, sparse, takes its third corner by (4, 0, 0) alone.
void add_targets(GltfBuilder &b) {
  const int lift = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int where = b.view<std::uint8_t>({2}), values = b.view<float>({4, 0, 0});
  b.root["accessors"].push_back({{"componentType", 5126},
                                 {"type", "VEC3"},
                                 {"count", 3},
                                 {"sparse", {{"count", 1}, {"indices", {{"bufferView", where}, {"componentType", 5121}}}, {"values", {{"bufferView", values}}}}}});
  b.primitive()["targets"] = {{{"POSITION", lift}}, {{"POSITION", b.root["accessors"].size() - 1}}};
}

// A skin of joints 1 (at the origin) and 2 (its child, at (0, 1, 0)), the first and second corners following 1, the third 2.
GltfBuilder skinned() {
  GltfBuilder b;
  b.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {50, 60, 70}}}, {{"children", {2}}}, {{"translation", {0, 1, 0}}}};
  b.root["scenes"][0]["nodes"] = {0, 1};
  const int inverse = b.accessor<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
  b.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}};
  b.primitive()["attributes"]["JOINTS_0"] = b.accessor<std::uint8_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
  b.primitive()["attributes"]["WEIGHTS_0"] = b.accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  b.primitive()["attributes"]["NORMAL"] = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  return b;
}

}  // namespace

TEST(GltfCurves, SlerpGoesTheShortestArcAtEvenSpeed) {
  for (const double angle : {0.0, 1e-7, 1e-4, 0.05, 1.0, 30.0, 90.0, 120.0, 179.0})
    for (const double u : {0.0, 0.25, 1.0 / 3, 0.5, 0.9, 1.0}) {
      const glm::dvec4 expected = about_z(u * angle), got = gltf::slerp(about_z(0), about_z(angle), u);
      const glm::dvec4 other_way = gltf::slerp(about_z(0), -about_z(angle), u);
      for (int c = 0; c < 4; c++) {
        EXPECT_NEAR(got[c], expected[c], 3e-7) << angle << " degrees, u = " << u;
        EXPECT_EQ(got[c], other_way[c]) << angle << " degrees, u = " << u << ": q and -q are one rotation";
      }
      EXPECT_NEAR(got.x * got.x + got.y * got.y + got.z * got.z + got.w * got.w, 1, 1e-15);
    }
  // Beyond half a turn the short arc is the other one.
  const glm::dvec4 back = gltf::slerp(about_z(0), about_z(270), 0.5);
  EXPECT_NEAR(back.z, about_z(-45).z, 3e-7);
  EXPECT_NEAR(back.w, about_z(-45).w, 3e-7);
}

TEST(GltfCurves, ACubicIsFollowedExactly) {
  // p(t) = t^3 - 2 t + 1 with its own tangents is what Hermite's interpolation gives, over spans of any length.
  const auto p = [](double t) { return t * t * t - 2 * t + 1; };
  const auto slope = [](double t) { return 3 * t * t - 2; };
  Curve curve{Curve::Way::cubic, false, 1, {1, 3, 3.5}, {}};
  for (const double t : curve.times) curve.values.insert(curve.values.end(), {slope(t), p(t), slope(t)});
  for (const double t : {1.0, 1.25, 2.0, 2.9, 3.0, 3.2, 3.5}) EXPECT_NEAR(gltf::value_at(curve, t)[0], p(t), 1e-12) << t;
  EXPECT_EQ(gltf::value_at(curve, -7)[0], p(1));
  EXPECT_EQ(gltf::value_at(curve, 1e9)[0], p(3.5));
}

TEST(GltfAnimation, TranslationsAreLinearAndHeldOutside) {
  const GltfBuilder b = animated<float>("translation", "LINEAR", {1, 2, 4}, "VEC3", {0, 0, 0, 8, 0, 2, 0, 4, 2});
  expect_near(place_at(b, 1.25), {2, 0, 0.5f}, 0);
  expect_near(place_at(b, 2), {8, 0, 2}, 0);
  expect_near(place_at(b, 3), {4, 2, 2}, 0);
  expect_near(place_at(b, -10), {0, 0, 0}, 0);
  expect_near(place_at(b, 10), {0, 4, 2}, 0);
}

TEST(GltfAnimation, StepsKeepStillUntilTheNextKey) {
  const GltfBuilder b = animated<float>("translation", "STEP", {0, 1, 2}, "VEC3", {1, 0, 0, 2, 0, 0, 3, 0, 0});
  EXPECT_EQ(place_at(b, 0.999).x, 1);
  EXPECT_EQ(place_at(b, 1).x, 2);
  EXPECT_EQ(place_at(b, 1.5).x, 2);
  EXPECT_EQ(place_at(b, 2).x, 3);
}

TEST(GltfAnimation, RotationsTurnEvenly) {
  GltfBuilder b = animated<float>("rotation", "LINEAR", {0, 2}, "VEC4", {0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f});
  b.root["nodes"][0]["translation"] = {5, 6, 7};
  b.root["nodes"][0]["scale"] = {2, 2, 2};
  const glm::mat4x3 m = at(b, 1).instances.at(0).transform;
  const float r = 2 * std::sqrt(0.5f);
  expect_near(m[0], {r, r, 0});
  expect_near(m[1], {-r, r, 0});
  expect_near(m[3], {5, 6, 7}, 0);
  const float c = 2 * std::cos(static_cast<float>(pi) / 12), s = 2 * std::sin(static_cast<float>(pi) / 12);
  expect_near(at(b, 1.0 / 3).instances.at(0).transform[0], {c, s, 0});
}

// The same turn in every type that the specification allows, where -128 and -32768 are -1, too.
TEST(GltfAnimation, RotationsOfNormalisedIntegers) {
  const auto turned = [](const GltfBuilder &b) { return at(b, 1).instances.at(0).transform[0]; };
  expect_near(turned(animated<std::int8_t>("rotation", "LINEAR", {0, 2}, "VEC4", {0, 0, 127, 0, 0, 0, 0, 127}, true)), {0, 1, 0});
  expect_near(turned(animated<std::int16_t>("rotation", "LINEAR", {0, 2}, "VEC4", {0, 0, 32767, 0, 0, 0, 0, 32767}, true)), {0, 1, 0});
  expect_near(turned(animated<std::uint8_t>("rotation", "LINEAR", {0, 2}, "VEC4", {0, 0, 255, 0, 0, 0, 0, 255}, true)), {0, 1, 0});
  expect_near(turned(animated<std::uint16_t>("rotation", "LINEAR", {0, 2}, "VEC4", {0, 0, 65535, 0, 0, 0, 0, 65535}, true)), {0, 1, 0});
  expect_near(turned(animated<std::int8_t>("rotation", "STEP", {0, 2}, "VEC4", {0, 0, -128, 0, 0, 0, 0, 127}, true)), {-1, 0, 0});
}

TEST(GltfAnimation, SplinesOfRotationsStayUnit) {
  const GltfBuilder b = animated<float>("rotation", "CUBICSPLINE", {0, 1}, "VEC4",
                                        {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, /**/ 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
  // Flat tangents: halfway the mean of both, a quarter turn once it is unit again.
  expect_near(at(b, 0.5).instances.at(0).transform[0], {0, 1, 0});
}

TEST(GltfAnimation, ScaleAndSplineOfPlaces) {
  expect_near(at(animated<float>("scale", "LINEAR", {0, 1}, "VEC3", {1, 1, 1, 3, 5, 1}), 0.5).instances.at(0).transform[1], {0, 3, 0}, 0);
  // In-tangent, value, out-tangent: from 0 leaving at 4 per second to 8 arriving at 0, over two seconds. h(1/2) = 8 / 2 + 2 * 4 / 8.
  const GltfBuilder b = animated<float>("translation", "CUBICSPLINE", {1, 3}, "VEC3", {9, 9, 9, 0, 0, 0, 4, 0, 0, /**/ 0, 0, 0, 8, 0, 0, 9, 9, 9});
  expect_near(place_at(b, 2), {5, 0, 0});
}

TEST(GltfAnimation, MorphWeightsOfTheTimeOrOfTheFile) {
  GltfBuilder b = animated<float>("weights", "LINEAR", {0, 1}, "SCALAR", {0, 0, 1, 0.5f});
  add_targets(b);
  b.root["meshes"][0]["weights"] = {2, 0};
  const auto corner = [](const Scene &scene, std::size_t i) { return scene.meshes.at(0).primitives.at(0).positions.at(i); };
  expect_near(corner(at(b, 0), 2), {0, 1, 0}, 0);
  expect_near(corner(at(b, 0.5), 2), {1, 1, 0.5f}, 0);
  expect_near(corner(at(b, 1), 0), {0, 0, 1}, 0);
  expect_near(corner(at(b, 1), 2), {2, 1, 1}, 0);
  b.options.time.reset();
  expect_near(corner(b.import(), 2), {0, 1, 2}, 0);
  b.root["nodes"][0]["weights"] = {0, 1};
  expect_near(corner(b.import(), 2), {4, 1, 0}, 0);

  GltfBuilder bytes = animated<std::uint8_t>("weights", "STEP", {0, 1}, "SCALAR", {0, 255, 255, 51}, true);
  add_targets(bytes);
  expect_near(corner(at(bytes, 0), 2), {4, 1, 0}, 0);
  expect_near(corner(at(bytes, 1), 2), {0.8f, 1, 1});
  GltfBuilder spline = animated<float>("weights", "CUBICSPLINE", {0, 1}, "SCALAR", {0, 0, 0, 0, 8, 0, /**/ 0, 0, 1, 1, 0, 0});
  add_targets(spline);
  // First: 1/2 + 8 / 8; second: 1/2.
  expect_near(corner(at(spline, 0.5), 0), {0, 0, 1.5f}, 0);
  expect_near(corner(at(spline, 0.5), 2), {2, 1, 1.5f}, 0);
}

TEST(GltfAnimation, MorphedNormalsAndTangents) {
  GltfBuilder b = animated<float>("weights", "LINEAR", {0, 1}, "SCALAR", {0, 1});
  b.primitive()["attributes"]["NORMAL"] = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  b.primitive()["attributes"]["TANGENT"] = b.accessor<float>("VEC4", {1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1});
  const int normal = b.accessor<float>("VEC3", {0, 1, -1, 0, 1, -1, 0, 1, -1}), tangent = b.accessor<float>("VEC3", {-1, 0, 2, -1, 0, 2, -1, 0, 2});
  b.primitive()["targets"] = {{{"NORMAL", normal}, {"TANGENT", tangent}}};
  const Primitive morphed = at(b, 1).meshes.at(0).primitives.at(0), halfway = at(b, 0.5).meshes.at(0).primitives.at(0);
  expect_near(morphed.normals.at(1), {0, 1, 0});
  expect_near(glm::vec3(morphed.tangents.at(1)), {0, 0, 1});
  EXPECT_EQ(morphed.tangents.at(1).w, -1);
  expect_near(halfway.normals.at(1), {0, std::sqrt(0.5f), std::sqrt(0.5f)});
}

// Two nodes with one mesh, of which an animation moves one: they no longer share it.
TEST(GltfAnimation, OfNodesThatShareAMesh) {
  GltfBuilder b = animated<float>("weights", "LINEAR", {0, 1}, "SCALAR", {0, 0, 1, 0});
  add_targets(b);
  b.root["nodes"].push_back({{"mesh", 0}});
  b.root["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = at(b, 1);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.meshes.at(static_cast<std::size_t>(scene.instances[0].mesh)).primitives[0].positions[0].z, 1);
  EXPECT_EQ(scene.meshes.at(static_cast<std::size_t>(scene.instances[1].mesh)).primitives[0].positions[0].z, 0);
}

TEST(GltfAnimation, CamerasAndLightsFollowTheirNodes) {
  GltfBuilder b = animated<float>("translation", "LINEAR", {0, 1}, "VEC3", {0, 0, 0, 2, 4, 6});
  b.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  b.root["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 10}}});
  b.root["nodes"][0]["children"] = {1};
  expect_near(at(b, 0.5).cameras.at(0).transform[3], {1, 2, 13}, 0);
}

TEST(GltfAnimation, IsChosenByNameOrNumber) {
  GltfBuilder b = animated<float>("translation", "STEP", {0}, "VEC3", {1, 0, 0});
  b.root["animations"].push_back(b.root["animations"][0]);
  b.root["animations"][1]["name"] = "other";
  b.root["animations"][1]["samplers"][0]["output"] = b.accessor<float>("VEC3", {2, 0, 0});
  const auto x = [&](const char *choice) {
    b.options.animation = choice;
    return place_at(b, 0).x;
  };
  EXPECT_EQ(x(""), 1);
  EXPECT_EQ(x("0"), 1);
  EXPECT_EQ(x("1"), 2);
  EXPECT_EQ(x("other"), 2);
  for (const char *unknown : {"2", "-1", "Other", "1 ", "18446744073709551616"}) {
    b.options.animation = unknown;
    EXPECT_NE(b.refusal().find("there are 0 \"go\", 1 \"other\""), std::string::npos) << unknown << ": " << b.refusal();
  }
}

TEST(GltfAnimation, NotesSayWhatIsNotThere) {
  const auto note = [](const GltfBuilder &b) {
    Notices notices;
    b.import(notices);
    std::string all;
    for (const Notice &notice : notices.all()) all += notice.text + "\n";
    return all;
  };
  GltfBuilder still;
  EXPECT_EQ(note(still), "");
  still.options.time = 1;
  EXPECT_NE(note(still).find("has no animation"), std::string::npos);
  GltfBuilder b = animated<float>("translation", "LINEAR", {1, 2.5f}, "VEC3", {0, 0, 0, 1, 1, 1});
  b.options.time = 2;
  EXPECT_EQ(note(b), "");
  b.options.time = 0.5;
  EXPECT_NE(note(b).find("from 1 to 2.5 seconds"), std::string::npos);
  b.options.time.reset();
  EXPECT_NE(note(b).find("--time-at"), std::string::npos);
}

TEST(GltfAnimation, BrokenOnesAreRefusedByNameAndPlace) {
  const GltfBuilder good = animated<float>("translation", "LINEAR", {0, 1}, "VEC3", {0, 0, 0, 1, 1, 1});
  const std::string animation = "test.glb: animations[0].";
  const auto expect = [](const GltfBuilder &b, const std::string &says) {
    const std::string refusal = b.refusal();
    EXPECT_NE(refusal.find(says), std::string::npos) << "'" << says << "' is not in: " << refusal;
  };
  const auto with = [&](const char *pointer, const Json &value, const std::string &says) {
    GltfBuilder b = good;
    b.root[Json::json_pointer(pointer)] = value;
    expect(b, says);
  };
  EXPECT_EQ(good.refusal(), "");
  with("/animations/0", 7, "animations[0]");
  with("/animations/0/channels", Json::array(), animation + "channels: is empty");
  with("/animations/0/channels/0", "x", animation + "channels[0]");
  with("/animations/0/channels/0/sampler", 1, animation + "channels[0].sampler: index 1, but there is 1 sampler");
  with("/animations/0/channels/0/sampler", -1, animation + "channels[0].sampler: -1 is negative");
  with("/animations/0/channels/0/target", nullptr, animation + "channels[0].target");
  with("/animations/0/channels/0/target/node", 5, animation + "channels[0].target.node: index 5, but there is 1 node");
  with("/animations/0/channels/0/target/path", "colour", animation + "channels[0].target.path: \"colour\" is none of");
  with("/animations/0/channels/0/target/path", 3, animation + "channels[0].target.path");
  with("/animations/0/samplers/0/interpolation", "QUADRATIC", animation + "samplers[0].interpolation: \"QUADRATIC\"");
  with("/animations/0/samplers/0/input", 99, animation + "samplers[0].input: index 99");
  with("/animations/0/samplers/0/output", 99, animation + "samplers[0].output: index 99");
  with("/animations/0/samplers/0/input", 2, "VEC3 has 3 components");
  with("/animations/0/samplers/0/output", 1, "SCALAR has 1 components");
  with("/animations/0/samplers/0/interpolation", "CUBICSPLINE", animation + "samplers[0].output: has 2 elements, but there are 2 key frames of 3 each");
  with("/animations/0/channels/0/target/path", "rotation", "VEC3 has 3 components");
  with("/animations/0/channels/0/target/path", "weights", "meshes[0]: its morph weights are animated, but it has no targets");
  with("/nodes/0/matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "nodes[0].matrix: a node that is animated");
  with("/accessors/1/count", 1, animation + "samplers[0].output: has 2 elements, but there are 1 key frame of 1 each");
  with("/accessors/1/count", 3, "accessors[1]: its 3 elements");
  with("/accessors/1/count", 0, animation + "samplers[0].input: has no key frame");
  with("/accessors/1/componentType", 5125, "accessors[1].componentType: 5125 cannot be a time");
  with("/accessors/2/componentType", 5123, "accessors[2].componentType: 5123, not normalised, cannot be a translation");

  GltfBuilder twice = good;
  twice.root["animations"][0]["channels"].push_back(twice.root["animations"][0]["channels"][0]);
  expect(twice, animation + "channels[1].target: the translation of nodes[0] is animated twice");
  const float nan = std::nanf("");
  for (const std::vector<float> &times : {std::vector<float>{1, 1}, {1, 0.5f}, {0, nan}, {nan, 0}, {0, INFINITY}, {-INFINITY, 0}})
    expect(animated<float>("translation", "LINEAR", times, "VEC3", {0, 0, 0, 1, 1, 1}), "accessors[1]: ");
  expect(animated<float>("translation", "LINEAR", {0, 1}, "VEC3", {0, 0, 0, 1, nan, 1}), "accessors[2]: number 4 of its data is not finite");
  expect(animated<std::int16_t>("rotation", "LINEAR", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, 0, 1}), "not normalised, cannot be a rotation");
  expect(animated<std::uint32_t>("rotation", "LINEAR", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, 0, 1}, true), "5125 cannot be a rotation");
  GltfBuilder few = animated<float>("weights", "LINEAR", {0, 1}, "SCALAR", {0, 0, 1});
  add_targets(few);
  expect(few, animation + "samplers[0].output: has 3 elements, but there are 2 key frames of 2 each");
  GltfBuilder nothing = animated<float>("weights", "LINEAR", {0, 1}, "SCALAR", {0, 1});
  nothing.root["nodes"][0].erase("mesh");
  expect(nothing, "nodes[0]: its morph weights are animated, but it has no mesh");
}

// What swings beyond all measure is left out, not undefined.
TEST(GltfAnimation, HugeNumbers) {
  GltfBuilder b = animated<float>("weights", "CUBICSPLINE", {0, 1e30f}, "SCALAR", {0, 0, 0, 0, 3e38f, 0, /**/ 0, 0, 3e38f, 0, 0, 0});
  add_targets(b);
  b.options.time = 5e29;
  Notices notices;
  EXPECT_EQ(b.import(notices).meshes.size(), 1u);
  GltfBuilder place = animated<float>("translation", "LINEAR", {-3e38f, 3e38f}, "VEC3", {-3e38f, 0, 0, 3e38f, 0, 0});
  place.options.time = 1e37;
  EXPECT_EQ(place.import(notices).instances.size(), 0u);
}

TEST(GltfSkins, VerticesFollowTheirJointsAlone) {
  GltfBuilder b = skinned();
  const Scene rest = b.import();
  ASSERT_EQ(rest.instances.size(), 1u);
  EXPECT_EQ(rest.instances[0].transform, glm::mat4x3(1)) << "the place of the node has no part in it";
  expect_near(rest.meshes[0].primitives[0].positions[2], {0, 1, 0}, 0);
  // The second joint turned by a quarter about z, as is what follows it; its own origin stays.
  b.root["nodes"][2]["rotation"] = {0, 0, 0.70710678f, 0.70710678f};
  b.root["nodes"][1]["translation"] = {10, 0, 0};
  const int positions = b.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 3, 0}), normals = b.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 1, 0});
  b.primitive()["attributes"]["POSITION"] = positions;
  b.primitive()["attributes"]["NORMAL"] = normals;
  const Primitive turned = b.import().meshes.at(0).primitives.at(0);
  expect_near(turned.positions[1], {11, 0, 0}, 0);
  expect_near(turned.positions[2], {8, 1, 0});
  expect_near(turned.normals[2], {-1, 0, 0});
  // Half by each: the mean of both places.
  b.primitive()["attributes"]["JOINTS_0"] = b.accessor<std::uint16_t>("VEC4", {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
  b.primitive()["attributes"]["WEIGHTS_0"] = b.accessor<std::uint8_t>("VEC4", {255, 0, 0, 0, 255, 0, 0, 0, 100, 100, 0, 0}, true);
  expect_near(b.import().meshes.at(0).primitives.at(0).positions[2], {9, 2, 0}, 2e-6f);
}

TEST(GltfSkins, MirroredJointsKeepTheFront) {
  GltfBuilder b = skinned();
  b.root["nodes"][1]["scale"] = {-1, 1, 1};
  const Primitive mirrored = b.import().meshes.at(0).primitives.at(0);
  const auto &p = mirrored.positions;
  const auto &i = mirrored.indices;
  expect_near(p[1], {-1, 0, 0}, 0);
  expect_near(mirrored.normals[0], {0, 0, 1}, 0);
  EXPECT_GT(glm::cross(p[i[1]] - p[i[0]], p[i[2]] - p[i[0]]).z, 0);
}

TEST(GltfSkins, JointsOutsideTheScene) {
  GltfBuilder b = skinned();
  b.root["scenes"][0]["nodes"] = {0};
  b.root["nodes"][1]["translation"] = {3, 0, 0};
  const Scene scene = b.import();
  ASSERT_EQ(scene.instances.size(), 1u);
  expect_near(scene.meshes[0].primitives[0].positions[2], {3, 1, 0}, 0);
}

// What an open shutter sees: keys of all that moves, as many as the way needs.
Scene seen(GltfBuilder b, double time, double shutter) {
  b.options.time = time;
  b.options.shutter = shutter;
  return b.import();
}

TEST(Shutter, StraightWaysTakeOneStep) {
  const GltfBuilder b = animated<float>("translation", "LINEAR", {0, 2}, "VEC3", {0, 0, 0, 4, 2, 0});
  const Scene scene = seen(b, 0.5, 1);
  EXPECT_EQ(scene.motion_steps, 1u);
  const Instance &instance = scene.instances.at(0);
  ASSERT_EQ(instance.keys.size(), 1u);
  expect_near(instance.transform[3], {1, 0.5f, 0});
  expect_near(instance.keys[0][3], {3, 1.5f, 0});
  EXPECT_EQ(instance.keys[0][0], glm::vec3(1, 0, 0));
  // The opening of the shutter is the still picture; closed, or while nothing moves, it is that alone.
  EXPECT_EQ(instance.transform, at(b, 0.5).instances[0].transform);
  EXPECT_EQ(at(b, 0.5).motion_steps, 0u);
  for (const Scene &still : {seen(b, 0.5, 0), seen(b, 2, 5), seen(b, -3, 3)}) {
    EXPECT_EQ(still.motion_steps, 0u);
    EXPECT_TRUE(still.instances.at(0).keys.empty());
  }
}

// A corner on the way, at an eighth of the shutter's time: eight steps have a key there.
TEST(Shutter, CornersOfTheWay) {
  const Scene scene = seen(animated<float>("translation", "LINEAR", {0, 1, 8}, "VEC3", {0, 0, 0, 1, 0, 0, 1, 7, 0}), 0, 8);
  EXPECT_EQ(scene.motion_steps, 8u);
  expect_near(scene.instances.at(0).keys.at(0)[3], {1, 0, 0});
  expect_near(scene.instances[0].keys.at(7)[3], {1, 7, 0});
  // A jump takes as many as there are.
  EXPECT_EQ(seen(animated<float>("translation", "STEP", {0, 0.3f}, "VEC3", {0, 0, 0, 1, 0, 0}), 0, 1).motion_steps, unsigned{SUN_MOST_MOTION_STEPS});
}

// Between keys a turn is a straight line; nowhere is it off by more than a thousandth.
TEST(Shutter, TurnsAreCutIntoSmallSteps) {
  std::vector<float> turn;
  for (const double degrees : {0.0, 90.0})
    for (int k = 0; k < 4; k++) turn.push_back(static_cast<float>(about_z(degrees)[k]));
  const GltfBuilder b = animated<float>("rotation", "LINEAR", {0, 1}, "VEC4", turn);
  const Scene scene = seen(b, 0, 1);
  EXPECT_GE(scene.motion_steps, 16u);
  EXPECT_LE(scene.motion_steps, 32u);
  std::vector<glm::mat4x3> keys = scene.instances.at(0).keys;
  keys.insert(keys.begin(), scene.instances[0].transform);
  for (int i = 0; i < 200; i++) {
    const double time = (i + 0.5) / 200, scaled = time * scene.motion_steps;
    const auto step = static_cast<std::size_t>(scaled);
    const glm::mat4x3 between = keys[step] + (keys[step + 1] - keys[step]) * static_cast<float>(scaled - static_cast<double>(step)), real = at(b, time).instances.at(0).transform;
    for (int column = 0; column < 4; column++) expect_near(between[column], real[column], 1.1e-3f);
  }
}

TEST(Shutter, MorphTargetsAndSkins) {
  GltfBuilder b = animated<float>("weights", "LINEAR", {0, 1}, "SCALAR", {0, 0, 2, 1});
  add_targets(b);
  const Scene morphed = seen(b, 0.5, 0.25);
  EXPECT_EQ(morphed.motion_steps, 1u);
  EXPECT_TRUE(morphed.instances.at(0).keys.empty());
  const Primitive &p = morphed.meshes.at(0).primitives.at(0);
  ASSERT_EQ(p.keys.size(), 1u);
  expect_near(p.positions[0], {0, 0, 1});
  expect_near(p.keys[0].positions[0], {0, 0, 1.5f});
  expect_near(p.keys[0].positions[2], {3, 1, 1.5f});
  // Two nodes that show it share it; one that has weights of its own does not move with it.
  b.root["nodes"].push_back({{"mesh", 0}, {"weights", {0.25, 0}}});
  b.root["scenes"][0]["nodes"] = {0, 1};
  const Scene two = seen(b, 0.5, 0.25);
  ASSERT_EQ(two.meshes.size(), 2u);
  EXPECT_TRUE(two.meshes[1].primitives.at(0).keys.empty());

  GltfBuilder skin = skinned();
  const int input = skin.accessor<float>("SCALAR", {0, 1}), output = skin.accessor<float>("VEC3", {0, 1, 0, 0, 5, 0});
  skin.root["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}, {"samplers", {{{"input", input}, {"output", output}}}}}};
  const Scene bent = seen(skin, 0, 1);
  EXPECT_EQ(bent.motion_steps, 1u);
  EXPECT_TRUE(bent.instances.at(0).keys.empty()) << "joints alone say where it is";
  const Primitive &q = bent.meshes.at(0).primitives.at(0);
  ASSERT_EQ(q.keys.size(), 1u);
  expect_near(q.positions[2], {0, 1, 0});
  expect_near(q.keys[0].positions[2], {0, 5, 0});
  expect_near(q.keys[0].positions[1], {1, 0, 0});
}

TEST(Shutter, CamerasLightsAndShapes) {
  GltfBuilder b = animated<float>("translation", "LINEAR", {0, 1}, "VEC3", {0, 0, 0, 2, 0, 0});
  b.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  b.root["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", Json::object()}}}}}}};
  b.root["extensionsUsed"] = {"KHR_lights_punctual"};
  b.root["nodes"][0]["children"] = {1};  // what hangs below it moves with it
  b.root["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"extras", {{"sunstone_shape", {{"type", "disk"}, {"radius", 3}}}}}});
  const Scene scene = seen(b, 0, 0.5);
  ASSERT_EQ(scene.motion_steps, 1u);
  ASSERT_EQ(scene.cameras.at(0).keys.size(), 1u);
  expect_near(scene.cameras[0].keys[0][3], {1, 0, 0});
  ASSERT_EQ(scene.lights.at(0).keys.size(), 1u);
  expect_near(scene.lights[0].keys[0].position, {1, 0, 0});
  expect_near(scene.lights[0].keys[0].direction, {0, 0, -1});
  ASSERT_EQ(scene.shapes.at(0).keys.size(), 1u);
  expect_near(scene.shapes[0].keys[0][0], {3, 0, 0});
  expect_near(scene.shapes[0].keys[0][3], {1, 0, 0});
}

TEST(GltfSkins, BrokenOnesAreRefusedByNameAndPlace) {
  const auto with = [&](const char *pointer, const Json &value, const std::string &says) {
    GltfBuilder b = skinned();
    b.root[Json::json_pointer(pointer)] = value;
    const std::string refusal = b.refusal();
    EXPECT_NE(refusal.find(says), std::string::npos) << "'" << says << "' is not in: " << refusal;
  };
  EXPECT_EQ(skinned().refusal(), "");
  with("/nodes/0/skin", 3, "test.glb: nodes[0].skin: index 3, but there is 1 skin");
  with("/skins/0/joints", Json::array(), "skins[0].joints: is empty");
  with("/skins/0/joints", {1, 9}, "skins[0].joints[1]: index 9, but there are 3 nodes");
  with("/skins/0/joints", {1, 2, 2}, "skins[0].inverseBindMatrices: has 2 elements, but there are 3 joints");
  with("/skins/0/joints", {1}, "attributes.JOINTS_0: index 1, but there is 1 joint");
  with("/skins/0/inverseBindMatrices", 0, "VEC3 has 3 components");
  with("/nodes/1/scale", {1e35, 1, 1}, "skins[0]: the transform of one of its joints");
  with("/meshes/0/primitives/0/attributes/WEIGHTS_0", 2, "componentType: 5121 cannot be a weight");
  with("/meshes/0/primitives/0/attributes/JOINTS_0", 3, "componentType: 5126 cannot number joints");
  with("/meshes/0/primitives/0/attributes/JOINTS_1", 2, "attributes.WEIGHTS_1: is missing beside");
  with("/accessors/3/count", 2, "attributes.WEIGHTS_0: has 2 elements, but there are 3 positions");
  for (const float weight : {-1.0f, std::nanf(""), INFINITY}) {
    GltfBuilder b = skinned();
    b.primitive()["attributes"]["WEIGHTS_0"] = b.accessor<float>("VEC4", {1, 0, 0, 0, 1, weight, 0, 0, 1, 0, 0, 0});
    EXPECT_NE(b.refusal().find("WEIGHTS_0: a weight of vertex 1"), std::string::npos) << b.refusal();
  }
}

TEST(GltfSkins, OddOnesAreSaid) {
  GltfBuilder none = skinned();
  none.primitive()["attributes"].erase("JOINTS_0");
  none.primitive()["attributes"].erase("WEIGHTS_0");
  ASSERT_EQ(none.warnings().size(), 1u);
  EXPECT_NE(none.warnings()[0].find("has no joints"), std::string::npos);
  GltfBuilder weightless = skinned();
  weightless.primitive()["attributes"]["WEIGHTS_0"] = weightless.accessor<float>("VEC4", std::vector<float>(12, 0));
  ASSERT_EQ(weightless.warnings().size(), 1u);
  EXPECT_NE(weightless.warnings()[0].find("follow the first joint"), std::string::npos);
}

}  // namespace sunstone::test
