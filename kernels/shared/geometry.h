// SPDX-License-Identifier: Apache-2.0
// Flattened geometry. Triangles of all meshes stand in one array; a triangle's index there is its `primitive` number.
// A mesh that one node uses is baked: its vertices are in world space and its instance is the identity. Others are in the mesh's own space.
#ifndef SUN_SHARED_GEOMETRY_H
#define SUN_SHARED_GEOMETRY_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

typedef struct Triangle {
  uint vertex[3];  // into Vertex[]; counter-clockwise seen from the front
  uint material;
} Triangle;
SUN_STATIC_ASSERT(sizeof(Triangle) == 16, triangle_is_16_bytes);

typedef struct Vertex {
  float position[3];
  float u;          // texture coordinates of set 0
  float normal[3];  // unit length
  float v;
} Vertex;
SUN_STATIC_ASSERT(sizeof(Vertex) == 32, vertex_is_32_bytes);

// Beside each Vertex, where any mesh of the scene has normal maps, colours or a second UV set; otherwise the array has one element.
typedef struct VertexExtra {
  float tangent[4];  // xyz unit length, w = +1 or -1: bitangent = w * cross(normal, tangent); all 0 where there is none
  float color[4];    // linear; 1 where the mesh has none
  float uv1[2];
  float pad[2];
} VertexExtra;
SUN_STATIC_ASSERT(sizeof(VertexExtra) == 48, vertex_extra_is_48_bytes);

#define SUN_INSTANCE_IDENTITY 1u  // to_world is exactly the identity: rays and vertices are used as they are
#define SUN_INSTANCE_MIRRORED 2u  // determinant < 0: the front, counter-clockwise in mesh space, reads clockwise in world space
#define SUN_INSTANCE_ALIGNED 4u   // of shapes: both matrices scale along the axes and move, no more
#define SUN_INSTANCE_ROUND 8u     // of spheres: aligned, and scaled alike along all axes
// An analytic shape, in a space of its own: a sphere of radius 1, or, in y = 0 with the front towards +y, a disk of radius 1, a quad from -1 to 1, and all
// of the plane. One Triangle stands for it (its primitive number, its material), which no ray can hit. Planes have no bounds: their instances stand
// behind all others, and trees know nothing of them.
#define SUN_INSTANCE_SPHERE 16u
#define SUN_INSTANCE_DISK 32u
#define SUN_INSTANCE_QUAD 64u
#define SUN_INSTANCE_PLANE 128u
#define SUN_INSTANCE_SHAPE 240u         // any of them; with these bits, as ids of triangles have them:
#define SUN_INSTANCE_SINGLE_SIDED 256u
#define SUN_INSTANCE_PASSABLE 512u
#define SUN_INSTANCE_MOVING 1024u       // has keys (shared/motion.h); to_world is that of key 0, and the bounds are those of all of its way
#define SUN_INSTANCE_DEFORMING 2048u    // its mesh's vertices have keys
#define SUN_INSTANCE_MOTION_SHIFT 12    // the rest: its number among the moving ones
#define SUN_MOST_MOVING_INSTANCES 1048576u
// A plane ends so far from its origin, in units of its own: beyond, floats tell its points no longer apart.
#define SUN_PLANE_REACH 1073741824.0f  // 2^30

typedef struct Instance {
  float to_world[12];   // 3x4, row major: world = M * (x, y, z, 1)
  float to_object[12];  // its inverse
  float lower[3];       // bounds in world space: part of the scene, a hit counts only where this box passes
  uint flags;
  float upper[3];
  uint first_emitter;   // emitter of local emissive triangle 0, or SUN_NONE
} Instance;
SUN_STATIC_ASSERT(sizeof(Instance) == 128, instance_is_128_bytes);

SUN_NAMESPACE_END
#endif
