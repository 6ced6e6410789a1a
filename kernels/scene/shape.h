// SPDX-License-Identifier: Apache-2.0
// The hit test of analytic shapes (shared/geometry.h says what they are), in the shape's own space, and by the rules of triangle.h: it lies ahead, before the
// ray's end; the ray passes the instance's world box, and t is clamped into that; (t, instance, primitive) lies strictly between what the ray passed and the best hit so far. A shape
// has one primitive number, so where a ray meets a sphere twice the nearer that counts is taken. Planes have no box.
// A hit's u and v name the point: x and z of what lies in y = 0; of a sphere the direction from its centre, by the octahedron [Meyer10].
// LANES rays meet a shape at once; a tree's traversal, which has one, fills the lanes with it.
#ifndef SUN_SCENE_SHAPE_H
#define SUN_SCENE_SHAPE_H
#include "scene/triangle.h"

SUN_NAMESPACE_BEGIN

// The direction (x, y, z), of any length but 0, as a point of the square from -1 to 1: projected onto |x| + |y| + |z| = 1, the lower half folded out.
SUN_INLINE vec2 encode_octahedron(vec3 d) {
  const real inverse = 1.0f / (fabs(d.x) + fabs(d.y) + fabs(d.z));
  const real a = d.x * inverse, b = d.z * inverse;
  const mask lower = d.y < 0.0f;
  return make_vec2(lower ? copysign(1.0f - fabs(b), a) : a, lower ? copysign(1.0f - fabs(a), b) : b);
}

// The distances at which rays that are on meet a sphere, the nearer first: false where they pass by. Neither root cancels, and the discriminant is found from
// the point of the ray that is nearest to the centre, so spheres far away keep their outline [Haines19].
SUN_INLINE mask meet_sphere(vec3 origin, vec3 direction, mask on, real *near, real *far) {
  *near = *far = (real)(0.0f);
  const real a = dot3(direction, direction), b = -dot3(origin, direction), c = dot3(origin, origin) - 1.0f;
  // From outside and away: both are behind. By more than rounding can be wrong about (2^-20 of b^2), the line passes by: mostly that is all.
  const mask may = on & ((b > 0.0f) | (c < 0.0f)) & (b * b - a * c >= -9.53674316e-7f * (b * b));
  if (!ANY(may)) return may;
  const real inverse = 1.0f / a, middle = b * inverse;
  const real x = fma(middle, direction.x, origin.x), y = fma(middle, direction.y, origin.y), z = fma(middle, direction.z, origin.z);
  const real discriminant = 1.0f - (x * x + y * y + z * z);
  const mask meets = may & (discriminant >= 0.0f);
  if (!ANY(meets)) return meets;
  const real q = b + copysign(sqrt((meets ? discriminant : (real)(0.0f)) * a), b);
  const real one = q * inverse, other = q != 0.0f ? c / q : one;
  *near = SUN_LESSER(one, other);
  *far = SUN_GREATER(one, other);
  return meets;
}

// LANES rays that look for shapes.
typedef struct ShapeRays {
  vec3 origin, direction;
  real t_max;
  const SUN_GLOBAL float *lower, *upper;  // bounds of the world
  int ready;                              // are the slabs? Else they are made where they are asked
  LaneSlabs slabs;
} ShapeRays;

// What counts: keys (t, instance, primitive) strictly between the one that was passed and the best so far, the instance being known.
typedef struct ShapeSearch {
  real passed_t, best_t;
  uint_n first_primitive;  // at t == passed_t hits count from this number on,
  uint_n end_primitive;    // and at t == best_t before that one
} ShapeSearch;

typedef struct ShapeHit {
  mask counts;
  real t;
  vec3 place;  // in the shape's space
} ShapeHit;

// A distance at which the rays' lines meet the shape and are within its box: does it count?
SUN_INLINE ShapeHit count_met(uint primitive, vec3 place, const ShapeSearch *search, real t, mask on) {
  ShapeHit hit;
  hit.place = place;
  hit.t = t;
  mask behind = hit.t > search->passed_t;
  if (SUN_PASSABLE) behind = behind | ((hit.t == search->passed_t) & ((uint_n)(primitive) >= search->first_primitive));
  const mask before = (hit.t < search->best_t) | ((hit.t == search->best_t) & ((uint_n)(primitive) < search->end_primitive));
  hit.counts = on & behind & before;
  return hit;
}

SUN_INLINE vec3 place_along(vec3 origin, vec3 direction, real t) {
  return make_vec3(fma(t, direction.x, origin.x), fma(t, direction.y, origin.y), fma(t, direction.z, origin.z));
}

// Is that surely a point of the box, though its coordinate was rounded? The slabs of such a box hold the point's distance, as they make up for more than that.
SUN_INLINE mask surely_between(float lower, float upper, real place) {
  const float margin = 2.38418579e-7f * (fabs(lower) + fabs(upper));  // 2^-22; shape boxes are wider by 2^-19
  return (place > lower + margin) & (place < upper - margin);
}

// Where the rays are inside the shape's box, by its slabs, and whether they are.
SUN_RARE mask pass_slabs(const SUN_GLOBAL Instance *instance, const ShapeRays *rays, LaneInterval *inside) {
  const LaneSlabs slabs = rays->ready ? rays->slabs : slabs_of_lanes(rays->origin, rays->direction, rays->lower, rays->upper);
  *inside = box_lanes(&slabs, instance->lower[0], instance->lower[1], instance->lower[2], instance->upper[0], instance->upper[1], instance->upper[2], (real)(0.0f));
  return slabs.usable & (inside->near <= inside->far);
}

// The rays of `on` that meet the shape, at `t`, within its box, into whose interval t is clamped. Mostly the place where they do settles it, without any slab.
SUN_INLINE mask enter_box(const SUN_GLOBAL Instance *instance, const ShapeRays *rays, mask on, real *t) {
  const vec3 place = place_along(rays->origin, rays->direction, *t);
  const mask sure = surely_between(instance->lower[0], instance->upper[0], place.x) & surely_between(instance->lower[1], instance->upper[1], place.y) &
                    surely_between(instance->lower[2], instance->upper[2], place.z);
  if (ANY(on & !sure)) {
    const ShapeRays copy = *rays;  // so that what is asked mostly stays in registers
    LaneInterval inside;
    on = on & pass_slabs(instance, &copy, &inside);
    *t = *t < inside.near ? inside.near : *t;
    *t = *t > inside.far ? inside.far : *t;
  }
  return on;
}

// Rays in the space of a shape that is still.
SUN_INLINE void rays_in_shape(const SUN_GLOBAL Instance *instance, const ShapeRays *rays, vec3 *origin, vec3 *direction) {
  const vec3 from = rays->origin, along = rays->direction;
  if (instance->flags & SUN_INSTANCE_ALIGNED) {  // the same numbers: what the zeros of the matrix add is left out
    const SUN_GLOBAL float *m = instance->to_object;
    *origin = make_vec3(fma((real)(m[0]), from.x, (real)(m[3])), fma((real)(m[5]), from.y, (real)(m[7])), fma((real)(m[10]), from.z, (real)(m[11])));
    *direction = make_vec3(m[0] * along.x, m[5] * along.y, m[10] * along.z);
  } else {
    *origin = make_vec3(origin_in_instance(instance, 0, from), origin_in_instance(instance, 1, from), origin_in_instance(instance, 2, from));
    *direction = make_vec3(direction_in_instance(instance, 0, along), direction_in_instance(instance, 1, along), direction_in_instance(instance, 2, along));
  }
}

// The nearest hit of a shape that counts, in the lanes of `on`. origin, direction: the rays in its space. Rays of light subpaths meet both sides (SUN_WANT_BOTH_SIDES).
SUN_INLINE ShapeHit meet_shape(const SUN_GLOBAL Instance *instance, uint primitive, vec3 origin, vec3 direction, const ShapeRays *rays, const ShapeSearch *search, mask on, int both_sides) {
  const uint flags = instance->flags;
  const int single_sided = !both_sides && (flags & SUN_INSTANCE_SINGLE_SIDED) != 0;
  ShapeHit hit;
  hit.t = (real)(0.0f);
  hit.place = splat3((real)(0.0f));
  if (flags & SUN_INSTANCE_SPHERE) {
    real near, far;
    on = meet_sphere(origin, direction, on, &near, &far);
    mask first = on & (near > 0.0f) & (near < rays->t_max), second = on & (far > 0.0f) & (far < rays->t_max);  // NaN fails
    if (single_sided) second = on & !on;  // the farther one is met from within
    hit.counts = first | second;
    if (!ANY(hit.counts)) return hit;
    real t = near;
    first = enter_box(instance, rays, first, &t);
    hit = count_met(primitive, place_along(origin, direction, near), search, t, first);
    second = second & !hit.counts;
    if (!ANY(second)) return hit;
    t = far;
    second = enter_box(instance, rays, second, &t);
    const ShapeHit later = count_met(primitive, place_along(origin, direction, far), search, t, second);
    hit.t = later.counts ? later.t : hit.t;
    hit.place = select3(later.counts, later.place, hit.place);
    hit.counts = hit.counts | later.counts;
    return hit;
  }
  hit.counts = on & ((origin.y < 0.0f) != (direction.y < 0.0f));  // ahead
  if (!ANY(hit.counts)) return hit;
  const real met = -origin.y / direction.y;  // parallel to it: infinite, or NaN within it
  const vec3 place = place_along(origin, direction, met);
  hit.counts = hit.counts & (met > 0.0f) & (met < rays->t_max);
  const real x = fabs(place.x), z = fabs(place.z);
  if (flags & SUN_INSTANCE_DISK) {
    hit.counts = hit.counts & (x * x + z * z <= 1.0f);
  } else {
    const real reach = (real)(flags & SUN_INSTANCE_QUAD ? 1.0f : SUN_PLANE_REACH);
    hit.counts = hit.counts & (x <= reach) & (z <= reach);
  }
  if (single_sided) hit.counts = hit.counts & !(direction.y > 0.0f);
  if (!ANY(hit.counts)) return hit;
  real t = met;
  if (!(flags & SUN_INSTANCE_PLANE)) hit.counts = enter_box(instance, rays, hit.counts, &t);
  return count_met(primitive, place, search, t, hit.counts);
}

// Shapes that opaque rays, or those for what lets light pass, do not look at.
SUN_INLINE int shape_unwanted(uint flags, uint want) {
  return (want == SUN_WANT_OPAQUE && (flags & SUN_INSTANCE_PASSABLE)) || (want == SUN_WANT_PASSABLE && !(flags & SUN_INSTANCE_PASSABLE));
}

// u and v of a hit.
SUN_INLINE vec2 place_code(mask sphere, vec3 place) {
  vec2 uv = make_vec2(place.x, place.z);
  if (ANY(sphere)) {
    const vec2 folded = encode_octahedron(place);
    uv.x = sphere ? folded.x : uv.x;
    uv.y = sphere ? folded.y : uv.y;
  }
  return uv;
}

// One ray: takes the nearest hit of a shape that counts; true if there is one.
SUN_INLINE int search_shape(const TraceScene *scene, uint number, const Ray *ray, const PreparedRay *world, Search *search) {
  const SUN_GLOBAL Instance *instance = &scene->instances[number];
  const uint flags = instance->flags;
  if (shape_unwanted(flags, search->want)) return 0;
  const Place place = place_in_world(number, search);
  const uint primitive = scene->roots[number];
  ShapeRays rays;
  rays.origin = make_vec3((real)(ray->origin[0]), (real)(ray->origin[1]), (real)(ray->origin[2]));
  rays.direction = make_vec3((real)(ray->direction[0]), (real)(ray->direction[1]), (real)(ray->direction[2]));
  rays.t_max = (real)(ray->t_max);
  rays.lower = rays.upper = 0;
  rays.ready = 1;
  rays.slabs = slabs_of_ray(world);
  ShapeSearch wanted;
  wanted.passed_t = (real)(search->passed_t);
  wanted.best_t = (real)(search->best_t);
  wanted.first_primitive = (uint_n)(place.first_primitive);
  wanted.end_primitive = (uint_n)(number < search->best_instance ? SUN_NONE : number == search->best_instance ? search->best_primitive : 0);
  const mask on = wanted.passed_t >= 0.0f;  // all: it is never negative
  vec3 origin, direction;
  if (SUN_MOTION && (flags & SUN_INSTANCE_MOVING)) {
    float linear[9], from[3], along[3];
    to_moving_instance(scene->motion, flags, ray, linear, from, along);
    origin = make_vec3((real)(from[0]), (real)(from[1]), (real)(from[2]));
    direction = make_vec3((real)(along[0]), (real)(along[1]), (real)(along[2]));
  } else {
    rays_in_shape(instance, &rays, &origin, &direction);
  }
  const ShapeHit hit = meet_shape(instance, primitive, origin, direction, &rays, &wanted, on, SUN_BIDIRECTIONAL && search->want == SUN_WANT_BOTH_SIDES);
  if (!FIRST_LANE(hit.counts)) return 0;
  const mask sphere = (uint_n)(flags & SUN_INSTANCE_SPHERE) != (uint_n)(0);
  const vec2 uv = place_code(sphere, hit.place);
  take_hit(search, &place, FIRST_LANE(hit.t), FIRST_LANE(uv.x), FIRST_LANE(uv.y), primitive);
  return 1;
}

SUN_NAMESPACE_END
#endif
