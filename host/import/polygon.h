// SPDX-License-Identifier: Apache-2.0
// Polygons cut into triangles: concave ones too, with bridges to holes, repeated corners, and corners that lie a little off the plane.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace sunstone {

// Appends n - 2 triangles, three numbers of corners each, with the polygon's winding; those of repeated or collinear corners have no area. Ear
// clipping in double precision ([Meisters75]). Returns false where the polygon crosses itself, or is too intricate to look at in full, and what comes
// out is not a partition of it.
bool triangulate_polygon(std::span<const glm::vec3> corners, std::vector<std::uint32_t> &triangles);

}  // namespace sunstone
