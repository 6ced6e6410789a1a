// SPDX-License-Identifier: Apache-2.0
// Analytic shapes -> instances that are hit in a space of their own.
#pragma once
#include "flatten/flatten.h"

namespace sunstone {

// Adds an instance for each plane, or for each shape of another kind, and the triangle that stands for it: it takes up the primitive number and holds the material, and
// its corners are one point, so no ray hits it. `extras`: vertices have them.
void write_shapes(const Scene &scene, bool planes, bool extras, FlatScene &flat, Notices &notices);

}  // namespace sunstone
