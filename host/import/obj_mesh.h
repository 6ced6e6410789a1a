// SPDX-License-Identifier: Apache-2.0
// Faces of an OBJ file -> primitives: triangles, normals, and vertices shared where all their indices agree.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace sunstone {

// What tinyobjloader read, every index checked against its array. Indices count from 0; -1: none.
struct ObjFaces {
  struct Corner {
    int position = -1, texture_coordinate = -1, normal = -1;
  };
  std::span<const float> positions, texture_coordinates, normals, colors;  // 3, 2, 3 and (or empty) 3 numbers each
  std::vector<Corner> corners;                                             // of all faces, one after the other
  std::vector<std::uint32_t> counts;                                       // of corners, by face
  std::vector<int> materials;                                              // by face; -1: none
  std::vector<std::uint32_t> smoothing;                                    // group, by face; 0: off
};

struct ObjMesh {
  Mesh mesh;
  std::size_t crossing = 0;  // polygons that cross themselves
};

// One primitive a material, in the order of materials (the default one first). A corner's normal is the file's; else, in a smoothing group, the mean
// of the group's faces around that place, weighted after [Max99]; else its face's.
ObjMesh build_obj_mesh(const ObjFaces &faces);

}  // namespace sunstone
