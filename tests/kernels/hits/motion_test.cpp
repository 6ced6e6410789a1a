// SPDX-License-Identifier: Apache-2.0
// Motion: hits of a ray at its time are the same to the bit by brute force, on the host and on every layout, and those of the scene that stands still as it is then.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "flatten/bvh.h"
#include "kernels/hits/tracer.h"
#include "scene/ray.h"

namespace sunstone::hits {
namespace {

using kernel::Hit;
using kernel::uint;

constexpr unsigned steps = 4;

struct Random {
  std::mt19937 engine;
  explicit Random(unsigned seed) : engine(seed) {}
  float in(float lower, float upper) { return lower + (upper - lower) * (static_cast<float>(engine() >> 8) * 0x1p-24f); }
  glm::vec3 vector(float size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
};

glm::mat4x3 some_transform(Random &random, float spread) {
  // Far from singular, so that floats tell where things are.
  glm::mat4x3 m(1);
  for (int c = 0; c < 3; c++) m[c] += random.vector(0.25f);
  m[3] = random.vector(spread);
  return m;
}

Primitive some_triangles(Random &random, int count, bool deforms) {
  Primitive p;
  for (int i = 0; i < count; i++) {
    const glm::vec3 center = random.vector(1);
    for (int k = 0; k < 3; k++) {
      p.indices.push_back(static_cast<std::uint32_t>(p.positions.size()));
      p.positions.push_back(center + random.vector(0.4f));
    }
  }
  for (unsigned key = 0; deforms && key < steps; key++) {
    PrimitiveKey moved;
    for (const glm::vec3 &position : p.positions) moved.positions.push_back(position + random.vector(0.3f));
    p.keys.push_back(std::move(moved));
  }
  return p;
}

// What stands still, moves, deforms, and does both; one mesh is shown three times, still, moving and moving again.
Scene moving_scene(unsigned seed, int triangles) {
  Random random(seed);
  Scene scene;
  scene.name = "motion";
  scene.motion_steps = steps;
  scene.materials.resize(2);
  scene.materials[0].double_sided = true;
  for (int i = 0; i < 4; i++) {
    Primitive p = some_triangles(random, triangles, i >= 2);
    p.material = i % 2;
    scene.meshes.push_back({"mesh", {p}});
  }
  const auto show = [&](int mesh, bool moves) {
    Instance instance{"instance", mesh, some_transform(random, 3)};
    for (unsigned key = 0; moves && key < steps; key++) instance.keys.push_back(some_transform(random, 3));
    scene.instances.push_back(instance);
  };
  show(0, false);
  show(1, false);
  show(1, true);
  show(1, true);
  show(2, false);
  show(3, true);
  Shape ball{Shape::Kind::sphere, "ball", 1, some_transform(random, 2)}, pane{Shape::Kind::quad, "pane", 0, some_transform(random, 2)};
  for (unsigned key = 0; key < steps; key++) {
    ball.keys.push_back(some_transform(random, 2));
    pane.keys.push_back(some_transform(random, 2));
  }
  scene.shapes = {ball, pane};
  return scene;
}

// The scene as it stands at one time.
Scene at_time(const Scene &scene, float time) {
  Scene still = scene;
  still.motion_steps = 0;
  const float scaled = time * static_cast<float>(steps);
  const auto step = static_cast<std::size_t>(scaled);
  const float blend = scaled - static_cast<float>(step);
  const auto mixed = [&](const glm::mat4x3 &first, std::vector<glm::mat4x3> &keys) {
    keys.insert(keys.begin(), first);
    const glm::mat4x3 m = keys[step] + (keys[step + 1] - keys[step]) * blend;
    keys.clear();
    return m;
  };
  for (Instance &instance : still.instances)
    if (!instance.keys.empty()) instance.transform = mixed(instance.transform, instance.keys);
  for (Shape &shape : still.shapes)
    if (!shape.keys.empty()) shape.transform = mixed(shape.transform, shape.keys);
  for (Mesh &mesh : still.meshes)
    for (Primitive &p : mesh.primitives) {
      if (p.keys.empty()) continue;
      const std::vector<glm::vec3> first = p.positions;
      for (std::size_t i = 0; i < first.size(); i++) {
        const glm::vec3 a = step ? p.keys[step - 1].positions[i] : first[i], b = p.keys[step].positions[i];
        p.positions[i] = a + (b - a) * blend;
      }
      p.keys.clear();
    }
  return still;
}

FlatScene flattened(const Scene &scene) {
  Notices notices;
  FlattenOptions options;
  options.layout = Layout::binary;
  return flatten(scene, options, notices);
}

std::vector<TracedRay> random_rays(Random &random, int count, float time) {
  std::vector<TracedRay> rays;
  for (int i = 0; i < count; i++) {
    const glm::vec3 from = random.vector(8), to = random.vector(2.5f);
    TracedRay ray{};
    for (int c = 0; c < 3; c++) {
      ray.ray.origin[c] = from[c];
      ray.ray.direction[c] = (to[c] - from[c]) * 0.3f;
    }
    ray.ray.t_max = INFINITY;
    ray.time = time;
    rays.push_back(ray);
  }
  return rays;
}

constexpr float times[] = {0, 0x1p-24f, 0.1f, 0.25f, 0.61f, 0.75f - 0x1p-24f, 1 - 0x1p-24f};

// Shapes are no triangles that a loop over triangles would find.
Scene without_shapes(Scene scene) {
  scene.shapes.clear();
  return scene;
}

}  // namespace

TEST(MotionHits, BruteForceOnTheHost) {
  const FlatScene flat = flattened(without_shapes(moving_scene(1, 40)));
  EXPECT_EQ(flat.instance_keys.size(), 3u * (steps + 1));
  EXPECT_GT(flat.deforming, 0u);
  Random random(2);
  std::size_t hits = 0;
  for (const float time : times)
    for (const TracedRay &ray : random_rays(random, 400, time)) {
      const Hit expected = brute_force(flat, ray, SUN_WANT_ALL), got = host_closest(flat, flat.tree, ray, SUN_WANT_ALL);
      EXPECT_TRUE(same(expected, got)) << "time " << time << ": t " << expected.t << " and " << got.t << ", instance " << expected.instance << " and " << got.instance;
      EXPECT_EQ(host_any(flat, flat.tree, ray, SUN_WANT_ALL), expected.instance != SUN_NONE);
      hits += expected.instance != SUN_NONE;
    }
  EXPECT_GT(hits, 500u);
}

// A mesh of enough triangles that some would be in pieces, were they still.
TEST(MotionHits, LargerMeshes) {
  const FlatScene flat = flattened(without_shapes(moving_scene(3, 600)));
  Random random(4);
  for (const float time : times)
    for (const TracedRay &ray : random_rays(random, 40, time)) {
      const Hit expected = brute_force(flat, ray, SUN_WANT_ALL), got = host_closest(flat, flat.tree, ray, SUN_WANT_ALL);
      EXPECT_TRUE(same(expected, got)) << "time " << time << ": t " << expected.t << " and " << got.t;
    }
}

// Rays that miss a triangle's edge by a rounding differ; no others do.
TEST(MotionHits, AreThoseOfTheSceneAsItIsThen) {
  const Scene scene = moving_scene(5, 30);
  const FlatScene flat = flattened(scene);
  Random random(6);
  for (const float time : times) {
    Scene then = at_time(scene, time);
    // Numbers have to be alike: what moves is not baked.
    const FlatScene still = flattened(then);
    int differing = 0, hits = 0;
    for (const TracedRay &ray : random_rays(random, 600, time)) {
      const Hit a = host_closest(flat, flat.tree, ray, SUN_WANT_ALL), b = host_closest(still, still.tree, ray, SUN_WANT_ALL);
      hits += a.instance != SUN_NONE;
      if ((a.instance == SUN_NONE) != (b.instance == SUN_NONE) || (a.instance != SUN_NONE && std::fabs(a.t - b.t) > 1e-4f)) differing++;
    }
    EXPECT_GT(hits, 100) << "time " << time;
    EXPECT_LE(differing, 2) << "time " << time;
  }
}

TEST(MotionHits, EveryLayoutOnADevice) {
  const std::optional<Device> device = test_device();
  if (!device) GTEST_SKIP() << "there is no OpenCL device";
  const FlatScene flat = flattened(moving_scene(7, 60));
  for (const Layout layout : {Layout::binary, Layout::wide8, Layout::wide16}) {
    const Tracer tracer(*device, flat, layout);
    Random random(8);
    for (const float time : times) {
      const std::vector<TracedRay> rays = random_rays(random, 500, time);
      const std::vector<Hit> got = tracer.closest(rays, SUN_WANT_ALL);
      const std::vector<uint> blocked = tracer.any(rays, SUN_WANT_ALL);
      for (std::size_t i = 0; i < rays.size(); i++) {
        const Hit expected = host_closest(flat, flat.tree, rays[i], SUN_WANT_ALL);
        EXPECT_TRUE(same(expected, got[i])) << layout_name(layout) << ", time " << time << ": t " << expected.t << " and " << got[i].t;
        EXPECT_EQ(blocked[i] != 0, expected.instance != SUN_NONE);
      }
    }
  }
}

// A closed mesh that moves and turns has no cracks: rays at its vertices and edges from within hit it.
TEST(MotionHits, ClosedMeshesStayTight) {
  Random random(9);
  Scene scene;
  scene.motion_steps = steps;
  scene.materials.resize(1);
  scene.materials[0].double_sided = true;
  Primitive p;  // an octahedron
  p.material = 0;
  p.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const std::uint32_t y : {2u, 3u})
    for (const std::uint32_t x : {0u, 1u})
      for (const std::uint32_t z : {4u, 5u}) p.indices.insert(p.indices.end(), {x, y, z});
  for (unsigned key = 0; key < steps; key++) {
    PrimitiveKey moved;
    for (const glm::vec3 &position : p.positions) moved.positions.push_back(position + random.vector(0.2f));
    p.keys.push_back(moved);
  }
  scene.meshes.push_back({"octahedron", {p}});
  Instance instance{"octahedron", 0, some_transform(random, 0.1f)};
  for (unsigned key = 0; key < steps; key++) instance.keys.push_back(some_transform(random, 0.1f));
  scene.instances.push_back(instance);
  const FlatScene flat = flattened(scene);
  for (const float time : times) {
    const Scene then = at_time(scene, time);
    const glm::mat4x3 &m = then.instances[0].transform;
    const std::vector<glm::vec3> &at = then.meshes[0].primitives[0].positions;
    const glm::vec3 from = m[3];
    for (int i = 0; i < 300; i++) {
      const auto &indices = p.indices;
      const std::size_t t = 3 * (random.engine() % (indices.size() / 3));
      const float along = i % 3 == 0 ? 0.0f : random.in(0, 1);
      const glm::vec3 target = m * glm::vec4(at[indices[t]] * (1 - along) + at[indices[t + 1]] * along, 1);
      TracedRay ray{};
      for (int c = 0; c < 3; c++) {
        ray.ray.origin[c] = from[c];
        ray.ray.direction[c] = target[c] - from[c];
      }
      ray.ray.t_max = INFINITY;
      ray.time = time;
      EXPECT_NE(host_closest(flat, flat.tree, ray, SUN_WANT_ALL).instance, SUN_NONE) << "time " << time << ", ray " << i;
    }
  }
}

}  // namespace sunstone::hits
