// SPDX-License-Identifier: Apache-2.0
// One primitive with all its attributes made, in its mesh's space, each distinct corner once.
#pragma once
#include "scene/scene.h"

namespace sunstone {

struct WeldedPrimitive {
  std::vector<std::uint32_t> source;   // by vertex: into the primitive's attribute arrays
  std::vector<glm::vec3> normals;      // by vertex, unit length
  std::vector<glm::vec4> tangents;     // by vertex, or empty where no normal map asks for them
  std::vector<std::uint32_t> indices;  // three a triangle
  std::size_t dropped = 0;             // triangles without area
};

// Flat normals where the primitive has none, tangents after Mikkelsen where `tangents` and it has none. Vertices that no triangle uses are left out;
// the others stand in the order of their first use.
WeldedPrimitive weld(const Primitive &primitive, bool tangents, int uv_set);

// The cross product of two edges, in double. Zero exactly where the corners lie on a line (to double's precision).
glm::dvec3 triangle_cross(const glm::vec3 &a, const glm::vec3 &b, const glm::vec3 &c);

// `v` with unit length as kernels/math gives it, whatever its magnitude; (0, 0, 1) for the zero vector.
glm::vec3 unit_vector(const glm::dvec3 &v);

}  // namespace sunstone
