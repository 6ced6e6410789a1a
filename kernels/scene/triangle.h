// SPDX-License-Identifier: Apache-2.0
// The one hit test, its order and its ties (docs/decisions/0002-hits.md). The same arithmetic for a single triangle and for a pack of eight:
// tri_float is a float in the binary layout, a float8 in the wide ones.
//
// A hit of triangle p in instance i counts only if, in this order,
//   1. the watertight edge test [Woop13] passes,
//   2. the ray passes the triangle's own box; t is clamped into that interval; where the triangle is in pieces, the box of one of them holds t,
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

// A hint that this cache line will be read soon: rays are read in the order of a queue, so the next ones are known, and their records stand anywhere.
// Another core wrote most of them, and the first load of one took a fifth of occlude. For CPUs, as are the wide layouts.
#define SUN_SOON(place) ((void)0)
#define SUN_AHEAD 4u  // entries of the queue
#if !defined(__cplusplus) && SUN_LAYOUT != SUN_LAYOUT_BINARY && defined(__has_builtin)
#if __has_builtin(__builtin_prefetch)
#undef SUN_SOON
#define SUN_SOON(place) __builtin_prefetch(place)
#endif
#endif

SUN_NAMESPACE_BEGIN

#if SUN_LAYOUT == SUN_LAYOUT_BINARY
typedef float tri_float;
typedef int tri_int;
typedef uint tri_uint;
typedef LeafTriangle TraceLeaf;
#define TRI_COUNT 1
#define TRI_LOAD(leaf, k) ((leaf)->v[k])
#define TRI_LOAD_ID(leaf) ((leaf)->id)
#define TRI_CORNER(leaf, k, lane) ((void)(lane), (leaf)->v[k])
#define TRI_ANY(m) (m)
#define TRI_BYTES(m) ((ulong)((m) != 0))
#define TRI_STORE(v, array) ((array)[0] = (v))
#define TRI_RELOAD(array) ((array)[0])
#else
typedef float8 tri_float;
typedef int8 tri_int;
typedef uint8 tri_uint;
typedef WidePack TraceLeaf;
#define TRI_COUNT SUN_PACK
#define TRI_LOAD(leaf, k) vload8(0, (leaf)->v[k])
#define TRI_LOAD_ID(leaf) vload8(0, (leaf)->id)
#define TRI_CORNER(leaf, k, lane) ((leaf)->v[k][lane])
#define TRI_STORE(v, array) vstore8((v), 0, (array))
#define TRI_RELOAD(array) vload8(0, (array))
// Not any(): PoCL makes a chain of branches of it.
#define TRI_ANY(m) (as_ulong(convert_char8(m)) != 0)
#define TRI_BYTES(m) bytes_of8(m)
#endif

// Lanes of a comparison as bytes of 64-bit words, eight lanes a word: a portable road from a vector mask to its set lanes.
#define LANE_BYTES 0x0101010101010101ul
#ifdef __cplusplus
SUN_INLINE int lowest_byte(ulong bytes) { return __builtin_ctzl(bytes) >> 3; }
#else
SUN_INLINE int lowest_byte(ulong bytes) { return (int)((63ul - clz(bytes & (~bytes + 1ul))) >> 3); }
SUN_INLINE ulong bytes_of8(int8 m) { return as_ulong(convert_char8(m)) & LANE_BYTES; }
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

// The distance at which a ray passes a triangle, from areas with their remainders, clamped into the triangle's own box. `lost` where even those areas
// drown in rounding: such a triangle is seen from its edge.
SUN_INLINE float exact_distance(const SUN_GLOBAL TraceLeaf *leaf, int lane, const PreparedRay *ray, int *lost) {
  float v[9], x[3], y[3], z[3], reach_x = 0.0f, reach_y = 0.0f;
  for (int k = 0; k < 9; k++) v[k] = TRI_CORNER(leaf, k, lane);
  for (int corner = 0; corner < 3; corner++) {
    z[corner] = v[3 * corner + ray->axis[2]] - ray->origin[2];
    x[corner] = fma(-ray->shear[0], z[corner], v[3 * corner + ray->axis[0]] - ray->origin[0]);
    y[corner] = fma(-ray->shear[1], z[corner], v[3 * corner + ray->axis[1]] - ray->origin[1]);
    const float ax = fabs(x[corner]), ay = fabs(y[corner]);
    reach_x = SUN_GREATER(reach_x, ax);
    reach_y = SUN_GREATER(reach_y, ay);
  }
  const float a = TRI_AREA(x[2], y[1], y[2], x[1]) + TRI_REMAINDER(x[2], y[1], y[2], x[1]);
  const float b = TRI_AREA(x[0], y[2], y[0], x[2]) + TRI_REMAINDER(x[0], y[2], y[0], x[2]);
  const float c = TRI_AREA(x[1], y[0], y[1], x[0]) + TRI_REMAINDER(x[1], y[0], y[1], x[0]);
  const float det = a + b + c;
  *lost = !(fabs(det) > 3.7252903e-09f * (reach_x * reach_y));  // 2^-28
  const float inverse = 1.0f / (det != 0.0f ? det : 1.0f);
  float t = fma(a * inverse, z[0], fma(b * inverse, z[1], c * inverse * z[2])) * ray->shear[2];
  float lower[3], upper[3];
  for (int axis = 0; axis < 3; axis++) {
    const float ab_lower = SUN_LESSER(v[axis], v[3 + axis]), ab_upper = SUN_GREATER(v[axis], v[3 + axis]);
    lower[axis] = SUN_LESSER(ab_lower, v[6 + axis]);
    upper[axis] = SUN_GREATER(ab_upper, v[6 + axis]);
  }
  const Interval whole = box_interval(ray, lower[0], lower[1], lower[2], upper[0], upper[1], upper[2], 0.0f);
  t = t > whole.near ? t : whole.near;
  return t < whole.far ? t : whole.far;
}

SUN_INLINE Interval fragment_interval(const SUN_GLOBAL Fragment *f, const PreparedRay *ray) {
  return box_interval(ray, f->lower[0], f->lower[1], f->lower[2], f->upper[0], f->upper[1], f->upper[2], 0.0f);
}

// 2 for a triangle in pieces, come by way of one of them. Its t is the same whichever piece that was: the pieces that hold t are asked for the hit. The
// ray at t is as near to a point of the triangle as the margins of slabs and pieces make up for. Where t errs by more, it is found again with more care;
// where that is no use, it is the nearest that any piece makes of it. So some piece always holds it (docs/decisions/0002-hits.md).
SUN_INLINE int fragment_counts(const SUN_GLOBAL TraceLeaf *leaf, int lane, const SUN_GLOBAL Fragment *fragment, const PreparedRay *ray, float det,
                               float *t_hit) {
  const Interval piece = fragment_interval(fragment, ray);
  if (!(piece.near <= piece.far)) return 0;
  if (!(fabs(det) > fragment->least_area)) {
    int lost;
    const float t = exact_distance(leaf, lane, ray, &lost);
    *t_hit = t;
    if (lost && t > 0.0f) {
      const SUN_GLOBAL Fragment *other = fragment;
      while ((other - 1)->primitive == fragment->primitive) other--;
      float nearest = SUN_INFINITY;
      for (; other->primitive == fragment->primitive; other++) {
        const Interval inside = fragment_interval(other, ray);
        if (!(inside.near <= inside.far)) continue;
        const float late = t > inside.near ? t : inside.near, held = late < inside.far ? late : inside.far;
        nearest = SUN_LESSER(held, nearest);
      }
      *t_hit = nearest;
    }
  }
  return piece.near <= *t_hit && *t_hit <= piece.far;
}

// 2 for the lanes of `split`, whose id names a fragment; t and the primitive become those of the whole triangle.
SUN_INLINE tri_int fragments_count(const SUN_GLOBAL TraceLeaf *leaf, const SUN_GLOBAL Fragment *fragments, const PreparedRay *ray, tri_int ok,
                                   tri_int split, tri_float det, tri_float *t, tri_uint *primitive) {
  int oks[TRI_COUNT];
  float ts[TRI_COUNT], dets[TRI_COUNT];
  uint primitives[TRI_COUNT];
  TRI_STORE(ok, oks);
  TRI_STORE(*t, ts);
  TRI_STORE(det, dets);
  TRI_STORE(*primitive, primitives);
  for (ulong lanes = TRI_BYTES(split); lanes; lanes &= lanes - 1) {
    const int lane = lowest_byte(lanes);
    const SUN_GLOBAL Fragment *fragment = fragments + primitives[lane];
    primitives[lane] = fragment->primitive;
    if (!fragment_counts(leaf, lane, fragment, ray, dets[lane], &ts[lane])) oks[lane] = 0;
  }
  *t = TRI_RELOAD(ts);
  *primitive = TRI_RELOAD(primitives);
  return TRI_RELOAD(oks);
}

// 2 to 5, for lanes that pierce() let through. t, u and v (of corners 1 and 2) and the primitive mean something where the result is true.
SUN_INLINE tri_int counts(const SUN_GLOBAL TraceLeaf *leaf, const SUN_GLOBAL Fragment *fragments, const PreparedRay *ray, const Place *place,
                          const Search *search, const Pierced *p, tri_int pierced, tri_float *t_hit, tri_float *u_hit, tri_float *v_hit,
                          tri_uint *primitive_hit) {
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
  const tri_uint id = TRI_LOAD_ID(leaf);
  tri_uint primitive = id & SUN_ID_PRIMITIVE;
  const tri_int split = ok & ((id & SUN_ID_FRAGMENT) != 0);
  if (TRI_ANY(split)) ok = fragments_count(leaf, fragments, ray, ok, split, det, &t, &primitive);
  t = t < place->world.near ? (tri_float)(place->world.near) : t;
  t = t > place->world.far ? (tri_float)(place->world.far) : t;

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
  *primitive_hit = primitive;
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
