// SPDX-License-Identifier: Apache-2.0
// Points of analytic shapes (shared/geometry.h), LANES at once: from a hit's (u, v) or from sample numbers to place, normal, area and texture coordinates.
// Included by surface.h.
#ifndef SUN_SCENE_SHAPE_SURFACE_H
#define SUN_SCENE_SHAPE_SURFACE_H
#include "math/elementary.h"
#include "math/warp.h"
#include "scene/scene.h"

SUN_NAMESPACE_BEGIN

typedef struct Matrix {
  real m[12];  // 3x4, row major
} Matrix;

typedef struct ShapePoint {
  vec3 position;  // world
  vec3 normal;    // of the front, unit length: out of a sphere
  real area;      // of the shape, had it everywhere the scale that it has here: 1 / area is the density per area of sample_shape_point
  real offset;    // of new rays, as surface_offset gives it
  real uv[2];
} ShapePoint;

SUN_FN mask is_shape(uint_n flags, uint kind) { return (flags & (uint_n)(kind)) != (uint_n)(0); }

// The place, in the shape's own space, that scene/shape.h wrote into a hit.
SUN_FN vec3 shape_place(uint_n flags, real u, real v) {
  real y = 1.0f - fabs(u) - fabs(v), fold = max_real(-y, (real)(0.0f));
  vec3 of_sphere = normalize3(make_vec3(u - copysign(fold, u), y, v - copysign(fold, v)));
  return select3(is_shape(flags, SUN_INSTANCE_SPHERE), of_sphere, make_vec3(u, (real)(0.0f), v));
}

// The same of a place that was found along a ray, and is nearly one of the shape.
SUN_FN vec3 shape_place_near(uint_n flags, vec3 place) {
  return select3(is_shape(flags, SUN_INSTANCE_SPHERE), normalize3(place), make_vec3(place.x, (real)(0.0f), place.z));
}

// The same numbers for one shape with SUN_INSTANCE_ALIGNED, from the place in world space: what its zeros add is left out.
SUN_FN vec3 aligned_shape_place_near(const SUN_GLOBAL float *to_object, uint flags, vec3 position) {
  vec3 place = make_vec3(to_object[0] * position.x + to_object[3], to_object[5] * position.y + to_object[7], to_object[10] * position.z + to_object[11]);
  if (flags & SUN_INSTANCE_SPHERE) return normalize3(place);
  return make_vec3(place.x, (real)(0.0f), place.z);
}

// A place that is uniform in area, where the shape's space is scaled alike along all axes; ShapePoint's area holds in any case.
SUN_FN vec3 sample_shape_place(uint_n flags, vec2 u) {
  vec2 disk = square_to_disk(u);
  vec3 flat = make_vec3(2.0f * u.x - 1.0f, (real)(0.0f), 2.0f * u.y - 1.0f);
  flat = select3(is_shape(flags, SUN_INSTANCE_DISK), make_vec3(disk.x, (real)(0.0f), disk.y), flat);
  return select3(is_shape(flags, SUN_INSTANCE_SPHERE), square_to_uniform_sphere(u), flat);
}

// What follows from the sum of the columns of to_world, each scaled by its coordinate of the place; from `growth`, along the normal, of the length by which areas
// grow, and from `normal`, that direction. `terms`: sums of the sizes of what was added.
SUN_FN ShapePoint finish_shape_point(uint_n flags, vec3 position, vec3 growth, vec3 normal, vec3 terms) {
  ShapePoint point;
  real scale = sqrt(dot3(growth, growth));
  point.position = position;
  point.normal = select3(is_shape(flags, SUN_INSTANCE_MIRRORED), negate3(normal), normal);
  point.area = scale * (is_shape(flags, SUN_INSTANCE_SPHERE) ? (real)(4.0f * SUN_PI) : is_shape(flags, SUN_INSTANCE_DISK) ? (real)(SUN_PI) : (real)(4.0f));
  point.offset = max_of3(terms) * 3.81469727e-6f;  // 2^-18 of the largest terms that were added, as of a triangle's coordinates (surface_offset)
  point.uv[0] = point.uv[1] = (real)(0.0f);
  return point;
}

SUN_FN ShapePoint shape_point(const Matrix *to_world, uint_n flags, vec3 place) {
  const real *m = to_world->m;
  vec3 x = make_vec3(m[0], m[4], m[8]), y = make_vec3(m[1], m[5], m[9]), z = make_vec3(m[2], m[6], m[10]);
  // By the cofactors: areas across the normal grow by the length of what this makes of it.
  vec3 up = cross3(z, x);
  vec3 round = add3(add3(scale3(cross3(y, z), place.x), scale3(up, place.y)), scale3(cross3(x, y), place.z));
  vec3 growth = select3(is_shape(flags, SUN_INSTANCE_SPHERE), round, up);
  vec3 normal = select3(is_shape(flags, SUN_INSTANCE_ROUND), place, normalize3(growth));
  vec3 across = scale3(x, place.x), along = scale3(y, place.y), down = scale3(z, place.z);
  vec3 origin = make_vec3(m[3], m[7], m[11]);
  vec3 terms = make_vec3(fabs(across.x) + fabs(along.x) + fabs(down.x) + fabs(origin.x), fabs(across.y) + fabs(along.y) + fabs(down.y) + fabs(origin.y),
                         fabs(across.z) + fabs(along.z) + fabs(down.z) + fabs(origin.z));
  return finish_shape_point(flags, add3(add3(add3(across, along), down), origin), growth, normal, terms);
}

// The same numbers for one shape with SUN_INSTANCE_ALIGNED: what its zeros add is left out.
SUN_FN ShapePoint aligned_shape_point(const SUN_GLOBAL float *to_world, uint flags, vec3 place) {
  const float x = to_world[0], y = to_world[5], z = to_world[10], up = z * x;
  vec3 origin = make_vec3((real)(to_world[3]), (real)(to_world[7]), (real)(to_world[11]));
  vec3 growth, normal;
  if (flags & SUN_INSTANCE_SPHERE) {
    growth = make_vec3((y * z) * place.x, up * place.y, (x * y) * place.z);
    normal = place;
    if (!(flags & SUN_INSTANCE_ROUND)) normal = normalize3(growth);
  } else {
    const float inverse = 1.0f / sqrt(up * up);
    growth = make_vec3((real)(0.0f), (real)(up), (real)(0.0f));
    normal = make_vec3((real)(0.0f), (real)(up * inverse), (real)(0.0f));
  }
  vec3 part = make_vec3(x * place.x, y * place.y, z * place.z);
  vec3 terms = make_vec3(fabs(part.x) + fabs(origin.x), fabs(part.y) + fabs(origin.y), fabs(part.z) + fabs(origin.z));
  return finish_shape_point((uint_n)(flags), add3(part, origin), growth, normal, terms);
}

// A sphere's are those of environments; a disk's and a quad's run over the square around it, from the corner at -x, -z; a plane's are x and z.
SUN_FN void shape_coordinates(ShapePoint *point, uint_n flags, vec3 place) {
  mask plane = is_shape(flags, SUN_INSTANCE_PLANE), sphere = is_shape(flags, SUN_INSTANCE_SPHERE);
  point->uv[0] = plane ? place.x : 0.5f * place.x + 0.5f;
  point->uv[1] = plane ? place.z : 0.5f * place.z + 0.5f;
  if (ANY(sphere)) {
    real sine = sqrt(place.x * place.x + place.z * place.z);
    real u = 0.5f + atan2_real(place.z, place.x) * SUN_INV_TWO_PI, v = atan2_real(sine, place.y) * SUN_INV_PI;
    point->uv[0] = sphere ? u : point->uv[0];
    point->uv[1] = sphere ? v : point->uv[1];
  }
}

SUN_NAMESPACE_END
#endif
