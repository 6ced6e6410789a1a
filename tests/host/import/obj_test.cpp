// SPDX-License-Identifier: Apache-2.0
// Geometry of OBJ files: what is read, what is dropped and said, polygons, normals, and paths that lead out of the folder.
#include <cmath>
#include <ctime>

#include "host/import/obj_files.h"
#include "import/polygon.h"

using namespace sunstone;
using namespace sunstone::test;

namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// Area of a triangulation seen from +z, and the sum of the triangles' own areas: equal where none is turned over.
struct Areas {
  double net = 0, gross = 0;
};
Areas areas(const std::vector<glm::vec3> &points, const std::vector<std::uint32_t> &triangles) {
  Areas out;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const glm::dvec3 a(points[triangles[i]]), b(points[triangles[i + 1]]), c(points[triangles[i + 2]]);
    const double area = 0.5 * glm::cross(b - a, c - a).z;
    out.net += area;
    out.gross += std::abs(area);
  }
  return out;
}

double surface(const Imported &imported) {
  double sum = 0;
  for (const Primitive &p : imported.scene.meshes.at(0).primitives)
    for (std::size_t i = 0; i < p.indices.size(); i += 3) {
      const glm::dvec3 a(p.positions[p.indices[i]]), b(p.positions[p.indices[i + 1]]), c(p.positions[p.indices[i + 2]]);
      sum += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
  return sum;
}

}  // namespace

TEST(Polygon, ConcaveOutlinesAreCoveredOnce) {
  // A comb of 200 teeth, a star, and a square with a square hole reached by a bridge.
  std::vector<glm::vec3> comb{{0, 0, 0}, {400, 0, 0}};
  for (int i = 400; i >= 0; i--) comb.push_back({i, i % 2 ? 1 : 10, 0});
  std::vector<glm::vec3> star;
  for (int i = 0; i < 50; i++) star.push_back({(i % 2 ? 1 : 3) * std::cos(i * 0.12566371f), (i % 2 ? 1 : 3) * std::sin(i * 0.12566371f), 0});
  const std::vector<glm::vec3> ring{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  for (const std::vector<glm::vec3> &polygon : {comb, star, ring}) {
    std::vector<std::uint32_t> triangles;
    EXPECT_TRUE(triangulate_polygon(polygon, triangles));
    EXPECT_EQ(triangles.size(), 3 * (polygon.size() - 2));
    double outline = 0;
    for (std::size_t i = 0; i < polygon.size(); i++) {
      const glm::dvec3 a(polygon[i]), b(polygon[(i + 1) % polygon.size()]);
      outline += 0.5 * (a.x * b.y - a.y * b.x);
    }
    const Areas covered = areas(polygon, triangles);
    EXPECT_NEAR(covered.net, outline, 1e-5 * outline);
    EXPECT_NEAR(covered.gross, outline, 1e-5 * outline);
  }
}

TEST(Polygon, EveryOrientationKeepsTheWinding) {
  const std::vector<glm::vec3> dart{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
  for (int axis = 0; axis < 3; axis++)
    for (const bool turned : {false, true}) {
      std::vector<glm::vec3> polygon;
      for (const glm::vec3 &p : dart) polygon.push_back({p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]});
      if (turned) std::reverse(polygon.begin(), polygon.end());
      std::vector<std::uint32_t> triangles;
      EXPECT_TRUE(triangulate_polygon(polygon, triangles));
      glm::dvec3 whole(0);
      double gross = 0;
      for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 a(polygon[triangles[i]]), b(polygon[triangles[i + 1]]), c(polygon[triangles[i + 2]]);
        whole += 0.5 * glm::cross(b - a, c - a);
        gross += 0.5 * glm::length(glm::cross(b - a, c - a));
      }
      EXPECT_NEAR(glm::length(whole), 4, 1e-6);
      EXPECT_NEAR(gross, 4, 1e-6);
    }
}

TEST(Polygon, WhatCrossesItselfStillEnds) {
  std::vector<std::uint32_t> triangles;
  const std::vector<glm::vec3> bow{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2.5f, 0}, {-1, 1, 0}};
  triangulate_polygon(bow, triangles);
  EXPECT_EQ(triangles.size(), 9u);
  triangles.clear();
  EXPECT_TRUE(triangulate_polygon(std::vector<glm::vec3>(7, glm::vec3(1)), triangles));
  EXPECT_EQ(triangles.size(), 15u);
}

TEST(Polygon, ARoundedCircleIsCoveredOnce) {
  std::vector<glm::vec3> circle;
  for (int i = 0; i < 10000; i++)
    circle.push_back({std::round(std::cos(i * 6.2831853e-4) * 1e6) / 1e6, std::round(std::sin(i * 6.2831853e-4) * 1e6) / 1e6, 0});
  std::vector<std::uint32_t> triangles;
  EXPECT_TRUE(triangulate_polygon(circle, triangles));
  EXPECT_NEAR(areas(circle, triangles).gross, 3.14159265, 1e-5);
}

TEST(Polygon, HostileOutlinesEndSoon) {
  std::vector<glm::vec3> comb{{0, -1, 0}, {50000, -1, 0}};
  for (int i = 50000; i >= 0; i--) comb.push_back({i, i * 7919 % 1000, 0});
  std::vector<std::uint32_t> triangles;
  const std::clock_t start = std::clock();
  triangulate_polygon(comb, triangles);
  EXPECT_EQ(triangles.size(), 3 * (comb.size() - 2));
  EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 8);  // about one; sanitizers take their share
}

TEST(Obj, ReadsAllFormsOfFaces) {
  for (const char *face : {"f 1 2 3 4", "f -4 -3 -2 -1", "f 1/1 2/1 3/1 4/1", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/1/1 3/1/1 4/1/1", "f 1/ 2/ 3/ 4/",
                           "f 1 2 \\\n 3 4", "fo 1 2 3 4", "f\t1  2 3 4 # four corners"}) {
    const Imported in = import_text(square + "vt 0.25 0.25\nvn 0 0 1\n" + face + "\n");
    EXPECT_EQ(in.error, "");
    EXPECT_EQ(in.triangles(), 2u) << face;
    EXPECT_EQ(in.warnings(), 0) << face;
  }
}

TEST(Obj, FlipsVAndSharesVertices) {
  const Imported in = import_text(square + "vt 0.25 0.25\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n");
  EXPECT_EQ(in.only().positions.size(), 4u);
  EXPECT_EQ(in.only().uv[0][0], glm::vec2(0.25f, 0.75f));
  EXPECT_TRUE(in.only().normals.empty());
}

TEST(Obj, FacesMayComeBeforeTheirVertices) {
  const Imported in = import_text("f 1 2 3\nf 1 2 5\n" + square + "v nan 0 0\n");
  EXPECT_EQ(in.triangles(), 1u);
  EXPECT_EQ(in.warnings("s.obj:2: a face with a vertex that is not three finite numbers"), 1);
}

TEST(Obj, BadFacesAreDroppedWithTheirLineAndCount) {
  const Imported in = import_text(square + "f 0 1 2\nf 1 2 9\nf 1 2 9\nf a b c\nf 1 2\nf 1 2 3\n");
  EXPECT_EQ(in.triangles(), 1u);
  EXPECT_EQ(in.warnings("s.obj:5: a face with the index 0"), 1);
  EXPECT_EQ(in.warnings("s.obj:6: a face with an index beyond the vertices: dropped (and 1 more)"), 1);
  EXPECT_EQ(in.warnings("s.obj:8: a face with a corner"), 1);
  EXPECT_EQ(in.warnings("s.obj:9: a face of fewer"), 1);
  EXPECT_EQ(in.warnings(), 4);
}

TEST(Obj, SmoothingGroupsShareNormalsAndOthersDoNot) {
  const std::string roof = "v 0 0 1\nv 0 0 -1\nv 1 -1 1\nv 1 -1 -1\nv -1 -1 1\nv -1 -1 -1\n";
  const Imported smooth = import_text(roof + "s 1\nf 1 3 4 2\nf 2 6 5 1\n");
  ASSERT_EQ(smooth.only().positions.size(), 6u);
  EXPECT_NEAR(smooth.only().normals[0].y, 1, 1e-6);  // the ridge, between both slopes
  const Imported groups = import_text(roof + "s 1\nf 1 3 4 2\ns 2\nf 2 6 5 1\n");
  EXPECT_EQ(groups.only().positions.size(), 8u);
  EXPECT_NEAR(groups.only().normals[0].y, std::sqrt(0.5f), 1e-6);
  const Imported half = import_text(roof + "s 1\nf 1 3 4 2\ns off\nf 2 6 5 1\n");
  EXPECT_EQ(half.only().positions.size(), 8u);
  const Imported none = import_text(roof + "f 1 3 4 2\nf 2 6 5 1\n");
  EXPECT_TRUE(none.only().normals.empty());
  // Places count, not numbers: the ridge's points once more under other numbers.
  const Imported doubled = import_text(roof + "v 0 0 1\nv 0 0 -1\ns 1\nf 1 3 4 2\nf 8 6 5 7\n");
  EXPECT_NEAR(doubled.only().normals[0].y, 1, 1e-6);
}

TEST(Obj, ColoursOfVerticesAreRead) {
  const Imported in = import_text("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  ASSERT_EQ(in.only().colors.size(), 3u);
  EXPECT_EQ(in.only().colors[1], glm::vec4(0, 1, 0, 1));
}

TEST(Obj, MarksOfEncodingsAreSeen) {
  EXPECT_EQ(import_text("\xef\xbb\xbf" + square + "f 1 2 3\n").triangles(), 1u);
  EXPECT_NE(import_text(std::string("\xff\xfe", 2) + "v").error.find("UTF-16"), std::string::npos);
}

TEST(Obj, NothingInAFileIsAnErrorAndNoFacesAWarning) {
  EXPECT_NE(import_text("# empty\n").error.find("no geometry"), std::string::npos);
  EXPECT_NE(import_text("").error.find("is empty"), std::string::npos);
  const Imported points = import_text(square + "p 1 2\n");
  EXPECT_EQ(points.error, "");
  EXPECT_EQ(points.warnings("nothing to render"), 1);
}

TEST(ImportScene, RefusesWhatIsNoScene) {
  const Folder folder;
  EXPECT_NE(import_file(folder.path() / "none.obj").error.find("no such file"), std::string::npos);
  EXPECT_NE(import_file(folder.path()).error.find("is a folder"), std::string::npos);
  EXPECT_NE(import_file(folder.write("s.fbx", "x")).error.find("scenes are .gltf, .glb or .obj"), std::string::npos);
  EXPECT_EQ(import_file(folder.write("s.OBJ", square + "f 1 2 3\n")).triangles(), 1u);
}

TEST(ResolveResource, StaysBelowTheFolder) {
  const Folder folder;
  std::filesystem::create_directories(folder.path() / "in/deep");
  folder.write("outside.txt", "x");
  folder.write("in/inside.txt", "x");
  std::filesystem::create_symlink(folder.path() / "outside.txt", folder.path() / "in/link.txt");
  std::filesystem::create_symlink(folder.path(), folder.path() / "in/up");
  std::filesystem::create_symlink("inside.txt", folder.path() / "in/good.txt");
  const auto refused = [&](const std::string &name) {
    try {
      resolve_resource(folder.path() / "in", name, {}, "place");
    } catch (const Error &error) {
      EXPECT_EQ(error.place, "place");
      return true;
    }
    return false;
  };
  for (const char *name : {"inside.txt", "deep/../inside.txt", "./inside.txt", "good.txt", "missing.txt", "no/such/folder.txt"})
    EXPECT_FALSE(refused(name)) << name;
  for (const char *name :
       {"../outside.txt", "/etc/passwd", "link.txt", "up/outside.txt", "deep/../../outside.txt", "no/../../outside.txt", "", ".", "..", "../in2/x"})
    EXPECT_TRUE(refused(name)) << name;
  EXPECT_TRUE(refused(std::string("a\0b", 3)));
  EXPECT_EQ(resolve_resource(folder.path() / "in", "../outside.txt", {.allow_outside = true}, "place"), folder.path() / "in/../outside.txt");
}

TEST(ObjQuirks, EachFileGivesWhatItShould) {
  const std::filesystem::path folder = scenes() / "obj/quirks";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not here: " << folder;
  const struct {
    const char *name;
    std::size_t triangles, materials;
    int warnings;
  } cases[] = {
      {"box_longline", 944, 1, 2},           // no material of that name; the long face crosses itself
      {"catmark_torus_creases0", 64, 1, 1},  // normals that are not there
      {"concave_polygon", 64, 1, 0},
      {"cornell_box_multimaterial", 36, 5, 0},
      {"cube-vertex-w-component", 12, 5, 0},
      {"cube_with_vertexcolors", 12, 1, 0},
      {"issue-246-usemtl-whitespace", 1, 1, 0},
      {"issue-248-texres-texopt", 12, 5, 1},  // input.jpg
      {"issue-295-trianguation-failure", 28, 1, 0},
      {"issue-319-002", 14, 1, 0},
      {"line-prim", 0, 0, 2},
      {"points-prim", 0, 0, 2},
      {"missing_material_file", 36, 1, 1},
      {"mtl filename with whitespace issue46", 12, 1, 2},
      {"mtllib-multiple-files-issue-112", 1, 1, 3},
      {"no_material", 36, 1, 0},
      {"number_formats", 1, 1, 1},
      {"pbr-mat-ext", 2, 1, 7},
      {"smoothing-group-two-squares", 3, 1, 1},
      {"test-nan", 34, 5, 2},
      {"texture-options-issue-85", 1, 3, 5},
      {"tr-and-d-issue-43", 400, 2, 0},
  };
  for (const auto &c : cases) {
    const Imported in = import_file(folder / (std::string(c.name) + ".obj"));
    EXPECT_EQ(in.error, "") << c.name;
    EXPECT_EQ(in.triangles(), c.triangles) << c.name;
    EXPECT_EQ(in.scene.materials.size(), c.materials) << c.name;
    EXPECT_EQ(in.warnings(), c.warnings) << c.name;
  }
  EXPECT_NE(import_file(folder / "box_UTF16BE.obj").error.find("UTF-16"), std::string::npos);
  EXPECT_EQ(import_file(folder / "issue-248-texres-texopt.obj").warnings("\"input.jpg\""), 1);
  EXPECT_EQ(import_file(folder / "mtl filename with whitespace issue46.obj").scene.materials[0].base_color, glm::vec3(0, 1, 0));
  // A ring between octagon-like circles: its area is what lies between them, and less than the outer one's.
  EXPECT_NEAR(surface(import_file(folder / "concave_polygon.obj")), 0.253, 0.03);
}

TEST(ObjQuirks, MalformedFilesEndAsTheirTableSays) {
  const std::filesystem::path folder = scenes() / "malformed";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the shared scenes are not here: " << folder;
  for (const char *valid : {"valid-mixed-line-ends", "obj-long-line", "obj-lone-cr-line-ends", "valid-polygon-1000"}) {
    const Imported in = import_file(folder / (std::string(valid) + ".obj"));
    EXPECT_EQ(in.error, "") << valid;
    EXPECT_EQ(in.warnings(), 0) << valid;
  }
  EXPECT_EQ(import_file(folder / "valid-polygon-1000.obj").triangles(), 998u);
  for (const char *warned :
       {"obj-face-index-zero", "obj-face-index-out-of-range", "obj-face-negative-beyond-start", "obj-face-too-few-vertices", "obj-face-garbage",
        "obj-vertex-nan", "obj-mtllib-missing", "obj-mtllib-self-and-outside", "obj-csh-and-call", "mtl-odd"}) {
    const Imported in = import_file(folder / (std::string(warned) + ".obj"));
    EXPECT_EQ(in.error, "") << warned;
    EXPECT_EQ(in.triangles(), 1u) << warned;
    EXPECT_GT(in.warnings(), 0) << warned;
  }
  EXPECT_EQ(import_file(folder / "obj-vt-missing.obj").triangles(), 3u);
  EXPECT_NE(import_file(folder / "obj-binary-garbage.obj").error.find("no geometry"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists("sunstone-was-here"));
}
