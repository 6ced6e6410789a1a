// SPDX-License-Identifier: Apache-2.0
// Trees over flattened geometry: Embree's builder, collapsed into the layout.
#pragma once
#include "flatten/flatten.h"

namespace sunstone {

// Reads vertices, triangles, triangle_ids, fragments, meshes, instances and instance_mesh of `scene` and gives the tree of that layout: a tree a mesh, and one
// over the instances where there is more than one. Deterministic results are not asked of it: no hit depends on the tree.
Tree build_tree(const FlatScene &scene, Layout layout, const std::function<void(const char *what, double fraction)> &progress = {});

}  // namespace sunstone
