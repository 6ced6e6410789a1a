// SPDX-License-Identifier: Apache-2.0
// Tangents after [Mikkelsen08], the ones that normal maps are baked for.
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace sunstone {

// One tangent a corner (three a triangle) from positions, unit normals and texture coordinates of the corners, v down as in glTF.
// w = +1 or -1: bitangent = w * cross(normal, tangent) points to where v falls, as normal maps have it. All 0 where the coordinates give none.
std::vector<glm::vec4> make_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals, std::span<const glm::vec2> uvs);

}  // namespace sunstone
