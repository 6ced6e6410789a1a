// SPDX-License-Identifier: Apache-2.0
// Meshes and instances -> vertices, triangles, ids and instances.
#pragma once
#include "flatten/flatten.h"

namespace sunstone {

// How often a mesh is shown, and whether its instances are baked into world space: a mesh shown once always is, and a small one where all copies
// together stay below a limit. Decided from the scene alone, as it is scene data: hits depend on it.
struct MeshUse {
  std::size_t instances = 0, triangles = 0;
  bool baked = false;
};
std::vector<MeshUse> mesh_uses(const Scene &scene);

// Does a primitive get tangents of our own making?
bool needs_tangents(const Scene &scene, const Primitive &primitive);

// Fills vertices, vertex_extras, triangles, triangle_ids, triangle_emitter, meshes, instance_mesh, instances (but for first_emitter) and bounds.
// Shapes follow, each with a range of its own. All baked meshes are mesh range 0 and instance 0, the identity. There is always an instance; an empty scene has one of an empty mesh.
// flat.materials has to be finished. `max_bytes`: of one buffer.
void flatten_geometry(const Scene &scene, std::size_t max_bytes, FlatScene &flat, Notices &notices);

}  // namespace sunstone
