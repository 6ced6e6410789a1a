// SPDX-License-Identifier: Apache-2.0
// The one hit test, its order and its ties (docs/decisions/0002-hits.md). The same arithmetic for a single triangle and for a pack of eight:
// tri_float is a float in the binary layout, a float8 in the wide ones.
//
// A hit of triangle p in instance i counts only if, in this order,
//   1. the watertight edge test [Woop13] passes,
//   2. the ray passes the triangle's own box; t is clamped into that interval,
//   3. the ray passes the instance's world box; t is clamped into that as well,
//   4. the side and the kind of the triangle are wanted,
//   5. (t, i, p) lies strictly between what the ray passed and the best hit so far.
// None of it looks at the tree, and t lies within the interval of every box around the triangle, so trees may cull by those and never change a hit.
#ifndef SUN_SCENE_TRIANGLE_H
#define SUN_SCENE_TRIANGLE_H
#include "scene/ray.h"
#include "shared/bvh.h"
#include "shared/options.h"
#include "shared/queues.h"

SUN_NAMESPACE_BEGIN

#if SUN_LAYOUT == SUN_LAYOUT_BINARY
typedef float tri_float;
typedef int tri_int;
typedef uint tri_uint;
typedef LeafTriangle TraceLeaf;
#define TRI_LOAD(leaf, k) ((leaf)->v[k])
#define TRI_LOAD_ID(leaf) ((leaf)->id)
#define TRI_ANY(m) (m)
#else
typedef float8 tri_float;
typedef int8 tri_int;
typedef uint8 tri_uint;
typedef WidePack TraceLeaf;
#define TRI_LOAD(leaf, k) vload8(0, (leaf)->v[k])
#define TRI_LOAD_ID(leaf) vload8(0, (leaf)->id)
// Not any(): PoCL makes a chain of branches of it.
#define TRI_ANY(m) (as_ulong(convert_char8(m)) != 0)
#endif

// What a ray looks for, and the best hit so far.
typedef struct Search {
  uint want;
  float passed_t;
  uint passed_instance, passed_primitive;
  float best_t;
  uint best_instance, best_primitive;  // as keys: 0, 0 while nothing is found, so that t < t_max
  uint found_instance;                 // SUN_NONE while nothing is found
  float u, v;
} Search;

// The instance that is being searched.
typedef struct Place {
  uint instance;
  Interval world;        // of the instance's world box; [0, inf] for identity instances, whose box contains every triangle's
  float from;            // boxes with far < from hold nothing behind what the ray passed
  uint first_primitive;  // at t == passed_t hits count from this number on
} Place;

// Boxes of this instance with near > limit hold nothing that counts: every t there is clamped to at least that much, unless the world box pulls it
// back.
SUN_INLINE float box_limit(const Place *place, const Search *search) { return search->best_t < place->world.far ? search->best_t : SUN_INFINITY; }

typedef struct Pierced {
  tri_float u, v, w;  // scaled barycentrics of corners 0, 1, 2: signed areas in the sheared space
  tri_float az, bz, cz;
} Pierced;

// Twice the signed area a * b - c * d. Where the difference of the rounded products is not 0 its sign is right; where it is 0, the exact remainders
// tell.
#define TRI_AREA(a, b, c, d) ((a) * (b) - (c) * (d))
#define TRI_REMAINDER(a, b, c, d) (fma((a), (b), -((a) * (b))) - fma((c), (d), -((c) * (d))))

SUN_INLINE tri_int same_side(tri_float u, tri_float v, tri_float w) {
  const tri_float low = SUN_LESSER(u, v), high = SUN_GREATER(u, v);
  return ((low >= 0.0f) & (w >= 0.0f)) | ((high <= 0.0f) & (w <= 0.0f));
}

// 1: does the ray's line pass the triangle, on its edges included?
SUN_INLINE tri_int pierce(const SUN_GLOBAL TraceLeaf *leaf, const PreparedRay *ray, Pierced *p) {
  const int kx = ray->axis[0], ky = ray->axis[1], kz = ray->axis[2];
  const tri_float ox = (tri_float)(ray->origin[0]), oy = (tri_float)(ray->origin[1]), oz = (tri_float)(ray->origin[2]);
  const tri_float sx = (tri_float)(-ray->shear[0]), sy = (tri_float)(-ray->shear[1]);
  const tri_float az = TRI_LOAD(leaf, kz) - oz, bz = TRI_LOAD(leaf, 3 + kz) - oz, cz = TRI_LOAD(leaf, 6 + kz) - oz;
  const tri_float ax = fma(sx, az, TRI_LOAD(leaf, kx) - ox), ay = fma(sy, az, TRI_LOAD(leaf, ky) - oy);
  const tri_float bx = fma(sx, bz, TRI_LOAD(leaf, 3 + kx) - ox), by = fma(sy, bz, TRI_LOAD(leaf, 3 + ky) - oy);
  const tri_float cx = fma(sx, cz, TRI_LOAD(leaf, 6 + kx) - ox), cy = fma(sy, cz, TRI_LOAD(leaf, 6 + ky) - oy);
  tri_float u = TRI_AREA(cx, by, cy, bx), v = TRI_AREA(ax, cy, ay, cx), w = TRI_AREA(bx, ay, by, ax);
  tri_int pierced = same_side(u, v, w);
  if (TRI_ANY(pierced)) {  // zeros pass as either sign: only those that are through need the exact one
    const tri_int zero = pierced & ((u == 0.0f) | (v == 0.0f) | (w == 0.0f));
    if (TRI_ANY(zero)) {
      u = u == 0.0f ? TRI_REMAINDER(cx, by, cy, bx) : u;
      v = v == 0.0f ? TRI_REMAINDER(ax, cy, ay, cx) : v;
      w = w == 0.0f ? TRI_REMAINDER(bx, ay, by, ax) : w;
      pierced = pierced & same_side(u, v, w);
    }
  }
  p->u = u;
  p->v = v;
  p->w = w;
  p->az = az;
  p->bz = bz;
  p->cz = cz;
  return pierced;
}

// One axis of 2: narrows [enter, leave] to the slab of the triangle's own box.
SUN_INLINE void narrow_to_box(const SUN_GLOBAL TraceLeaf *leaf, const PreparedRay *ray, int axis, tri_float *enter, tri_float *leave) {
  const tri_float a = TRI_LOAD(leaf, axis), b = TRI_LOAD(leaf, 3 + axis), c = TRI_LOAD(leaf, 6 + axis);
  const tri_float ab_lower = SUN_LESSER(a, b), ab_upper = SUN_GREATER(a, b);
  const tri_float lower = SUN_LESSER(ab_lower, c), upper = SUN_GREATER(ab_upper, c);
  const tri_float reciprocal = (tri_float)(ray->reciprocal[axis]);
  const tri_float near = fma(ray->negative[axis] ? upper : lower, reciprocal, (tri_float)(ray->near_offset[axis]));
  const tri_float far = fma(ray->negative[axis] ? lower : upper, reciprocal, (tri_float)(ray->far_offset[axis]));
  *enter = near > *enter ? near : *enter;
  *leave = far < *leave ? far : *leave;
}

// 2 to 5, for lanes that pierce() let through. t, u and v (of corners 1 and 2) mean something where the result is true.
SUN_INLINE tri_int counts(const SUN_GLOBAL TraceLeaf *leaf, const PreparedRay *ray, const Place *place, const Search *search, const Pierced *p,
                          tri_int pierced, tri_float *t_hit, tri_float *u_hit, tri_float *v_hit) {
  const tri_float det = p->u + p->v + p->w;
  const tri_float inverse = 1.0f / det;
  const tri_float u = p->v * inverse, v = p->w * inverse;
  tri_float t = fma(p->u * inverse, p->az, fma(u, p->bz, v * p->cz)) * ray->shear[2];
  tri_int ok = pierced & (det != 0.0f) & (fabs(t) <= SUN_LARGEST);  // NaN fails
  tri_float enter = (tri_float)(0.0f), leave = (tri_float)(SUN_INFINITY);
  narrow_to_box(leaf, ray, 0, &enter, &leave);
  narrow_to_box(leaf, ray, 1, &enter, &leave);
  narrow_to_box(leaf, ray, 2, &enter, &leave);
  ok = ok & (enter <= leave);
  t = t < enter ? enter : t;
  t = t > leave ? leave : t;
  t = t < place->world.near ? (tri_float)(place->world.near) : t;
  t = t > place->world.far ? (tri_float)(place->world.far) : t;

  const tri_uint id = TRI_LOAD_ID(leaf);
  const tri_uint primitive = id & SUN_ID_PRIMITIVE;
  // Seen from behind: clockwise in the mesh's own space, so a mirrored instance's front stays its front.
  ok = ok & !(((id & SUN_ID_SINGLE_SIDED) != 0) & (det < 0.0f));
  if (search->want == SUN_WANT_OPAQUE) ok = ok & ((id & SUN_ID_PASSABLE) == 0);
  if (search->want == SUN_WANT_PASSABLE) ok = ok & ((id & SUN_ID_PASSABLE) != 0);

  const uint end_primitive = place->instance < search->best_instance    ? SUN_NONE
                             : place->instance == search->best_instance ? search->best_primitive
                                                                        : 0;
  ok = ok & ((t > search->passed_t) | ((t == search->passed_t) & (primitive >= place->first_primitive)));
  ok = ok & ((t < search->best_t) | ((t == search->best_t) & (primitive < end_primitive)));
  *t_hit = t;
  *u_hit = u;
  *v_hit = v;
  return ok;
}

// Takes a hit that counts as the best so far.
SUN_INLINE void take_hit(Search *search, const Place *place, float t, float u, float v, uint primitive) {
  search->best_t = t;
  search->best_instance = place->instance;
  search->best_primitive = primitive;
  search->found_instance = place->instance;
  search->u = u;
  search->v = v;
}

SUN_NAMESPACE_END
#endif
