// SPDX-License-Identifier: Apache-2.0
// Analytic shapes: hits in agreement with closed forms in double precision, the same to the bit on every layout, none by rays that run along a plane, and
// each of a sphere's two in turn.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/file.h"
#include "flatten/bvh.h"
#include "kernels/hits/tracer.h"
#include "scene/ray.h"

namespace sunstone::hits {
namespace {

using kernel::Hit;
using kernel::uint;

glm::mat4x3 placed(glm::vec3 x, glm::vec3 y, glm::vec3 z, glm::vec3 at) { return {x, y, z, at}; }

// One of each kind, and a mesh beside them; some are turned, sheared, mirrored. Materials: 0 double-sided, 1 single-sided.
Scene some_shapes(bool with_mesh) {
  Scene scene;
  scene.name = "shapes";
  scene.materials.resize(2);
  scene.materials[0].double_sided = true;
  using Kind = Shape::Kind;
  scene.shapes = {{Kind::sphere, "ball", 0, placed({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 0})},
                  {Kind::plane, "floor", 0, placed({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -0.5f, 0})},
                  {Kind::sphere, "egg", 1, placed({0.5f, 0.1f, 0}, {-0.2f, 1.1f, 0.3f}, {0, 0.2f, -0.7f}, {2.5f, 0.7f, -1})},
                  {Kind::disk, "disk", 1, placed({0.8f, 0, 0.3f}, {0, 0.8f, 0}, {-0.3f, 0.1f, 0.8f}, {-2, 0.5f, 0.5f})},
                  {Kind::quad, "quad", 0, placed({0, 1, 0}, {1, 0, 0}, {0, 0, 0.4f}, {-1, 2, -2})},
                  {Kind::plane, "slope", 1, placed({1, 0.2f, 0}, {-0.2f, 1, 0}, {0, 0, 1}, {0, -4, 0})}};
  if (with_mesh) {
    Primitive p;
    p.positions = {{-3, 0, -3}, {3, 0, -3}, {0, 4, -3}};
    p.indices = {0, 1, 2};
    scene.meshes.push_back({"triangle", {p}});
    scene.instances.push_back({"triangle", 0, glm::mat4x3(1)});
  }
  return scene;
}

FlatScene flattened(const Scene &scene) {
  Notices notices;
  FlattenOptions options;
  options.layout = Layout::binary;
  return flatten(scene, options, notices);
}

TracedRay ray_of(glm::dvec3 origin, glm::dvec3 direction, float t_max = INFINITY) {
  TracedRay ray{};
  for (int c = 0; c < 3; c++) {
    ray.ray.origin[c] = static_cast<float>(origin[c]);
    ray.ray.direction[c] = static_cast<float>(direction[c]);
  }
  ray.ray.t_max = t_max;
  return ray;
}

std::vector<TracedRay> random_rays(int count, double spread) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-spread, spread), aim(-2.5, 2.5);
  std::vector<TracedRay> rays;
  for (int i = 0; i < count; i++) {
    const glm::dvec3 origin(place(random), place(random), place(random)), target(aim(random), aim(random), aim(random));
    rays.push_back(ray_of(origin, (target - origin) * 0.3));
  }
  return rays;
}

// What a shape does to a ray, by the formulas: the distances, and how sure they are.
struct Expected {
  double t = INFINITY;
  double doubt = 0;  // distance of the ray from where the answer changes, in the shape's space
  std::size_t shape = 0;
};

Expected closed_form(const Scene &scene, const TracedRay &ray) {
  Expected best;
  best.doubt = INFINITY;
  for (std::size_t s = 0; s < scene.shapes.size(); s++) {
    const Shape &shape = scene.shapes[s];
    const glm::dmat3 m(glm::dvec3(shape.transform[0]), glm::dvec3(shape.transform[1]), glm::dvec3(shape.transform[2]));
    const glm::dmat3 inverse = glm::inverse(m);
    const glm::dvec3 o = inverse * (glm::dvec3(ray.ray.origin[0], ray.ray.origin[1], ray.ray.origin[2]) - glm::dvec3(shape.transform[3]));
    const glm::dvec3 d = inverse * glm::dvec3(ray.ray.direction[0], ray.ray.direction[1], ray.ray.direction[2]);
    const bool single = !scene.materials[static_cast<std::size_t>(shape.material)].double_sided;
    std::vector<std::pair<double, bool>> met;  // t, from behind
    if (shape.kind == Shape::Kind::sphere) {
      const double a = glm::dot(d, d), b = glm::dot(o, d), c = glm::dot(o, o) - 1, discriminant = b * b - a * c;
      best.doubt = std::min(best.doubt, std::abs(discriminant) / a);
      if (discriminant >= 0) met = {{(-b - std::sqrt(discriminant)) / a, false}, {(-b + std::sqrt(discriminant)) / a, true}};
    } else {
      const double t = -o.y / d.y;
      const glm::dvec3 p = o + t * d;
      const double reach = shape.kind == Shape::Kind::disk ? std::hypot(p.x, p.z) : std::max(std::abs(p.x), std::abs(p.z));
      if (shape.kind != Shape::Kind::plane) best.doubt = std::min(best.doubt, std::abs(reach - 1));
      best.doubt = std::min(best.doubt, 1e-3 * std::abs(d.y) / glm::length(d));  // all but along it, floats tell the distance poorly
      if (shape.kind == Shape::Kind::plane || reach <= 1) met = {{t, d.y > 0}};
    }
    for (const auto &[t, behind] : met) {
      if (single && behind) continue;
      best.doubt = std::min(best.doubt, std::abs(t));
      if (t > 0 && t < best.t) {
        best.t = t;
        best.shape = s;
      }
    }
  }
  return best;
}

// The instance of a scene's shape.
std::size_t instance_of(const FlatScene &flat, std::size_t shape) {
  for (std::size_t i = 0; i < flat.instances.size(); i++)
    if (flat.instance_object[i] == shape + 1) return i;
  return flat.instances.size();
}

TEST(Shapes, AreHitWhereTheFormulasSay) {
  const Scene scene = some_shapes(false);
  const FlatScene flat = flattened(scene);
  const Tree tree = build_tree(flat, Layout::binary);
  ASSERT_EQ(flat.shape_count, 6u);
  ASSERT_EQ(flat.plane_count, 2u);
  std::vector<int> seen(scene.shapes.size());
  int misses = 0;
  for (const TracedRay &ray : random_rays(40000, 6)) {
    const Expected expected = closed_form(scene, ray);
    if (expected.doubt < 1e-5) continue;
    const Hit hit = host_closest(flat, tree, ray, SUN_WANT_ALL);
    ASSERT_EQ(hit.instance == SUN_NONE, std::isinf(expected.t));
    ASSERT_EQ(host_any(flat, tree, ray, SUN_WANT_ALL), !std::isinf(expected.t));
    if (hit.instance == SUN_NONE) {
      misses++;
      continue;
    }
    seen[expected.shape]++;
    ASSERT_EQ(hit.instance, instance_of(flat, expected.shape));
    ASSERT_EQ(flat.triangles[hit.primitive].material, static_cast<uint>(scene.shapes[expected.shape].material));
    ASSERT_NEAR(hit.t, expected.t, 2e-5 * (1 + expected.t));
  }
  for (std::size_t s = 0; s < seen.size(); s++) EXPECT_GT(seen[s], 100) << scene.shapes[s].name;
  EXPECT_GT(misses, 100);
}

// Balls, disks and quads so skewed that rays lose more in their space than slabs make up for: what they meet there may lie off the shape's world box.
Scene skewed_shapes(bool with_mesh) {
  Scene scene = some_shapes(with_mesh);
  scene.shapes.clear();
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto any = [&] {
    const float x = unit(random), y = unit(random);
    return glm::vec3(x, y, unit(random));
  };
  for (int i = 0; i < 18; i++) {
    const auto kind = static_cast<Shape::Kind>(i % 3);
    const glm::vec3 x = any(), all_but_x = x + std::exp2(-5.0f - static_cast<float>(i / 3)) * any(), other = any();
    const bool ball = kind == Shape::Kind::sphere;
    scene.shapes.push_back({kind, "skewed", i % 2, placed(x, ball ? all_but_x : other, ball ? other : all_but_x, 2.0f * any())});
  }
  return scene;
}

// Rays at the outermost points of shapes along an axis, beside them and along the shapes' x, from near and far, that miss them by as little as floats
// tell there.
std::vector<TracedRay> rays_at_rims(const Scene &scene, int for_each) {
  std::vector<TracedRay> rays;
  std::mt19937 random(13);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const Shape &shape : scene.shapes)
    for (int i = 0; i < for_each && shape.kind != Shape::Kind::plane; i++) {
      const int axis = i % 3;
      const glm::dmat3 m(glm::dvec3(shape.transform[0]), glm::dvec3(shape.transform[1]), glm::dvec3(shape.transform[2]));
      glm::dvec3 rim(m[0][axis], m[1][axis], m[2][axis]), along(0);
      if (shape.kind != Shape::Kind::sphere) rim.y = 0;
      rim = m * (shape.kind == Shape::Kind::quad ? glm::sign(rim) : glm::normalize(rim)) + glm::dvec3(shape.transform[3]);
      for (int c = 0; c < 3; c++) along[c] = unit(random);
      if (i % 2)
        along = m[0] + 0.1 * along;
      else
        along[axis] = 0;
      along = glm::normalize(along);
      const double distance = std::exp2(10 * std::abs(unit(random)));
      rays.push_back(ray_of(rim + m[0] * (1e-4 * distance * unit(random)) - distance * along, along));
    }
  return rays;
}

// The same shapes in boxes that decide nothing.
FlatScene without_boxes(FlatScene flat) {
  for (kernel::Instance &instance : flat.instances) {
    std::fill_n(instance.lower, 3, -1e6f);
    std::fill_n(instance.upper, 3, 1e6f);
  }
  return flat;
}

// Of a shape alone, without a tree: what its formula finds counts where the ray passes its box, at a distance that lies in it.
TEST(Shapes, TheirBoxHasTheLastWord) {
  const Scene skewed = skewed_shapes(false);
  std::size_t wrong = 0, kept[3] = {}, refused[3] = {}, nearer[3] = {}, farther[3] = {};
  for (const Shape &shape : skewed.shapes) {
    Scene scene = skewed;
    scene.shapes = {shape};
    const FlatScene flat = flattened(scene), bare = without_boxes(flat);
    const Tree tree = build_tree(flat, Layout::binary), bare_tree = build_tree(bare, Layout::binary);
    const kernel::Instance &instance = flat.instances[0];
    const auto kind = static_cast<std::size_t>(shape.kind);
    for (const TracedRay &ray : rays_at_rims(scene, 3000)) {
      Hit expected = host_closest(bare, bare_tree, ray, SUN_WANT_ALL);
      const Hit hit = host_closest(flat, tree, ray, SUN_WANT_ALL);
      if (expected.instance == SUN_NONE) {
        wrong += hit.instance != SUN_NONE;
        continue;
      }
      float reach[3];
      const float *origin = ray.ray.origin, *low = instance.lower, *high = instance.upper;
      for (int c = 0; c < 3; c++) reach[c] = std::max(std::abs(low[c] - origin[c]), std::abs(high[c] - origin[c]));
      kernel::PreparedRay prepared;
      ASSERT_TRUE(kernel::prepare_ray(&prepared, origin, ray.ray.direction, reach));
      const kernel::Interval box = kernel::box_interval(&prepared, low[0], low[1], low[2], high[0], high[1], high[2], 0);
      if (box.near > box.far) {
        refused[kind]++;
        wrong += hit.instance != SUN_NONE;
        continue;
      }
      (expected.t < box.near ? farther : expected.t > box.far ? nearer : kept)[kind]++;
      expected.t = std::clamp(expected.t, box.near, box.far);
      wrong += !same(hit, expected);
    }
  }
  EXPECT_EQ(wrong, 0u);
  for (std::size_t kind = 0; kind < 3; kind++) {
    EXPECT_GT(kept[kind], 1000u) << "shape " << kind;
    EXPECT_GT(refused[kind], 20u) << "shape " << kind;
    EXPECT_GT(farther[kind], 10u) << "shape " << kind;
    EXPECT_GT(nearer[kind], 10u) << "shape " << kind;
  }
}

// How many of the rays meet something else, or elsewhere, for want of boxes.
std::size_t decided_by_boxes(const FlatScene &flat, const std::vector<TracedRay> &rays) {
  const FlatScene bare = without_boxes(flat);
  const Tree tree = build_tree(flat, Layout::binary), bare_tree = build_tree(bare, Layout::binary);
  std::size_t decided = 0;
  for (const TracedRay &ray : rays) decided += !same(host_closest(flat, tree, ray, SUN_WANT_ALL), host_closest(bare, bare_tree, ray, SUN_WANT_ALL));
  return decided;
}

TEST(Shapes, OfEveryLayoutTheSameBits) {
  const std::optional<Device> device = test_device();
  if (!device) GTEST_SKIP() << "SKIP: no OpenCL device";
  for (const Scene &scene : {some_shapes(false), some_shapes(true), skewed_shapes(true)}) {
    const FlatScene flat = flattened(scene);
    const Tree tree = build_tree(flat, Layout::binary);
    std::vector<TracedRay> rays = random_rays(3000, 6), rims = rays_at_rims(scene, 200);
    EXPECT_GE(decided_by_boxes(flat, rims), scene.shapes[0].name == "skewed" ? 50u : 0u);
    rays.insert(rays.end(), rims.begin(), rims.end());
    const std::size_t fresh = rays.size();
    for (std::size_t i = 0; i < fresh; i++) {  // and on behind the first hit
      const Hit hit = host_closest(flat, tree, rays[i], SUN_WANT_ALL);
      if (hit.instance == SUN_NONE) continue;
      TracedRay on = rays[i];
      on.ray.passed_t = hit.t;
      on.passed_instance = hit.instance;
      on.passed_primitive = hit.primitive;
      rays.push_back(on);
    }
    for (const Layout layout : {Layout::binary, Layout::wide8, Layout::wide16}) {
      const Tracer tracer(*device, flat, layout);
      const std::vector<Hit> hits = tracer.closest(rays);
      const std::vector<uint> any = tracer.any(rays);
      std::size_t wrong = 0, wrong_any = 0;
      for (std::size_t i = 0; i < rays.size(); i++) {
        const Hit expected = host_closest(flat, tree, rays[i], SUN_WANT_ALL);
        wrong += !same(hits[i], expected);
        wrong_any += (any[i] != 0) != (expected.instance != SUN_NONE);
      }
      EXPECT_EQ(wrong, 0u) << layout_name(layout) << ", " << scene.shapes[0].name << ", meshes: " << scene.meshes.size();
      EXPECT_EQ(wrong_any, 0u) << layout_name(layout) << ", " << scene.shapes[0].name << ", meshes: " << scene.meshes.size();
    }
  }
}

// Shapes of every kind where chance puts them, scaled along the axes or sheared and mirrored; some twice in one place, some that touch.
Scene scattered_shapes(unsigned seed, bool with_mesh) {
  Scene scene = some_shapes(with_mesh);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-2.5f, 2.5f), size(0.2f, 1.2f), skew(-0.5f, 0.5f);
  for (int i = 0; i < 12; i++) {
    const auto kind = static_cast<Shape::Kind>(i % 4);
    const int material = i % 3 == 0;
    glm::mat4x3 m = placed({size(random), 0, 0}, {0, size(random), 0}, {0, 0, size(random)}, {place(random), place(random), place(random)});
    if (i % 2) m = placed({m[0].x, skew(random), skew(random)}, {skew(random), i % 4 == 3 ? -m[1].y : m[1].y, skew(random)}, {skew(random), skew(random), m[2].z}, m[3]);
    scene.shapes.push_back({kind, "scattered", material, m});
    if (i < 4) scene.shapes.push_back({kind, "twin", 0, m});
  }
  // In the plane of the floor, and a ball that stands on it.
  scene.shapes.push_back({Shape::Kind::quad, "mat", 0, placed({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, -0.5f, 0})});
  scene.shapes.push_back({Shape::Kind::sphere, "standing", 0, placed({0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}, {1, 0, 1})});
  return scene;
}

// Rays from everywhere, from within balls, that graze them, at rims, along the floor, that end before or at what they would meet, that have no
// direction; and on behind what they met.
std::vector<TracedRay> all_sorts_of_rays(const Scene &scene, const FlatScene &flat, const Tree &tree) {
  std::vector<TracedRay> rays = random_rays(1500, 4);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> turn(-1, 1);
  const auto direction = [&] { return glm::normalize(glm::dvec3(turn(random), turn(random), turn(random) + 1e-3)); };
  for (const Shape &shape : scene.shapes)
    for (int i = 0; i < 24; i++) {
      const glm::dmat3 m(glm::dvec3(shape.transform[0]), glm::dvec3(shape.transform[1]), glm::dvec3(shape.transform[2]));
      const glm::dvec3 center(shape.transform[3]), normal = direction(), along = glm::normalize(glm::cross(normal, direction()));
      rays.push_back(ray_of(center + m * (0.5 * normal), direction()));
      rays.push_back(ray_of(center + m * normal - m * (4.0 * along) * (1 + 1e-7 * i), m * along));
    }
  for (const TracedRay &ray : rays_at_rims(scene, 100)) rays.push_back(ray);
  for (int i = 0; i < 64; i++) rays.push_back(ray_of({-3, -0.5, 0.1 * i - 3}, {1, i % 3 ? 0 : 1e-9, 0.01 * i}));
  const std::size_t fresh = rays.size();
  for (std::size_t i = 0; i < fresh; i++) {
    const Hit hit = host_closest(flat, tree, rays[i], SUN_WANT_ALL);
    if (hit.instance == SUN_NONE) continue;
    TracedRay on = rays[i], ends = rays[i];
    on.ray.passed_t = hit.t;
    on.passed_instance = hit.instance;
    on.passed_primitive = hit.primitive;
    rays.push_back(on);
    const Hit next = host_closest(flat, tree, on, SUN_WANT_ALL);
    if (next.instance != SUN_NONE) {  // of twins it has passed both
      on.ray.passed_t = next.t;
      on.passed_instance = next.instance;
      on.passed_primitive = next.primitive;
      rays.push_back(on);
    }
    ends.ray.t_max = i % 2 ? hit.t : std::nextafter(hit.t, INFINITY);
    rays.push_back(ends);
  }
  rays.push_back(ray_of({0, 0, 5}, {0, 0, 0}));
  rays.push_back(ray_of({0, 0, INFINITY}, {0, 0, -1}));
  rays.push_back(ray_of({0, 0, 5}, {0, NAN, -1}));
  return rays;
}

// LANES rays that ask each shape, and the tree for the triangles: to the bit the hits of one ray in the binary tree.
TEST(Shapes, AskedByLanesGiveTheHitsOfTheTree) {
  const std::optional<Device> device = test_device();
  if (!device) GTEST_SKIP() << "SKIP: no OpenCL device";
  const std::vector<std::byte> bytes = read_file(SUNSTONE_SOURCE_DIR "/tests/kernels/probes/lanes.cl");
  const std::string text(reinterpret_cast<const char *>(bytes.data()), bytes.size());
  struct Way {
    int lanes;
    Layout layout;
    bool few, with_mesh;
  };
  const Way ways[] = {{1, Layout::binary, true, false}, {1, Layout::binary, true, true}, {8, Layout::wide8, true, true}, {16, Layout::wide16, true, false},
                      {16, Layout::wide16, true, true}, {16, Layout::binary, true, true}, {16, Layout::wide16, false, true}};
  for (const Way &way : ways) {
    const Program program = Program::from_text(*device, "lanes.cl", text,
                                               {{"LANES", way.lanes}, {"SUN_LAYOUT", int(way.layout)}, {"SUN_FEW_SHAPES", way.few}, {"SUN_TRIANGLES", way.with_mesh}});
    const Kernel kernel(program, "probe_lanes");
    for (const Scene &scene : {scattered_shapes(1, way.with_mesh), scattered_shapes(2, way.with_mesh), skewed_shapes(way.with_mesh)}) {
      const FlatScene flat = flattened(scene);
      const Tree binary = build_tree(flat, Layout::binary), tree = build_tree(flat, way.layout);
      const std::vector<TracedRay> rays = all_sorts_of_rays(scene, flat, binary);
      EXPECT_GE(decided_by_boxes(flat, rays), scene.shapes[0].name == "skewed" ? 50u : 0u);
      kernel::Frame frame{};
      frame.instance_count = uint(flat.instances.size() - flat.plane_count);
      frame.plane_count = uint(flat.plane_count);
      frame.first_shape = uint(flat.instances.size() - flat.shape_count);
      for (std::size_t axis = 0; axis < 3; axis++) {
        frame.lower[axis] = INFINITY;
        frame.upper[axis] = -INFINITY;
        for (uint i = 0; i < frame.instance_count; i++) {
          frame.lower[axis] = std::min(frame.lower[axis], flat.instances[i].lower[axis]);
          frame.upper[axis] = std::max(frame.upper[axis], flat.instances[i].upper[axis]);
        }
      }
      std::vector<TraceRay> plain;
      std::vector<uint> passed;
      for (const TracedRay &ray : rays) {
        plain.push_back(ray.ray);
        passed.insert(passed.end(), {ray.passed_instance, ray.passed_primitive});
      }
      const Buffer<kernel::Frame> frames(*device, std::span<const kernel::Frame>(&frame, 1), "frame");
      const Buffer<TraceRay> ray_buffer(*device, std::span<const TraceRay>(plain), "rays");
      const Buffer<uint> passed_buffer(*device, std::span<const uint>(passed), "passed"), blocked(*device, rays.size(), "blocked");
      const Buffer<Hit> hits(*device, rays.size(), "hits");
      const Buffer<std::byte> nodes(*device, std::span<const std::byte>(tree.nodes), "nodes"), leaves(*device, std::span<const std::byte>(tree.leaves), "leaves");
      const Buffer<uint> list(*device, std::span<const uint>(tree.instance_list), "list"), roots(*device, std::span<const uint>(tree.roots), "roots");
      const Buffer<kernel::Fragment> fragments(*device, std::span<const kernel::Fragment>(flat.fragments), "fragments");
      const Buffer<kernel::Instance> instances(*device, std::span<const kernel::Instance>(flat.instances), "instances");
      Kernel run = kernel;
      run.run((rays.size() + std::size_t(way.lanes) - 1) / std::size_t(way.lanes), frames, ray_buffer, passed_buffer, hits, blocked, uint(rays.size()), uint(SUN_WANT_ALL),
              nodes, leaves, list, roots, uint(tree.top_root), fragments, instances);
      const std::vector<Hit> found = hits.download();
      const std::vector<uint> stopped = blocked.download();
      std::size_t wrong = 0, wrong_any = 0, some = 0, worst = 0;
      for (std::size_t i = 0; i < rays.size(); i++) {
        const Hit expected = host_closest(flat, binary, rays[i], SUN_WANT_ALL);
        some += expected.instance != SUN_NONE;
        if (!same(found[i], expected)) {
          wrong++;
          worst = i;
        }
        wrong_any += (stopped[i] != 0) != (expected.instance != SUN_NONE);
      }
      const std::string how = "lanes " + std::to_string(way.lanes) + ", " + layout_name(way.layout) + (way.few ? ", few" : "") + (way.with_mesh ? ", with a mesh" : "");
      EXPECT_EQ(wrong, 0u) << how << ", ray " << worst;
      EXPECT_EQ(wrong_any, 0u) << how;
      EXPECT_GT(some, rays.size() / 3) << how;
      EXPECT_LT(some, rays.size()) << how;
    }
  }
}

// What is aligned with the axes is met as if it were not.
TEST(Shapes, AlignedOnesAreMetAsTheOthers) {
  const Scene scene = scattered_shapes(3, false);
  const FlatScene flat = flattened(scene);
  FlatScene plain = flat;
  std::size_t aligned = 0;
  for (kernel::Instance &instance : plain.instances) {
    aligned += (instance.flags & SUN_INSTANCE_ALIGNED) != 0;
    instance.flags &= ~SUN_INSTANCE_ALIGNED;
  }
  EXPECT_GT(aligned, 6u);
  EXPECT_LT(aligned, flat.shape_count);
  const Tree tree = build_tree(flat, Layout::binary);
  std::size_t wrong = 0;
  for (const TracedRay &ray : all_sorts_of_rays(scene, flat, tree)) {
    const Hit a = host_closest(flat, tree, ray, SUN_WANT_ALL), b = host_closest(plain, tree, ray, SUN_WANT_ALL);
    wrong += !(a.t == b.t && a.u == b.u && a.v == b.v && a.instance == b.instance && a.primitive == b.primitive);
  }
  EXPECT_EQ(wrong, 0u);
}

// One after the other, each once: a ray goes on strictly behind what it has passed.
TEST(Shapes, ASphereIsMetTwice) {
  Scene scene = some_shapes(false);
  scene.shapes.resize(1);
  const FlatScene flat = flattened(scene);
  const Tree tree = build_tree(flat, Layout::binary);
  TracedRay ray = ray_of({0.3, 1.2, 5}, {0, 0, -1});
  std::vector<float> met;
  for (int i = 0; i < 4; i++) {
    const Hit hit = host_closest(flat, tree, ray, SUN_WANT_ALL);
    if (hit.instance == SUN_NONE) break;
    met.push_back(hit.t);
    ray.ray.passed_t = hit.t;
    ray.passed_instance = hit.instance;
    ray.passed_primitive = hit.primitive;
  }
  const float half = std::sqrt(1.0f - 0.09f - 0.04f);
  ASSERT_EQ(met.size(), 2u);
  EXPECT_NEAR(met[0], 5 - half, 1e-6);
  EXPECT_NEAR(met[1], 5 + half, 1e-6);
}

// Rays along a plane, a quad, a disk: within it and beside it. None is a hit, and none is a NaN that counts.
TEST(Shapes, AreNotMetByRaysAlongThem) {
  for (const Shape::Kind kind : {Shape::Kind::plane, Shape::Kind::quad, Shape::Kind::disk}) {
    Scene scene = some_shapes(false);
    scene.shapes = {{kind, "flat", 0, glm::mat4x3(1)}};
    const FlatScene flat = flattened(scene);
    const Tree tree = build_tree(flat, Layout::binary);
    for (const double height : {0.0, 1e-7, 1.0, -1.0})
      for (int i = 0; i < 64; i++) {
        const double angle = i * 0.1;
        const TracedRay ray = ray_of({-3 * std::cos(angle), height, -3 * std::sin(angle)}, {std::cos(angle), 0, std::sin(angle)});
        EXPECT_EQ(host_closest(flat, tree, ray, SUN_WANT_ALL).instance, SUN_NONE);
        EXPECT_FALSE(host_any(flat, tree, ray, SUN_WANT_ALL));
      }
    // And by those that all but run along it, they are: at the distance that the slope says.
    const Hit hit = host_closest(flat, tree, ray_of({-0.5, 1e-4, 0}, {1, -2e-4, 0}), SUN_WANT_ALL);
    ASSERT_NE(hit.instance, SUN_NONE);
    EXPECT_NEAR(hit.t, 0.5, 1e-4);
    EXPECT_NEAR(hit.u, 0.0, 1e-4);
  }
}

// Grazing rays: within a few millionths of its radius a sphere has the outline it should, near and far.
TEST(Shapes, KeepTheirOutlineFarAway) {
  Scene scene = some_shapes(false);
  for (const float distance : {3.0f, 100.0f, 1000.0f}) {
    scene.shapes = {{Shape::Kind::sphere, "ball", 0, glm::mat4x3(1)}};
    const FlatScene flat = flattened(scene);
    const Tree tree = build_tree(flat, Layout::binary);
    const double error = 4e-7 * static_cast<double>(distance);
    for (int i = 0; i < 200; i++) {
      const double angle = i * 0.0314;
      const auto at = [&](double radius) { return ray_of({radius * std::cos(angle), radius * std::sin(angle), distance}, {0, 0, -1}); };
      EXPECT_NE(host_closest(flat, tree, at(1 - error - 1e-6), SUN_WANT_ALL).instance, SUN_NONE) << distance;
      EXPECT_EQ(host_closest(flat, tree, at(1 + error + 1e-6), SUN_WANT_ALL).instance, SUN_NONE) << distance;
    }
  }
}

}  // namespace
}  // namespace sunstone::hits
