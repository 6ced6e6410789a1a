// SPDX-License-Identifier: Apache-2.0
// A ray, and the ray made ready for one space (the world, or an instance's). Plain floats: one ray per work-item, whatever LANES is.
//
// Every box of every layout is tested by one function, the slabs of prepare_ray: the ray meets the plane at bound b at
//   t(b) = fma(b, reciprocal, offset).
// That is the rounding of a monotone function, so where one box contains another, so do their intervals, exactly. It is also conservative
// [Woop13, Ize13]: the offsets move near planes nearer and far planes farther by more than the edge test of triangle.h and the slabs themselves can
// err.
#ifndef SUN_SCENE_RAY_H
#define SUN_SCENE_RAY_H
#include "math/real.h"
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

// `reach` bounds, by axis, how far a vertex of this space lies from the origin: it scales the rounding errors that the slabs make up for.
// False where the ray has no direction or is not finite: it hits nothing.
SUN_INLINE int prepare_ray(PreparedRay *ray, const float *origin, const float *direction, const float *reach) {
  const float ax = fabs(direction[0]), ay = fabs(direction[1]), az = fabs(direction[2]);
  const int kz = ax > ay ? (ax > az ? 0 : 2) : (ay > az ? 1 : 2);
  int kx = kz == 2 ? 0 : kz + 1, ky = kz == 0 ? 2 : kz - 1;
  const float along = pick(direction[0], direction[1], direction[2], kz);
  const float largest = fabs(along);
  int usable = largest > 0.0f;
  // Directions parallel to a slab get a large finite reciprocal: no 0 * infinity below.
  const float tiny = largest * 8.67361738e-19f, least = 7.88860905e-31f;  // 2^-60, 2^-100
  const float floor_direction = SUN_GREATER(tiny, least);
  const float reach_z = pick(reach[0], reach[1], reach[2], kz);
  for (int axis = 0; axis < 3; axis++) {
    const float o = origin[axis], d = direction[axis];
    usable = usable & (fabs(o) <= SUN_LARGEST) & (fabs(d) <= SUN_LARGEST);
    const float r = 1.0f / (fabs(d) < floor_direction ? copysign(floor_direction, d) : d);
    // With u = 2^-24, a sheared vertex errs by at most u (2 |vertex - origin| + 5 |along z|), a slab by u (2 |bound - origin| + 2 |origin|).
    const float error = fma(9.53674316e-07f, reach[axis] + reach_z, 4.76837158e-07f * fabs(o)) * fabs(r);  // 16u, 8u
    const float margin = error < 1e38f ? error : 1e38f;
    const float product = -(o * r);
    const float offset = product < -1e38f ? -1e38f : product < 1e38f ? product : 1e38f;
    ray->reciprocal[axis] = r;
    ray->near_offset[axis] = offset - margin;
    ray->far_offset[axis] = offset + margin;
    ray->negative[axis] = r < 0.0f;
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

SUN_INLINE float near_plane(const PreparedRay *ray, int axis, float lower, float upper) {
  return fma(ray->negative[axis] ? upper : lower, ray->reciprocal[axis], ray->near_offset[axis]);
}
SUN_INLINE float far_plane(const PreparedRay *ray, int axis, float lower, float upper) {
  return fma(ray->negative[axis] ? lower : upper, ray->reciprocal[axis], ray->far_offset[axis]);
}

// Where the ray is inside a box, from `from` on (not negative; never gives -0).
SUN_INLINE Interval box_interval(const PreparedRay *ray, float lx, float ly, float lz, float ux, float uy, float uz, float from) {
  const float nx = near_plane(ray, 0, lx, ux), ny = near_plane(ray, 1, ly, uy), nz = near_plane(ray, 2, lz, uz);
  const float fx = far_plane(ray, 0, lx, ux), fy = far_plane(ray, 1, ly, uy), fz = far_plane(ray, 2, lz, uz);
  const float n = SUN_GREATER(nx, ny), m = SUN_GREATER(n, nz), f = SUN_LESSER(fx, fy);
  Interval interval;
  interval.near = SUN_GREATER(m, from);
  interval.far = SUN_LESSER(f, fz);
  return interval;
}

// Distance from the origin to the farther of two bounds.
SUN_INLINE float farther(float lower, float upper, float origin) {
  const float a = fabs(lower - origin), b = fabs(upper - origin);
  return SUN_GREATER(a, b);
}

// A ray in an instance's space: t stays the same, so the direction is not normalised.
SUN_INLINE void to_instance(const SUN_GLOBAL Instance *instance, const Ray *ray, float *origin, float *direction) {
  for (int row = 0; row < 3; row++) {
    const float a = instance->to_object[4 * row], b = instance->to_object[4 * row + 1], c = instance->to_object[4 * row + 2];
    origin[row] = fma(a, ray->origin[0], fma(b, ray->origin[1], fma(c, ray->origin[2], instance->to_object[4 * row + 3])));
    direction[row] = fma(a, ray->direction[0], fma(b, ray->direction[1], c * ray->direction[2]));
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
  for (int k = 0; k < 12; k++) m[k] = between_keys(key[0].to_world[k], key[1].to_world[k], moment.blend);
  for (int row = 0; row < 3; row++) {
    const int r1 = row == 2 ? 0 : row + 1, r2 = row == 0 ? 2 : row - 1;
    for (int column = 0; column < 3; column++) {
      const int c1 = column == 2 ? 0 : column + 1, c2 = column == 0 ? 2 : column - 1;
      linear[3 * column + row] = difference_of_products(m[4 * r1 + c1], m[4 * r2 + c2], m[4 * r1 + c2], m[4 * r2 + c1]);
    }
  }
  const float determinant = fma(m[0], linear[0], fma(m[1], linear[3], m[2] * linear[6])), scale = 1.0f / determinant;
  const float x = ray->origin[0] - m[3], y = ray->origin[1] - m[7], z = ray->origin[2] - m[11];
  for (int row = 0; row < 3; row++) {
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
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++) linear[3 * row + column] = instance->to_object[4 * row + column];
}

SUN_NAMESPACE_END
#endif
