// SPDX-License-Identifier: Apache-2.0
// Scenes on which hits go wrong when anything is wrong, each with rays that look for it.
#pragma once
#include <string>
#include <vector>

#include "kernels/hits/soup.h"

namespace sunstone::hits {

struct Case {
  std::string name;
  FlatScene scene;
  std::vector<TraceRay> rays;
};

Case random_triangles();      // of all sizes, rays from anywhere
Case boxes_on_floor();        // coplanar and axis-aligned: rays along axes, within planes, at corners and edges
Case degenerate_triangles();  // points, needles, slivers, and the same triangle fifty times
Case instances();             // rotated, mirrored, scaled, overlapping, the same box twice; identity instances among them
Case one_turned_instance();   // no top tree, yet a transform
Case far_from_origin();       // a small scene at 10^5, large coordinates and tiny triangles together
Case sides_and_kinds();       // single-sided and passable triangles in layers, mirrored too
Case in_pieces(Case c);       // the same with its triangles cut into about four pieces each
std::vector<Case> all_cases();  // as they are, and in pieces

}  // namespace sunstone::hits
