// SPDX-License-Identifier: Apache-2.0
// A ray, and the ray made ready for one space (the world, or an instance's). Plain floats: one ray per work-item, whatever LANES is; beside it LANES of
// them at once, by the same arithmetic.
//
// Every box of every layout is tested by one function, the slabs of slab_of: the ray meets the plane at bound b at
//   t(b) = fma(b, reciprocal, offset).
// That is the rounding of a monotone function, so where one box contains another, so do their intervals, exactly. It is also conservative
// [Woop13, Ize13]: the offsets move near planes nearer and far planes farther by more than the edge test of triangle.h and the slabs themselves can
// err.
#ifndef SUN_SCENE_RAY_H
#define SUN_SCENE_RAY_H
#include "math/vector.h"
#include "shared/geometry.h"
#include "shared/motion.h"
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

// What any_hit and closest_hit count.
#define SUN_WANT_ALL 0u
#define SUN_WANT_OPAQUE 1u    // triangles without SUN_ID_PASSABLE
#define SUN_WANT_PASSABLE 2u  // triangles with it
#define SUN_WANT_BOTH_SIDES 3u  // all, those of one side seen from behind too: what light meets, while eyes look through

// Hits count where t < t_max and (t, instance, primitive) > (passed_t, passed_instance, passed_primitive), compared in that order.
// A new ray has passed_t = 0 and both numbers SUN_NONE, so t > 0; a ray that goes on behind a hit has that hit's, and needs no offset.
typedef struct Ray {
  float origin[3], direction[3];  // the direction need not be of unit length
  float t_max;
  float passed_t;
  uint passed_instance, passed_primitive;
  float time;  // within the shutter's: 0 to below 1
} Ray;

#define SUN_INFINITY as_float(0x7f800000u)
#define SUN_LARGEST 3.40282347e+38f
// Not fmin and fmax: their rules for NaN cost a fifth of a traversal. Arguments are named values, not expressions.
#define SUN_LESSER(a, b) ((a) < (b) ? (a) : (b))
#define SUN_GREATER(a, b) ((a) > (b) ? (a) : (b))

typedef struct PreparedRay {
  float reciprocal[3], near_offset[3], far_offset[3];  // of the slabs
  int negative[3];                                     // 1 where the direction points to smaller values: the near plane is then the upper one
  int axis[3];                                         // of the edge test [Woop13]: the third is the direction's largest; they keep the winding
  float origin[3];                                     // along those axes
  float shear[3];
} PreparedRay;

// An interval of t; empty where near > far.
typedef struct Interval {
  float near, far;
} Interval;

SUN_INLINE float pick(float x, float y, float z, int axis) { return axis == 0 ? x : axis == 1 ? y : z; }

// One axis of the slabs: the function above.
typedef struct Slab {
  real reciprocal, near_offset, far_offset;
} Slab;

// Directions parallel to a slab get a large finite reciprocal: no 0 * infinity in it. `largest`: the size of the direction's largest component.
SUN_INLINE real least_direction(real largest) {
  const real tiny = largest * 8.67361738e-19f, least = (real)(7.88860905e-31f);  // 2^-60, 2^-100
  return SUN_GREATER(tiny, least);
}

// Along one axis: the ray, how far any vertex of this space lies from its origin, and the same along the direction's largest component.
SUN_INLINE Slab slab_of(real origin, real direction, real least, real reach, real reach_along) {
  const real r = 1.0f / (fabs(direction) < least ? copysign(least, direction) : direction);
  // With u = 2^-24, a sheared vertex errs by at most u (2 |vertex - origin| + 5 |along z|), a slab by u (2 |bound - origin| + 2 |origin|).
  const real error = fma((real)(9.53674316e-07f), reach + reach_along, 4.76837158e-07f * fabs(origin)) * fabs(r);  // 16u, 8u
  const real most = (real)(1e38f), margin = SUN_LESSER(error, most);
  const real product = -(origin * r);
  const real offset = product < -1e38f ? -most : SUN_LESSER(product, most);
  Slab slab;
  slab.reciprocal = r;
  slab.near_offset = offset - margin;
  slab.far_offset = offset + margin;
  return slab;
}

// `reach` bounds, by axis, how far a vertex of this space lies from the origin: it scales the rounding errors that the slabs make up for.
// False where the ray has no direction or is not finite: it hits nothing.
SUN_INLINE int prepare_ray(PreparedRay *ray, const float *origin, const float *direction, const float *reach) {
  const float ax = fabs(direction[0]), ay = fabs(direction[1]), az = fabs(direction[2]);
  const int kz = ax > ay ? (ax > az ? 0 : 2) : (ay > az ? 1 : 2);
  int kx = kz == 2 ? 0 : kz + 1, ky = kz == 0 ? 2 : kz - 1;
  const float along = pick(direction[0], direction[1], direction[2], kz);
  const float largest = fabs(along);
  int usable = largest > 0.0f;
  const real least = least_direction((real)(largest));
  const float reach_z = pick(reach[0], reach[1], reach[2], kz);
  SUN_UNROLL
  for (int axis = 0; axis < 3; axis++) {
    const float o = origin[axis], d = direction[axis];
    usable = usable & (fabs(o) <= SUN_LARGEST) & (fabs(d) <= SUN_LARGEST);
    const Slab slab = slab_of((real)(o), (real)(d), least, (real)(reach[axis]), (real)(reach_z));
    ray->reciprocal[axis] = FIRST_LANE(slab.reciprocal);
    ray->near_offset[axis] = FIRST_LANE(slab.near_offset);
    ray->far_offset[axis] = FIRST_LANE(slab.far_offset);
    ray->negative[axis] = ray->reciprocal[axis] < 0.0f;
  }
  if (along < 0.0f) {  // keeps the winding, so that the sign of the determinant tells front from back
    const int k = kx;
    kx = ky;
    ky = k;
  }
  ray->axis[0] = kx;
  ray->axis[1] = ky;
  ray->axis[2] = kz;
  ray->origin[0] = pick(origin[0], origin[1], origin[2], kx);
  ray->origin[1] = pick(origin[0], origin[1], origin[2], ky);
  ray->origin[2] = pick(origin[0], origin[1], origin[2], kz);
  const float inverse = 1.0f / along;
  ray->shear[0] = pick(direction[0], direction[1], direction[2], kx) * inverse;
  ray->shear[1] = pick(direction[0], direction[1], direction[2], ky) * inverse;
  ray->shear[2] = inverse;
  return usable;
}

// Slabs of LANES rays.
typedef struct LaneSlabs {
  Slab x, y, z;
  mask negative_x, negative_y, negative_z;  // the direction points to smaller values: the near plane is then the upper one
  mask usable;                              // else the ray has no direction or is not finite: it hits nothing
} LaneSlabs;

// Intervals of t of LANES rays.
typedef struct LaneInterval {
  real near, far;
} LaneInterval;

SUN_INLINE real near_plane(const Slab *slab, mask negative, float lower, float upper) {
  return fma(negative ? (real)(upper) : (real)(lower), slab->reciprocal, slab->near_offset);
}
SUN_INLINE real far_plane(const Slab *slab, mask negative, float lower, float upper) {
  return fma(negative ? (real)(lower) : (real)(upper), slab->reciprocal, slab->far_offset);
}

// Where the rays are inside a box, from `from` on (not negative; never gives -0).
SUN_INLINE LaneInterval box_lanes(const LaneSlabs *slabs, float lx, float ly, float lz, float ux, float uy, float uz, real from) {
  const real nx = near_plane(&slabs->x, slabs->negative_x, lx, ux), fx = far_plane(&slabs->x, slabs->negative_x, lx, ux);
  const real ny = near_plane(&slabs->y, slabs->negative_y, ly, uy), fy = far_plane(&slabs->y, slabs->negative_y, ly, uy);
  const real nz = near_plane(&slabs->z, slabs->negative_z, lz, uz), fz = far_plane(&slabs->z, slabs->negative_z, lz, uz);
  const real n = SUN_GREATER(nx, ny), m = SUN_GREATER(n, nz), f = SUN_LESSER(fx, fy);
  LaneInterval interval;
  interval.near = SUN_GREATER(m, from);
  interval.far = SUN_LESSER(f, fz);
  return interval;
}

SUN_INLINE void note_signs(LaneSlabs *slabs) {
  slabs->negative_x = slabs->x.reciprocal < 0.0f;
  slabs->negative_y = slabs->y.reciprocal < 0.0f;
  slabs->negative_z = slabs->z.reciprocal < 0.0f;
}

// Those of one ray in all lanes.
SUN_INLINE LaneSlabs slabs_of_ray(const PreparedRay *ray) {
  LaneSlabs slabs;
  Slab slab[3];
  SUN_UNROLL
  for (int axis = 0; axis < 3; axis++) {
    slab[axis].reciprocal = (real)(ray->reciprocal[axis]);
    slab[axis].near_offset = (real)(ray->near_offset[axis]);
    slab[axis].far_offset = (real)(ray->far_offset[axis]);
  }
  slabs.x = slab[0];
  slabs.y = slab[1];
  slabs.z = slab[2];
  note_signs(&slabs);
  slabs.usable = slabs.negative_x | !slabs.negative_x;
  return slabs;
}

// Where one ray is inside a box.
SUN_INLINE Interval box_interval(const PreparedRay *ray, float lx, float ly, float lz, float ux, float uy, float uz, float from) {
  const LaneSlabs slabs = slabs_of_ray(ray);
  const LaneInterval inside = box_lanes(&slabs, lx, ly, lz, ux, uy, uz, (real)(from));
  Interval interval;
  interval.near = FIRST_LANE(inside.near);
  interval.far = FIRST_LANE(inside.far);
  return interval;
}

// Distance from the origin to the farther of two bounds.
SUN_INLINE real farther(float lower, float upper, real origin) {
  const real a = fabs(lower - origin), b = fabs(upper - origin);
  return SUN_GREATER(a, b);
}

// LANES rays made ready for a space of these bounds.
SUN_INLINE LaneSlabs slabs_of_lanes(vec3 origin, vec3 direction, const SUN_GLOBAL float *lower, const SUN_GLOBAL float *upper) {
  const real ax = fabs(direction.x), ay = fabs(direction.y), az = fabs(direction.z);
  const real reach_x = farther(lower[0], upper[0], origin.x), reach_y = farther(lower[1], upper[1], origin.y), reach_z = farther(lower[2], upper[2], origin.z);
  const mask x_over_y = ax > ay;
  const real of_xy = x_over_y ? ax : ay, reach_xy = x_over_y ? reach_x : reach_y;
  const mask xy_over_z = of_xy > az;
  const real largest = xy_over_z ? of_xy : az, reach_along = xy_over_z ? reach_xy : reach_z, least = least_direction(largest);
  LaneSlabs slabs;
  slabs.x = slab_of(origin.x, direction.x, least, reach_x, reach_along);
  slabs.y = slab_of(origin.y, direction.y, least, reach_y, reach_along);
  slabs.z = slab_of(origin.z, direction.z, least, reach_z, reach_along);
  note_signs(&slabs);
  slabs.usable = (largest > 0.0f) & (ax <= SUN_LARGEST) & (ay <= SUN_LARGEST) & (az <= SUN_LARGEST) & (fabs(origin.x) <= SUN_LARGEST) &
                 (fabs(origin.y) <= SUN_LARGEST) & (fabs(origin.z) <= SUN_LARGEST);
  return slabs;
}

// Rays in an instance's space: t stays the same, so the direction is not normalised.
SUN_INLINE real origin_in_instance(const SUN_GLOBAL Instance *instance, int row, vec3 origin) {
  const SUN_GLOBAL float *m = instance->to_object + 4 * row;
  return fma((real)(m[0]), origin.x, fma((real)(m[1]), origin.y, fma((real)(m[2]), origin.z, (real)(m[3]))));
}
SUN_INLINE real direction_in_instance(const SUN_GLOBAL Instance *instance, int row, vec3 direction) {
  const SUN_GLOBAL float *m = instance->to_object + 4 * row;
  return fma((real)(m[0]), direction.x, fma((real)(m[1]), direction.y, m[2] * direction.z));
}
SUN_INLINE void to_instance(const SUN_GLOBAL Instance *instance, const Ray *ray, float *origin, float *direction) {
  const vec3 from = make_vec3((real)(ray->origin[0]), (real)(ray->origin[1]), (real)(ray->origin[2]));
  const vec3 along = make_vec3((real)(ray->direction[0]), (real)(ray->direction[1]), (real)(ray->direction[2]));
  SUN_UNROLL
  for (int row = 0; row < 3; row++) {
    origin[row] = FIRST_LANE(origin_in_instance(instance, row, from));
    direction[row] = FIRST_LANE(direction_in_instance(instance, row, along));
  }
}

// The place of a ray's time among the keys. `steps` is a power of two and times have 24 bits, so both are exact.
typedef struct RayMoment {
  uint step;
  float blend;  // from that key to the next, below 1
} RayMoment;

SUN_INLINE RayMoment ray_moment(const SUN_GLOBAL Motion *motion, float time) {
  const float scaled = time * (float)motion->steps;
  RayMoment moment;
  moment.step = (uint)scaled;
  moment.blend = scaled - (float)moment.step;
  return moment;
}

// Between two keys. One rounding, of what lies between them, so the result does: boxes around both keys hold it, as floats.
SUN_INLINE float between_keys(float a, float b, float blend) { return fma(blend, b - a, a); }

// a * b - c * d, to the last bits though it cancels [Kahan04].
SUN_INLINE float difference_of_products(float a, float b, float c, float d) {
  const float product = c * d, error = fma(-c, d, product);
  return fma(a, b, -product) + error;
}

// A ray in the space of an instance that moves: the matrix of the ray's time is made from the keys, and inverted here. About the place of its origin, so that
// distance from the world's does no harm. Where there is no inverse nothing is finite, and nothing is hit. linear: 3x3, row major.
SUN_INLINE void to_moving_instance(const SUN_GLOBAL Motion *motion, uint flags, const Ray *ray, float *linear, float *origin, float *direction) {
  const RayMoment moment = ray_moment(motion, ray->time);
  const SUN_GLOBAL InstanceKey *key = (const SUN_GLOBAL InstanceKey *)(motion + 1) + (size_t)(flags >> SUN_INSTANCE_MOTION_SHIFT) * (motion->steps + 1u) + moment.step;
  float m[12];
  SUN_UNROLL
  for (int k = 0; k < 12; k++) m[k] = between_keys(key[0].to_world[k], key[1].to_world[k], moment.blend);
  SUN_UNROLL
  for (int row = 0; row < 3; row++) {
    const int r1 = row == 2 ? 0 : row + 1, r2 = row == 0 ? 2 : row - 1;
    SUN_UNROLL
    for (int column = 0; column < 3; column++) {
      const int c1 = column == 2 ? 0 : column + 1, c2 = column == 0 ? 2 : column - 1;
      linear[3 * column + row] = difference_of_products(m[4 * r1 + c1], m[4 * r2 + c2], m[4 * r1 + c2], m[4 * r2 + c1]);
    }
  }
  const float determinant = fma(m[0], linear[0], fma(m[1], linear[3], m[2] * linear[6])), scale = 1.0f / determinant;
  const float x = ray->origin[0] - m[3], y = ray->origin[1] - m[7], z = ray->origin[2] - m[11];
  SUN_UNROLL
  for (int row = 0; row < 3; row++) {
    SUN_UNROLL
    for (int column = 0; column < 3; column++) linear[3 * row + column] *= scale;
    const float a = linear[3 * row], b = linear[3 * row + 1], c = linear[3 * row + 2];
    origin[row] = fma(a, x, fma(b, y, c * z));
    direction[row] = fma(a, ray->direction[0], fma(b, ray->direction[1], c * ray->direction[2]));
  }
}

// A ray in an instance's space at the ray's time, and the linear part of what took it there.
SUN_INLINE void to_space(const SUN_GLOBAL Motion *motion, const SUN_GLOBAL Instance *instance, const Ray *ray, float *linear, float *origin, float *direction) {
  if (SUN_MOTION && (instance->flags & SUN_INSTANCE_MOVING)) {
    to_moving_instance(motion, instance->flags, ray, linear, origin, direction);
    return;
  }
  to_instance(instance, ray, origin, direction);
  SUN_UNROLL
  for (int row = 0; row < 3; row++)
    SUN_UNROLL
    for (int column = 0; column < 3; column++) linear[3 * row + column] = instance->to_object[4 * row + column];
}

SUN_NAMESPACE_END
#endif
