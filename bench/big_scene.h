// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "flatten/flatten.h"

namespace sunstone {

// A room of 20 x 8 x 20 metres, about a million triangles of very uneven density: bumpy floor, displaced spheres, clusters of small balls, grass,
// long thin rods. One mesh, one instance of identity, no tree yet.
FlatScene make_big_scene();

}  // namespace sunstone
