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

// What few rays come to, in kernels for CPUs: kept out of the loops, whose registers it would take.
#define SUN_RARE SUN_INLINE
#if !defined(__cplusplus) && SUN_LAYOUT != SUN_LAYOUT_BINARY
#undef SUN_RARE
#define SUN_RARE static __attribute__((noinline))
#endif

SUN_NAMESPACE_BEGIN

#if SUN_LAYOUT == SUN_LAYOUT_BINARY
typedef float tri_float;
typedef int tri_int;
typedef uint tri_uint;
typedef LeafTriangle TraceLeaf;
#define TRI_COUNT 1
#define TRI_READ(place, k) ((place)->v[k])
#define TRI_READ_ID(place) ((place)->id)
#define TRI_READ_CORNER(place, k, lane) ((void)(lane), (place)->v[k])
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
#define TRI_READ(place, k) vload8(0, (place)->v[k])
#define TRI_READ_ID(place) vload8(0, (place)->id)
#define TRI_READ_CORNER(place, k, lane) ((place)->v[k][lane])
#define TRI_STORE(v, array) vstore8((v), 0, (array))
#define TRI_RELOAD(array) vload8(0, (array))
// Not any(): PoCL makes a chain of branches of it.
#define TRI_ANY(m) (as_ulong(convert_char8(m)) != 0)
#define TRI_BYTES(m) bytes_of8(m)
#endif

// Triangles as a ray meets them. Where they deform a leaf stands in memory once for each key, and is read between two of them; leaves that do not deform are both.
#if SUN_DEFORMING
typedef struct LeafAt {
  const SUN_GLOBAL TraceLeaf *at, *next;
  float blend;
} LeafAt;
#define TRI_LOAD(leaf, k) (fma((tri_float)((leaf).blend), TRI_READ((leaf).next, k) - TRI_READ((leaf).at, k), TRI_READ((leaf).at, k)))
#define TRI_LOAD_ID(leaf) TRI_READ_ID((leaf).at)
#define TRI_CORNER(leaf, k, lane) between_keys(TRI_READ_CORNER((leaf).at, k, lane), TRI_READ_CORNER((leaf).next, k, lane), (leaf).blend)
#else
typedef const SUN_GLOBAL TraceLeaf *LeafAt;
#define TRI_LOAD TRI_READ
#define TRI_LOAD_ID TRI_READ_ID
#define TRI_CORNER TRI_READ_CORNER
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
#if SUN_DEFORMING
  uint keys;             // that each of its leaves has
  RayMoment moment;
#endif
} Place;

// An instance whose space is the world's.
SUN_INLINE Place place_in_world(uint number, const Search *search) {
  Place place;
  place.instance = number;
  const uint passed = search->passed_primitive;
  place.first_primitive = number > search->passed_instance                                 ? 0
                          : number < search->passed_instance || passed >= SUN_ID_PRIMITIVE ? SUN_NONE
                                                                                           : passed + 1;
  place.world.near = 0.0f;
  place.world.far = SUN_INFINITY;
  place.from = search->passed_t;
#if SUN_DEFORMING
  place.keys = 1;
  place.moment.step = 0;
  place.moment.blend = 0.0f;
#endif
  return place;
}

// Leaf `number` of those that begin at `first`.
SUN_INLINE LeafAt leaf_at(const SUN_GLOBAL TraceLeaf *leaves, uint first, uint number, const Place *place) {
#if SUN_DEFORMING
  LeafAt leaf;
  leaf.at = leaves + first + number * place->keys + place->moment.step;
  leaf.next = leaf.at + (place->keys > 1 ? 1 : 0);
  leaf.blend = place->moment.blend;
  return leaf;
#else
  (void)place;
  return leaves + first + number;
#endif
}

// Boxes of this instance with near > limit hold nothing that counts: every t there is clamped to at least that much, unless the world box pulls it
// back.
SUN_INLINE float box_limit(const Place *place, const Search *search) { return search->best_t < place->world.far ? search->best_t : SUN_INFINITY; }

typedef struct Pierced {
  tri_float u, v, w;     // scaled barycentrics of corners 0, 1, 2: twice the signed areas in the sheared space
  tri_float az, bz, cz;  // the corners along its third axis
  tri_int edge;          // one of u, v and w is 0
} Pierced;

// Twice the signed area a * b - c * d. Where the difference of the rounded products is not 0 its sign is right; where it is 0, the exact remainders
// tell.
#define TRI_AREA(a, b, c, d) ((a) * (b) - (c) * (d))
#define TRI_REMAINDER(a, b, c, d) (fma((a), (b), -((a) * (b))) - fma((c), (d), -((c) * (d))))

// 1, but for the zeros, which pass as either sign: does the ray's line pass the triangle, on its edges included?
SUN_INLINE tri_int pierce(LeafAt leaf, const PreparedRay *ray, Pierced *p) {
  const int kx = ray->axis[0], ky = ray->axis[1], kz = ray->axis[2];
  const tri_float ox = (tri_float)(ray->origin[0]), oy = (tri_float)(ray->origin[1]), oz = (tri_float)(ray->origin[2]);
  const tri_float sx = (tri_float)(-ray->shear[0]), sy = (tri_float)(-ray->shear[1]);
  const tri_float az = TRI_LOAD(leaf, kz) - oz, bz = TRI_LOAD(leaf, 3 + kz) - oz, cz = TRI_LOAD(leaf, 6 + kz) - oz;
  const tri_float ax = fma(sx, az, TRI_LOAD(leaf, kx) - ox), ay = fma(sy, az, TRI_LOAD(leaf, ky) - oy);
  const tri_float bx = fma(sx, bz, TRI_LOAD(leaf, 3 + kx) - ox), by = fma(sy, bz, TRI_LOAD(leaf, 3 + ky) - oy);
  const tri_float cx = fma(sx, cz, TRI_LOAD(leaf, 6 + kx) - ox), cy = fma(sy, cz, TRI_LOAD(leaf, 6 + ky) - oy);
  p->u = TRI_AREA(cx, by, cy, bx);
  p->v = TRI_AREA(ax, cy, ay, cx);
  p->w = TRI_AREA(bx, ay, by, ax);
  const tri_float low_uv = SUN_LESSER(p->u, p->v), high_uv = SUN_GREATER(p->u, p->v);
  const tri_float low = SUN_LESSER(low_uv, p->w), high = SUN_GREATER(high_uv, p->w);
  p->az = az;
  p->bz = bz;
  p->cz = cz;
  p->edge = (low == 0.0f) | (high == 0.0f);
  return (low >= 0.0f) | (high <= 0.0f);
}

// The distance at which a ray passes a triangle, from areas with their remainders, clamped into the triangle's own box. `lost` where even those areas
// drown in rounding: such a triangle is seen from its edge.
SUN_INLINE float exact_distance(LeafAt leaf, int lane, const PreparedRay *ray, int *lost) {
  float x[3], y[3], z[3], reach_x = 0.0f, reach_y = 0.0f;
  SUN_UNROLL
  for (int corner = 0; corner < 3; corner++) {
    z[corner] = TRI_CORNER(leaf, 3 * corner + ray->axis[2], lane) - ray->origin[2];
    x[corner] = fma(-ray->shear[0], z[corner], TRI_CORNER(leaf, 3 * corner + ray->axis[0], lane) - ray->origin[0]);
    y[corner] = fma(-ray->shear[1], z[corner], TRI_CORNER(leaf, 3 * corner + ray->axis[1], lane) - ray->origin[1]);
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
  SUN_UNROLL
  for (int axis = 0; axis < 3; axis++) {
    const float va = TRI_CORNER(leaf, axis, lane), vb = TRI_CORNER(leaf, 3 + axis, lane), vc = TRI_CORNER(leaf, 6 + axis, lane);
    const float ab_lower = SUN_LESSER(va, vb), ab_upper = SUN_GREATER(va, vb);
    lower[axis] = SUN_LESSER(ab_lower, vc);
    upper[axis] = SUN_GREATER(ab_upper, vc);
  }
  const Interval whole = box_interval(ray, lower[0], lower[1], lower[2], upper[0], upper[1], upper[2], 0.0f);
  t = t > whole.near ? t : whole.near;
  return t < whole.far ? t : whole.far;
}

SUN_INLINE Interval fragment_interval(const SUN_GLOBAL Fragment *f, const PreparedRay *ray) {
  return box_interval(ray, f->lower[0], f->lower[1], f->lower[2], f->upper[0], f->upper[1], f->upper[2], 0.0f);
}

// 2 for a triangle in pieces that is seen nearly from its edge: t is found again with more care, and where that is no use, it is the nearest that any
// piece makes of it. So some piece always holds it, as it does without this where t errs by less than the margins of slabs and pieces make up for
// (docs/decisions/0002-hits.md).
SUN_INLINE float grazed_distance(LeafAt leaf, int lane, const SUN_GLOBAL Fragment *fragments, uint primitive,
                                 const PreparedRay *ray) {
  int lost;
  const float t = exact_distance(leaf, lane, ray, &lost);
  if (!lost || !(t > 0.0f)) return t;
  uint first = 1, end = fragments[0].count + 1;  // its pieces stand together, in the order of the triangles
  while (first < end) {
    const uint middle = first + (end - first) / 2;
    if (fragments[middle].primitive < primitive)
      first = middle + 1;
    else
      end = middle;
  }
  float nearest = SUN_INFINITY;
  for (; fragments[first].primitive == primitive; first++) {
    const Interval inside = fragment_interval(&fragments[first], ray);
    if (!(inside.near <= inside.far)) continue;
    const float late = t > inside.near ? t : inside.near, held = late < inside.far ? late : inside.far;
    nearest = SUN_LESSER(held, nearest);
  }
  return nearest;
}

typedef struct Distances {
  tri_float u, v, t, det;  // barycentrics of corners 1 and 2, the distance, and the sum of the scaled barycentrics: its sign tells the side
  tri_float longest;       // extent of the triangle's box
  tri_int ok;
} Distances;

// 2, for lanes that pierce() let through.
SUN_INLINE Distances distances_of(LeafAt leaf, const PreparedRay *ray, const Pierced *p, tri_int pierced) {
  Distances d;
  d.det = p->u + p->v + p->w;
  const tri_float inverse = 1.0f / d.det;
  d.u = p->v * inverse;
  d.v = p->w * inverse;
  d.t = fma(p->u * inverse, p->az, fma(d.u, p->bz, d.v * p->cz)) * ray->shear[2];
  d.ok = pierced & (d.det != 0.0f) & (fabs(d.t) <= SUN_LARGEST);  // NaN fails
  tri_float enter = (tri_float)(0.0f), leave = (tri_float)(SUN_INFINITY);
  d.longest = (tri_float)(0.0f);
  SUN_UNROLL
  for (int axis = 0; axis < 3; axis++) {
    const tri_float a = TRI_LOAD(leaf, axis), b = TRI_LOAD(leaf, 3 + axis), c = TRI_LOAD(leaf, 6 + axis);
    const tri_float ab_lower = SUN_LESSER(a, b), ab_upper = SUN_GREATER(a, b);
    const tri_float lower = SUN_LESSER(ab_lower, c), upper = SUN_GREATER(ab_upper, c), extent = upper - lower;
    const tri_float reciprocal = (tri_float)(ray->reciprocal[axis]);
    const tri_float near_offset = (tri_float)(ray->near_offset[axis]), far_offset = (tri_float)(ray->far_offset[axis]);
    // The nearer of both planes, whichever way the ray goes: no choice by axis.
    const tri_float near_lower = fma(lower, reciprocal, near_offset), near_upper = fma(upper, reciprocal, near_offset);
    const tri_float far_lower = fma(lower, reciprocal, far_offset), far_upper = fma(upper, reciprocal, far_offset);
    const tri_float near = SUN_LESSER(near_lower, near_upper), far = SUN_GREATER(far_lower, far_upper);
    enter = SUN_GREATER(near, enter);
    leave = SUN_LESSER(far, leave);
    d.longest = SUN_GREATER(extent, d.longest);
  }
  d.ok = d.ok & (enter <= leave);
  d.t = d.t < enter ? enter : d.t;
  d.t = d.t > leave ? leave : d.t;
  return d;
}

// The lanes of `careful` again: edges get the exact sign of their zeros, triangles in pieces that are seen nearly from their edge their t.
SUN_RARE void take_care(LeafAt leaf, const SUN_GLOBAL Fragment *fragments, const PreparedRay *ray, tri_int careful, Pierced *p,
                        Distances *d) {
  const int kx = ray->axis[0], ky = ray->axis[1];
  const tri_float ox = (tri_float)(ray->origin[0]), oy = (tri_float)(ray->origin[1]);
  const tri_float sx = (tri_float)(-ray->shear[0]), sy = (tri_float)(-ray->shear[1]);
  const tri_float ax = fma(sx, p->az, TRI_LOAD(leaf, kx) - ox), ay = fma(sy, p->az, TRI_LOAD(leaf, ky) - oy);
  const tri_float bx = fma(sx, p->bz, TRI_LOAD(leaf, 3 + kx) - ox), by = fma(sy, p->bz, TRI_LOAD(leaf, 3 + ky) - oy);
  const tri_float cx = fma(sx, p->cz, TRI_LOAD(leaf, 6 + kx) - ox), cy = fma(sy, p->cz, TRI_LOAD(leaf, 6 + ky) - oy);
  p->u = p->u == 0.0f ? TRI_REMAINDER(cx, by, cy, bx) : p->u;
  p->v = p->v == 0.0f ? TRI_REMAINDER(ax, cy, ay, cx) : p->v;
  p->w = p->w == 0.0f ? TRI_REMAINDER(bx, ay, by, ax) : p->w;
  const tri_int same_side = ((p->u >= 0.0f) & (p->v >= 0.0f) & (p->w >= 0.0f)) | ((p->u <= 0.0f) & (p->v <= 0.0f) & (p->w <= 0.0f));
  *d = distances_of(leaf, ray, p, d->ok & same_side);
  const tri_uint id = TRI_LOAD_ID(leaf);
  const tri_int grazed = careful & d->ok & ((id & SUN_ID_FRAGMENT) != 0) & (fabs(d->det) <= SUN_FRAGMENT_AREA * (d->longest * d->longest));
  float ts[TRI_COUNT];
  uint ids[TRI_COUNT];
  TRI_STORE(d->t, ts);
  TRI_STORE(id, ids);
  for (ulong lanes = TRI_BYTES(grazed); lanes; lanes &= lanes - 1) {
    const int lane = lowest_byte(lanes);
    ts[lane] = grazed_distance(leaf, lane, fragments, ids[lane] & SUN_ID_PRIMITIVE, ray);
  }
  d->t = TRI_RELOAD(ts);
}

// The rest of 1, and 2 to 5, for lanes that pierce() let through. t, u and v (of corners 1 and 2) and the primitive mean something where the result is
// true.
SUN_INLINE tri_int counts(LeafAt leaf, const SUN_GLOBAL Fragment *fragments, const PreparedRay *ray, const Place *place,
                          const Search *search, const Pierced *p, tri_int pierced, tri_float *t_hit, tri_float *u_hit, tri_float *v_hit,
                          tri_uint *primitive_hit) {
  Distances d = distances_of(leaf, ray, p, pierced);
  const tri_uint id = TRI_LOAD_ID(leaf);
  const tri_uint primitive = id & SUN_ID_PRIMITIVE;
  const tri_int in_pieces = (id & SUN_ID_FRAGMENT) != 0;
  const tri_int careful = pierced & (p->edge | (in_pieces & (fabs(d.det) <= SUN_FRAGMENT_AREA * (d.longest * d.longest))));
  if (TRI_ANY(careful)) {
    Pierced again = *p;
    Distances found;
    found.ok = pierced;
    take_care(leaf, fragments, ray, careful, &again, &found);
    d = found;
  }
  tri_int ok = d.ok;
  tri_float t = d.t;
  t = t < place->world.near ? (tri_float)(place->world.near) : t;
  t = t > place->world.far ? (tri_float)(place->world.far) : t;

  // Seen from behind: clockwise in the mesh's own space, so a mirrored instance's front stays its front.
  if (!SUN_BIDIRECTIONAL || search->want != SUN_WANT_BOTH_SIDES) ok = ok & !(((id & SUN_ID_SINGLE_SIDED) != 0) & (d.det < 0.0f));
  if (search->want == SUN_WANT_OPAQUE) ok = ok & ((id & SUN_ID_PASSABLE) == 0);
  if (search->want == SUN_WANT_PASSABLE) ok = ok & ((id & SUN_ID_PASSABLE) != 0);

  const uint end_primitive = place->instance < search->best_instance    ? SUN_NONE
                             : place->instance == search->best_instance ? search->best_primitive
                                                                        : 0;
  ok = ok & ((t > search->passed_t) | ((t == search->passed_t) & (primitive >= place->first_primitive)));
  ok = ok & ((t < search->best_t) | ((t == search->best_t) & (primitive < end_primitive)));
  *t_hit = t;
  *u_hit = d.u;
  *v_hit = d.v;
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
