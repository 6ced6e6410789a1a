// SPDX-License-Identifier: Apache-2.0
#include "kernels/hits/cases.h"

#include <cmath>

#include "flatten/fragments.h"

namespace sunstone::hits {
namespace {

using glm::vec3;
using kernel::uint;

void random_rays(Case &c, Random &random, int count) {
  const vec3 lower = c.scene.bounds.lower, upper = c.scene.bounds.upper, margin = 0.2f * (upper - lower);
  for (int i = 0; i < count; i++) {
    const vec3 origin = random.in_box(lower - margin, upper + margin);
    const vec3 direction = i % 2 ? random.direction() : random.in_box(lower, upper) - origin;
    c.rays.push_back(make_ray(origin, direction));
  }
}

// At corners, along edges and at middles of edges of the scene's triangles; of instances, in the world.
void aimed_rays(Case &c, Random &random, int count) {
  const vec3 lower = c.scene.bounds.lower, upper = c.scene.bounds.upper;
  for (int i = 0; i < count; i++) {
    const uint number = random.number() % uint(c.scene.instances.size());
    const MeshRange &mesh = c.scene.meshes[c.scene.instance_mesh[number]];
    const kernel::Triangle &triangle = c.scene.triangles[mesh.first_triangle + random.number() % mesh.triangle_count];
    vec3 p[3];
    for (int k = 0; k < 3; k++) {
      const float *v = c.scene.vertices[triangle.vertex[k]].position, *m = c.scene.instances[number].to_world;
      for (int row = 0; row < 3; row++) p[k][row] = m[4 * row] * v[0] + m[4 * row + 1] * v[1] + m[4 * row + 2] * v[2] + m[4 * row + 3];
    }
    const vec3 target = i % 3 == 0 ? p[0] : i % 3 == 1 ? 0.5f * (p[0] + p[1]) : p[0] + random.unit() * (p[2] - p[0]);
    const vec3 origin = random.in_box(lower - 1.0f, upper + 1.0f);
    c.rays.push_back(make_ray(origin, target - origin));
    if (i % 4 == 0) c.rays.push_back(make_ray(p[1], p[2] - p[1]));              // within the triangle's plane, along its edge
    if (i % 4 == 1) c.rays.push_back(make_ray(origin, target - origin, 1.0f));  // ends at the surface
  }
}

}  // namespace

Case random_triangles() {
  Random random(1);
  Soup soup;
  for (int i = 0; i < 500; i++) {
    const float size = std::exp2(random.in(-8, 1));
    const vec3 at = random.in_box(vec3(-3), vec3(3));
    soup.triangle(at, at + random.in_box(vec3(-size), vec3(size)), at + random.in_box(vec3(-size), vec3(size)));
  }
  Case c{"random triangles", soup.finish(), {}};
  random_rays(c, random, 2500);
  aimed_rays(c, random, 600);
  return c;
}

Case boxes_on_floor() {
  Random random(2);
  Soup soup;
  for (int z = 0; z < 6; z++)
    for (int x = 0; x < 6; x++) soup.quad(vec3(x, 0, z), vec3(x, 0, z + 1), vec3(x + 1, 0, z + 1), vec3(x + 1, 0, z));
  for (int i = 0; i < 24; i++) {  // bottoms coincide with the floor, sides with the grid and with one another
    const float x = float(random.number() % 5), z = float(random.number() % 5), height = 0.25f * float(1 + random.number() % 4);
    soup.box(vec3(x, 0, z), vec3(x + 1, height, z + 1));
  }
  Case c{"boxes on a floor", soup.finish(), {}};
  const float grid[] = {0.0f, 0.25f, 0.5f, 1.0f, 1.5f, 2.0f, 3.0f, 4.75f, 5.0f, 6.0f};
  for (const float a : grid)
    for (const float b : grid) {
      c.rays.push_back(make_ray({a, 5, b}, {0, -1, 0}));
      c.rays.push_back(make_ray({a, -2, b}, {0, 1, 0}));
      c.rays.push_back(make_ray({-1, 0.25f * b, a}, {1, 0, 0}));
      c.rays.push_back(make_ray({a, 0.25f * b, 7}, {0, 0, -1}));
      c.rays.push_back(make_ray({7, 0, a}, {-1, 0, 0}));      // within the floor
      c.rays.push_back(make_ray({a, 0, b}, {1, 0, 1}));       // from within it
      c.rays.push_back(make_ray({a, 3, b}, {-0.0f, -2, 0}));  // signed zeros
      c.rays.push_back(make_ray({a, 1, b}, {1, -1, 0}));
      c.rays.push_back(make_ray({a, 1, b}, {1e-30f, -1, 1e-30f}));
    }
  random_rays(c, random, 1500);
  aimed_rays(c, random, 1200);
  return c;
}

Case degenerate_triangles() {
  Random random(3);
  Soup soup;
  for (int i = 0; i < 50; i++) soup.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (int i = 0; i < 40; i++) {
    const vec3 a = random.in_box(vec3(-1), vec3(1)), b = random.in_box(vec3(-1), vec3(1));
    soup.triangle(a, a, a);
    soup.triangle(a, b, b);
    soup.triangle(a, b, a + 0.5f * (b - a));                      // in line
    soup.triangle(a, b, a + 0.5f * (b - a) + vec3(0, 1e-7f, 0));  // nearly
    soup.triangle(a * 1e-12f, b * 1e-12f, vec3(a.y, b.x, a.z) * 1e-12f);
    soup.triangle({a.x, a.y, 0}, {b.x, b.y, 0}, {a.y, b.x, 0});  // all in one plane, over one another
  }
  Case c{"degenerate triangles", soup.finish(), {}};
  random_rays(c, random, 1500);
  aimed_rays(c, random, 600);
  for (int i = 0; i < 200; i++) c.rays.push_back(make_ray({random.in(-1, 1), random.in(-1, 1), 3}, {0, 0, -1}));
  c.rays.push_back(make_ray({0, 0, 3}, {0, 0, 0}));
  c.rays.push_back(make_ray({0, 0, 3}, {0, 0, NAN}));
  c.rays.push_back(make_ray({0, INFINITY, 3}, {0, 0, 1}));
  c.rays.push_back(make_ray({0.25f, 0.25f, 3}, {0, 0, -1}, INFINITY));
  c.rays.push_back(make_ray({0.25f, 0.25f, 3}, {0, 0, -1}, 3.0f));  // t_max at the surface: no hit there
  c.rays.push_back(make_ray({0.25f, 0.25f, 3}, {0, 0, -1}, -1.0f));
  c.rays.push_back(make_ray({0.25f, 0.25f, 0}, {0, 0, -1}));  // from the surface: none either
  return c;
}

Case instances() {
  Random random(4);
  Soup soup;
  const uint box = soup.begin_mesh();
  soup.box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f});
  const uint blob = soup.begin_mesh();
  for (int i = 0; i < 60; i++) {
    const vec3 a = random.direction();
    soup.triangle(a, a + 0.4f * random.direction(), a + 0.4f * random.direction());
  }
  const uint floor = soup.begin_mesh();
  soup.quad({-5, -0.5f, -5}, {-5, -0.5f, 5}, {5, -0.5f, 5}, {5, -0.5f, -5});
  soup.instance(floor, identity);
  soup.instance(box, identity);
  soup.instance(box, identity);              // the same again: ties between instances
  soup.instance(box, translation(1, 0, 0));  // face to face with the first
  soup.instance(box, multiply(translation(2, 0, 0), scaling(-1, 1, 1)));
  for (int i = 0; i < 30; i++) {
    Matrix m = multiply(rotation(0, random.in(0, 6)), rotation(1, random.in(0, 6)));
    const float size = std::exp2(random.in(-3, 1));
    m = multiply(m, scaling(i % 3 ? size : -size, size, i % 5 ? size : 2 * size));
    m = multiply(translation(random.in(-3, 3), random.in(-1, 3), random.in(-3, 3)), m);
    soup.instance(i % 2 ? box : blob, m);
  }
  soup.instance(blob, identity);
  Case c{"instances", soup.finish(), {}};
  random_rays(c, random, 2500);
  aimed_rays(c, random, 1200);
  for (int i = 0; i < 200; i++) c.rays.push_back(make_ray({random.in(-1, 3), 4, random.in(-1, 1)}, {0, -1, 0}));
  for (const float x : {-0.5f, 0.0f, 0.5f, 1.5f, 2.5f}) {
    c.rays.push_back(make_ray({x, 4, 0.5f}, {0, -1, 0}));
    c.rays.push_back(make_ray({x, 0.5f, 4}, {0, 0, -1}));
  }
  return c;
}

Case one_turned_instance() {
  Random random(5);
  Soup soup;
  soup.begin_mesh();
  for (int i = 0; i < 200; i++) {
    const vec3 a = random.direction();
    soup.triangle(a, a + 0.3f * random.direction(), a + 0.3f * random.direction());
  }
  soup.instance(0, multiply(translation(3, -1, 2), multiply(rotation(1, 0.7f), scaling(2, 2, -0.5f))));
  Case c{"one turned instance", soup.finish(), {}};
  random_rays(c, random, 1500);
  aimed_rays(c, random, 500);
  return c;
}

Case far_from_origin() {
  Random random(6);
  Soup soup;
  for (int i = 0; i < 300; i++) {
    const vec3 at = vec3(1e5f, -2e5f, 5e4f) + random.in_box(vec3(-4), vec3(4));
    soup.triangle(at, at + random.in_box(vec3(-1), vec3(1)), at + random.in_box(vec3(-1), vec3(1)));
  }
  soup.triangle({-1e6f, -3e5f, 0}, {1e6f, -3e5f, -1e6f}, {1e6f, -3e5f, 1e6f});
  for (int i = 0; i < 50; i++) {
    const vec3 at = random.in_box(vec3(-1e-3f), vec3(1e-3f));
    soup.triangle(at, at + random.in_box(vec3(-1e-4f), vec3(1e-4f)), at + random.in_box(vec3(-1e-4f), vec3(1e-4f)));
  }
  Case c{"far from the origin", soup.finish(), {}};
  for (int i = 0; i < 1200; i++) {
    const vec3 origin = vec3(1e5f, -2e5f, 5e4f) + random.in_box(vec3(-6), vec3(6));
    c.rays.push_back(make_ray(origin, random.direction()));
  }
  for (int i = 0; i < 300; i++) c.rays.push_back(make_ray(random.in_box(vec3(-1e-3f), vec3(1e-3f)), random.direction()));
  aimed_rays(c, random, 600);
  return c;
}

Case sides_and_kinds() {
  Random random(7);
  Soup soup;
  const uint sheets = soup.begin_mesh();
  for (int i = 0; i < 24; i++) {
    const float z = 0.125f * float(i / 2);  // two at each height, so kinds share a t
    const uint bits = (random.number() & 1 ? SUN_ID_SINGLE_SIDED : 0u) | (random.number() & 1 ? SUN_ID_PASSABLE : 0u);
    if (i % 3)
      soup.quad({0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}, bits);
    else
      soup.quad({0, 0, z}, {0, 1, z}, {1, 1, z}, {1, 0, z}, bits);
  }
  soup.instance(sheets, identity);
  soup.instance(sheets, multiply(translation(0.5f, 0, 0), scaling(-1, 1, 1)));
  soup.instance(sheets, multiply(translation(-0.3f, 0.2f, 1), rotation(1, 2.5f)));
  Case c{"sides and kinds", soup.finish(), {}};
  for (int i = 0; i < 400; i++) c.rays.push_back(make_ray({random.in(-1, 1), random.in(0, 1), i % 2 ? 3.0f : -1.0f}, {0, 0, i % 2 ? -1.0f : 1.0f}));
  random_rays(c, random, 1000);
  return c;
}

Case in_pieces(Case c) {
  split_long_triangles(c.scene, {.least_triangles = 1, .splits_a_triangle = 3.0});
  c.name += ", in pieces";
  return c;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  cases.push_back(random_triangles());
  cases.push_back(boxes_on_floor());
  cases.push_back(degenerate_triangles());
  cases.push_back(instances());
  cases.push_back(one_turned_instance());
  cases.push_back(far_from_origin());
  cases.push_back(sides_and_kinds());
  for (std::size_t i = 0, whole = cases.size(); i < whole; i++) cases.push_back(in_pieces(cases[i]));
  return cases;
}

}  // namespace sunstone::hits
