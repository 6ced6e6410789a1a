// SPDX-License-Identifier: Apache-2.0
// No ray from inside a closed mesh gets out, least of all at the edges and corners that its triangles share.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "flatten/fragments.h"
#include "kernels/hits/soup.h"
#include "kernels/hits/tracer.h"

namespace sunstone::hits {
namespace {

using glm::vec3;
using kernel::uint;

// A closed mesh about the origin, star-shaped, and its triangles' corners in the world.
struct Closed {
  const char *name;
  FlatScene scene;
  std::vector<std::array<vec3, 3>> triangles;
};

template <class Radius>
Closed ball(const char *name, int rings, Radius &&radius, const Matrix &to_world, float aspect = 1.0f) {
  const int sectors = 2 * rings;
  std::vector<vec3> points;
  for (int j = 0; j <= rings; j++)
    for (int i = 0; i < sectors; i++) {
      const double theta = M_PI * j / rings, phi = 2 * M_PI * i / sectors;
      const vec3 d = j == 0       ? vec3(0, 1, 0)
                     : j == rings ? vec3(0, -1, 0)
                                  : vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      points.push_back(d * radius(j == 0 || j == rings ? 0 : i, j) * vec3(aspect, 1, 1));
    }
  Closed closed{name, {}, {}};
  Soup soup;
  soup.begin_mesh();
  const auto add = [&](vec3 a, vec3 b, vec3 c) {
    soup.triangle(a, b, c);
    const auto world = [&](vec3 p) {
      vec3 w;
      for (int row = 0; row < 3; row++)
        w[row] = to_world[4 * row] * p.x + to_world[4 * row + 1] * p.y + to_world[4 * row + 2] * p.z + to_world[4 * row + 3];
      return w;
    };
    closed.triangles.push_back({world(a), world(b), world(c)});
  };
  for (int j = 0; j < rings; j++)
    for (int i = 0; i < sectors; i++) {
      const int k = (i + 1) % sectors, a = j * sectors + i, b = j * sectors + k, c = (j + 1) * sectors + k, d = (j + 1) * sectors + i;
      if (j > 0) add(points[a], points[b], points[c]);
      if (j < rings - 1) add(points[a], points[c], points[d]);
    }
  soup.instance(0, to_world);
  closed.scene = soup.finish();
  return closed;
}

std::vector<Closed> closed_meshes() {
  const auto smooth = [](int, int) { return 1.0f; };
  const auto rough = [](int i, int j) { return 1.0f + 0.3f * float(hash_number(uint(i * 131 + j)) & 255u) / 255.0f; };
  std::vector<Closed> meshes;
  meshes.push_back(ball("smooth", 40, smooth, identity));
  meshes.push_back(ball("rough", 40, rough, identity));
  meshes.push_back(ball("coarse", 4, smooth, identity));
  meshes.push_back(ball("long", 24, rough, identity, 1000.0f));
  meshes.push_back(ball("turned", 24, rough, multiply(translation(5, -3, 2), multiply(rotation(1, 0.6f), scaling(3, 0.5f, -2)))));
  Closed cube{"cube", {}, {}};
  Soup soup;
  soup.box(vec3(-1), vec3(1));
  cube.scene = soup.finish();
  for (const kernel::Triangle &t : cube.scene.triangles) {
    std::array<vec3, 3> p;
    for (int k = 0; k < 3; k++) {
      const float *v = cube.scene.vertices[t.vertex[k]].position;
      p[k] = {v[0], v[1], v[2]};
    }
    cube.triangles.push_back(p);
  }
  meshes.push_back(std::move(cube));
  // And with their triangles in pieces: a hit must not fall between two of them.
  for (std::size_t i = 0, whole = meshes.size(); i < whole; i++) {
    meshes.push_back(meshes[i]);
    split_long_triangles(meshes.back().scene, {.least_triangles = 1, .splits_a_triangle = 6.0});
  }
  return meshes;
}

// Rays from about the centre at corners, at points of edges, and some in planes of the axes.
std::vector<TracedRay> rays_at_edges(const Closed &mesh, int count) {
  Random random(21);
  vec3 centre(0);
  for (const auto &t : mesh.triangles) centre += (t[0] + t[1] + t[2]) / 3.0f;
  centre /= float(mesh.triangles.size());
  const vec3 extent = mesh.scene.bounds.upper - mesh.scene.bounds.lower;
  std::vector<TracedRay> rays;
  for (int i = 0; i < count; i++) {
    const auto &t = mesh.triangles[random.number() % mesh.triangles.size()];
    const int k = int(random.number() % 3);
    const vec3 a = t[k], b = t[(k + 1) % 3];
    const vec3 target = i % 4 == 0 ? a : i % 4 == 1 ? 0.5f * (a + b) : a + random.unit() * (b - a);
    vec3 origin = centre + 0.05f * extent * random.in_box(vec3(-1), vec3(1));
    vec3 direction = target - origin;
    if (i % 16 == 3) {  // within a plane that holds a corner
      const int axis = i / 16 % 3;
      if (std::fabs(a[axis] - centre[axis]) < 0.2f * extent[axis]) {
        origin[axis] = a[axis];
        direction = a - origin;
      }
    }
    rays.push_back({make_ray(origin, direction)});
  }
  return rays;
}

class Watertight : public testing::TestWithParam<Layout> {};

TEST_P(Watertight, NothingEscapes) {
  const std::optional<Device> device = test_device();
  if (!device) GTEST_SKIP() << "SKIP: no OpenCL device";
  const int count = std::getenv("CI") ? 8000 : 30000;  // a mesh and layout: 10^6 in all
  std::optional<Tracer> tracer;
  std::size_t total = 0;
  for (const Closed &mesh : closed_meshes()) {
    if (tracer)
      tracer->load(mesh.scene);
    else
      tracer.emplace(*device, mesh.scene, GetParam());
    const std::vector<TracedRay> rays = rays_at_edges(mesh, count);
    const std::vector<kernel::Hit> hits = tracer->closest(rays);
    const std::vector<uint> any = tracer->any(rays);
    std::size_t escaped = 0, differ = 0;
    for (std::size_t i = 0; i < rays.size(); i++) {
      escaped += hits[i].instance == SUN_NONE;
      differ += (any[i] != 0) != (hits[i].instance != SUN_NONE);
    }
    EXPECT_EQ(escaped, 0u) << mesh.name;
    EXPECT_EQ(differ, 0u) << mesh.name;
    total += rays.size();
  }
  std::printf("%zu rays at edges and corners\n", total);
}

INSTANTIATE_TEST_SUITE_P(All, Watertight, testing::Values(Layout::binary, Layout::wide8, Layout::wide16), [](const auto &info) {
  return std::string(info.param == Layout::binary ? "binary" : info.param == Layout::wide8 ? "wide8" : "wide16");
});

}  // namespace
}  // namespace sunstone::hits
