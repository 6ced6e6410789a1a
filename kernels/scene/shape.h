// SPDX-License-Identifier: Apache-2.0
// The hit test of analytic shapes (shared/geometry.h says what they are), in the shape's own space, and by the rules of triangle.h: the ray passes the
// instance's world box, and t is clamped into that; (t, instance, primitive) lies strictly between what the ray passed and the best hit so far. A shape
// has one primitive number, so where a ray meets a sphere twice the nearer that counts is taken. Planes have no box.
// A hit's u and v name the point: x and z of what lies in y = 0; of a sphere the direction from its centre, by the octahedron [Meyer10].
#ifndef SUN_SCENE_SHAPE_H
#define SUN_SCENE_SHAPE_H
#include "scene/triangle.h"

SUN_NAMESPACE_BEGIN

// The direction (x, y, z), of any length but 0, as a point of the square from -1 to 1: projected onto |x| + |y| + |z| = 1, the lower half folded out.
SUN_INLINE void encode_octahedron(float x, float y, float z, float *u, float *v) {
  const float inverse = 1.0f / (fabs(x) + fabs(y) + fabs(z));
  const float a = x * inverse, b = z * inverse;
  *u = y < 0.0f ? copysign(1.0f - fabs(b), a) : a;
  *v = y < 0.0f ? copysign(1.0f - fabs(a), b) : b;
}

// The distances at which the ray meets a sphere, the nearer first: false where it passes by. Neither root cancels, and the discriminant is found from
// the point of the ray that is nearest to the centre, so spheres far away keep their outline [Haines19].
SUN_INLINE int meet_sphere(const float *origin, const float *direction, float *near, float *far) {
  const float a = direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2];
  const float b = -(origin[0] * direction[0] + origin[1] * direction[1] + origin[2] * direction[2]);
  const float middle = b / a;
  const float x = fma(middle, direction[0], origin[0]), y = fma(middle, direction[1], origin[1]), z = fma(middle, direction[2], origin[2]);
  const float discriminant = 1.0f - (x * x + y * y + z * z);
  if (!(discriminant >= 0.0f)) return 0;
  const float q = b + copysign(sqrt(discriminant * a), b);
  const float c = origin[0] * origin[0] + origin[1] * origin[1] + origin[2] * origin[2] - 1.0f;
  const float one = q / a, other = q != 0.0f ? c / q : one;
  *near = SUN_LESSER(one, other);
  *far = SUN_GREATER(one, other);
  return 1;
}

// Takes the nearest hit of a shape that counts; true if there is one.
SUN_INLINE int search_shape(const TraceScene *scene, uint number, const Ray *ray, const PreparedRay *world, Search *search) {
  const SUN_GLOBAL Instance *instance = &scene->instances[number];
  const uint flags = instance->flags;
  if (search->want == SUN_WANT_OPAQUE && (flags & SUN_INSTANCE_PASSABLE)) return 0;
  if (search->want == SUN_WANT_PASSABLE && !(flags & SUN_INSTANCE_PASSABLE)) return 0;
  Place place = place_in_world(number, search);
  if (!(flags & SUN_INSTANCE_PLANE)) {
    place.world = box_interval(world, instance->lower[0], instance->lower[1], instance->lower[2], instance->upper[0], instance->upper[1], instance->upper[2], 0.0f);
    if (!(place.world.near <= place.world.far)) return 0;
  }
  float linear[9], origin[3], direction[3], ts[2];
  int behind[2], count = 1;
  to_space(scene->motion, instance, ray, linear, origin, direction);
  if (flags & SUN_INSTANCE_SPHERE) {
    if (!meet_sphere(origin, direction, &ts[0], &ts[1])) return 0;
    behind[0] = 0;
    behind[1] = 1;
    count = 2;
  } else {
    ts[0] = -origin[1] / direction[1];  // parallel to it: infinite, or NaN within it
    behind[0] = direction[1] > 0.0f;
    ts[1] = ts[0];
    behind[1] = behind[0];
  }
  const uint primitive = scene->roots[number];
  const uint end_primitive = number < search->best_instance ? SUN_NONE : number == search->best_instance ? search->best_primitive : 0;
  for (int k = 0; k < count; k++) {
    const float met = ts[k];
    if (!(fabs(met) <= SUN_LARGEST) || (behind[k] && (flags & SUN_INSTANCE_SINGLE_SIDED))) continue;
    const float x = fma(met, direction[0], origin[0]), y = fma(met, direction[1], origin[1]), z = fma(met, direction[2], origin[2]);
    int within = 1;
    if (flags & SUN_INSTANCE_DISK) within = x * x + z * z <= 1.0f;
    if (flags & SUN_INSTANCE_QUAD) within = (fabs(x) <= 1.0f) & (fabs(z) <= 1.0f);
    if (flags & SUN_INSTANCE_PLANE) within = (fabs(x) <= SUN_PLANE_REACH) & (fabs(z) <= SUN_PLANE_REACH);
    float t = met < place.world.near ? place.world.near : met;
    t = t > place.world.far ? place.world.far : t;
    within = within & ((t > search->passed_t) | ((t == search->passed_t) & (primitive >= place.first_primitive)));
    within = within & ((t < search->best_t) | ((t == search->best_t) & (primitive < end_primitive)));
    if (!within) continue;
    float u = x, v = z;
    if (flags & SUN_INSTANCE_SPHERE) encode_octahedron(x, y, z, &u, &v);
    take_hit(search, &place, t, u, v, primitive);
    return 1;
  }
  return 0;
}

SUN_NAMESPACE_END
#endif
