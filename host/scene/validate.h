// SPDX-License-Identifier: Apache-2.0
// The last gate before flatten: every index, size and number of a Scene, whoever made it.
#pragma once
#include "base/notice.h"
#include "scene/scene.h"

namespace sunstone {

// Drops triangles with a corner that is not finite or beyond 1e18 (one warning with the count), instances and shapes of singular transforms, and meshes left
// empty by that; clamps factors into their ranges with a warning; throws Error{file: place, ...} on an index out of range or arrays of unequal length.
void validate(Scene &scene, const std::string &file, Notices &notices);

// World-space bounds of all instances and shapes, infinite planes apart.
Bounds scene_bounds(const Scene &scene);
// Of one shape; empty for an infinite plane.
Bounds shape_bounds(const Shape &shape);

}  // namespace sunstone
