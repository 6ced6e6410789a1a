// SPDX-License-Identifier: Apache-2.0
// Long triangles in pieces, so that a tree's boxes fit them: the tree holds the pieces' boxes, a hit stays the triangle's own.
#pragma once
#include "flatten/flatten.h"

namespace sunstone {

struct SplitOptions {
  kernel::uint least_triangles = 256;  // a smaller mesh has no tree to speak of
  double splits_a_triangle = 0.15;     // of all triangles of a mesh together
};

// Fills `fragments`, and each mesh's range of them, from vertices, triangles and meshes; replaces what was there. The pieces are scene data, a function
// of the mesh's triangles alone, with the same bits on every host: which boxes a triangle has can decide whether a ray meets it at all.
// Splits go to the triangles that fill their boxes least, at the planes that halve the mesh's bounds again and again [Karras13, section 4].
void split_long_triangles(FlatScene &scene, const SplitOptions &options = {});

}  // namespace sunstone
