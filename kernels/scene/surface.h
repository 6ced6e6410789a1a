// SPDX-License-Identifier: Apache-2.0
// A hit becomes a surface: position, frames, texture coordinates, and the parameters of its material.
#ifndef SUN_SCENE_SURFACE_H
#define SUN_SCENE_SURFACE_H
#include "bsdf/bsdf.h"
#include "math/elementary.h"
#include "scene/placement.h"
#include "scene/scene.h"
#include "scene/shading_normal.h"
#include "scene/shape_surface.h"

SUN_NAMESPACE_BEGIN

// LANES hits; lanes without one carry instance 0 and primitive 0, which exist whenever any lane has a hit.
typedef struct HitLanes {
  real t, u, v;
  uint_n instance, primitive;
  mask hit;
} HitLanes;

SUN_FN HitLanes load_hits(const SUN_GLOBAL Hit *hits, uint_n slots, mask active) {
  HitLanes lanes;
  Quad hit;
  GATHER_QUAD(hit, hits, slots, t);
  lanes.t = real_of_bits(hit.x);
  lanes.u = real_of_bits(hit.y);
  lanes.v = real_of_bits(hit.z);
  lanes.instance = hit.w;
  GATHER_UINT(lanes.primitive, hits, slots, primitive);
  lanes.hit = active & (lanes.instance != (uint_n)(SUN_NONE));
  lanes.instance = lanes.hit ? lanes.instance : (uint_n)(0);
  lanes.primitive = lanes.hit ? lanes.primitive : (uint_n)(0);
  return lanes;
}

// The corners of LANES triangles, in world space.
typedef struct Corners {
  vec3 p[3];
  real u[3];        // texture coordinate
  uint_n vertex[3];
  uint_n material;
  uint_n flags;     // of the instance, mirrored as it is at the time
  mask moved;       // not the identity
#if SUN_DEFORMING
  mask deforms;
  uint_n next;      // from a vertex of the key before to that of the key after
#endif
} Corners;

// What a shape's point has in place of a triangle's; after load_corners, whose corners are all one for shapes.
SUN_INLINE ShapePoint point_of_shape(const Scene *scene, uint_n instance, uint_n flags, vec3 place, mask textured) {
  ShapePoint point;
  if (LANES_ALIKE(scene) && (FIRST_LANE(flags) & SUN_INSTANCE_ALIGNED)) {
    point = aligned_shape_point(scene->instances[FIRST_LANE(instance)].to_world, FIRST_LANE(flags), place);
  } else {
    Matrix matrix = instance_to_world(scene, instance, flags);
    point = shape_point(&matrix, flags, place);
  }
  if (SUN_TEXTURES && ANY(textured)) shape_coordinates(&point, flags, place);
  return point;
}

SUN_FN mask is_textured(uint_n material_flags) { return (material_flags & (uint_n)(SUN_MATERIAL_TEXTURED)) != (uint_n)(0); }

SUN_INLINE Corners load_corners(const Scene *scene, uint_n instance, uint_n primitive) {
  Corners c;
  Quad triangle;
  SCENE_QUAD(triangle, scene, triangles, primitive, vertex[0]);
  c.vertex[0] = triangle.x;
  c.vertex[1] = triangle.y;
  c.vertex[2] = triangle.z;
  c.material = triangle.w;
  SCENE_UINT(c.flags, scene, instances, instance, flags);
  c.moved = (c.flags & (uint_n)(SUN_INSTANCE_IDENTITY)) == (uint_n)(0);
#if SUN_DEFORMING
  c.deforms = (c.flags & (uint_n)(SUN_INSTANCE_DEFORMING)) != (uint_n)(0);
  c.next = (uint_n)(0);
  if (ANY(c.deforms)) c.next = c.deforms ? (uint_n)(scene->motion->deforming) : (uint_n)(0);
  SUN_UNROLL
  for (int k = 0; k < 3; k++) c.vertex[k] = c.vertex[k] + c.next * scene->moment.step;
#endif
#if SUN_TRIANGLES
  SUN_UNROLL
  for (int k = 0; k < 3; k++) {
    Quad vertex;
    SCENE_QUAD(vertex, scene, vertices, c.vertex[k], position[0]);
    c.p[k] = make_vec3(real_of_bits(vertex.x), real_of_bits(vertex.y), real_of_bits(vertex.z));
    c.u[k] = real_of_bits(vertex.w);
#if SUN_DEFORMING
    if (ANY(c.deforms)) {
      vec3 after;
      GATHER_VEC3(after, scene->vertices, c.vertex[k] + c.next, position[0]);
      c.p[k] = select3(c.deforms, blend3(c.p[k], after, scene->moment.blend), c.p[k]);
    }
#endif
  }
  if (ANY(c.moved)) {
    Matrix matrix = instance_to_world(scene, instance, c.flags);
    SUN_UNROLL
    for (int k = 0; k < 3; k++) c.p[k] = select3(c.moved, transform_point(&matrix, c.p[k]), c.p[k]);
    if (SUN_MOTION) {
      mask moving = (c.flags & (uint_n)(SUN_INSTANCE_MOVING)) != (uint_n)(0);
      uint_n plain = c.flags & (uint_n)(~SUN_INSTANCE_MIRRORED);
      c.flags = moving ? plain | (matrix_mirrors(&matrix) ? (uint_n)(SUN_INSTANCE_MIRRORED) : (uint_n)(0)) : c.flags;
    }
  }
#else
  SUN_UNROLL
  for (int k = 0; k < 3; k++) {
    c.p[k] = splat3((real)(0.0f));
    c.u[k] = (real)(0.0f);
  }
#endif
  return c;
}

// A vector of the corners, at the time.
#if SUN_DEFORMING
#define GATHER_CORNER(out, scene, c, k, records, field)                                         \
  do {                                                                                          \
    GATHER_VEC3(out, (scene)->records, (c)->vertex[k], field);                                  \
    if (ANY((c)->deforms)) {                                                                    \
      vec3 corner_after;                                                                        \
      GATHER_VEC3(corner_after, (scene)->records, (c)->vertex[k] + (c)->next, field);           \
      (out) = select3((c)->deforms, blend3((out), corner_after, (scene)->moment.blend), (out)); \
    }                                                                                           \
  } while (0)
#else
#define GATHER_CORNER(out, scene, c, k, records, field) SCENE_VEC3(out, scene, records, (c)->vertex[k], field)
#endif

// Out of the front: counter-clockwise in mesh space. Not normalised: its length is twice the area.
SUN_FN vec3 corners_normal(const Corners *c) {
  vec3 n = cross3(sub3(c->p[1], c->p[0]), sub3(c->p[2], c->p[0]));
  mask mirrored = (c->flags & (uint_n)(SUN_INSTANCE_MIRRORED)) != (uint_n)(0);
  return select3(mirrored, negate3(n), n);
}

SUN_FN vec3 interpolate3(vec3 a, vec3 b, vec3 c, real u, real v) {
  real w = 1.0f - u - v;
  return add3(add3(scale3(a, w), scale3(b, u)), scale3(c, v));
}
SUN_FN real interpolate(real a, real b, real c, real u, real v) { return (1.0f - u - v) * a + u * b + v * c; }

// A new ray starts this far along the normal: 2^-18 of the largest coordinate of the triangle, beyond the rounding of position and hit test
// (a few 2^-24 of the same), so scale and place of a scene do not matter [Waechter19].
SUN_FN real surface_offset(const Corners *c) {
  real largest = (real)(0.0f);
  SUN_UNROLL
  for (int k = 0; k < 3; k++) {
    largest = max_real(largest, fabs(c->p[k].x));
    largest = max_real(largest, fabs(c->p[k].y));
    largest = max_real(largest, fabs(c->p[k].z));
  }
  return largest * 3.81469727e-6f;
}

typedef struct Surface {
  vec3 position;         // world
  vec3 normal;           // geometric, unit length, on the ray's side
  Frame3 shading;        // shading frame; its normal is on the ray's side too
  vec3 unbent;           // that normal before it was bent towards the ray
  real offset;           // of new rays, along `normal`
  real area;             // of the triangle, world; of a shape: 1 / the density of its sampled points here
  real cos_front;        // cosine between the front's normal and the way back along the ray: negative from behind
  mask front;            // seen from the front
  real uv0[2], uv1[2];
  real color[4];         // vertex colour and alpha
  uint_n material;
  uint_n material_flags;
} Surface;

#if SUN_TEXTURES
// Texture coordinates and vertex colour at (u, v) of the triangle.
SUN_FN void surface_coordinates(const Scene *scene, Surface *s, const Corners *c, real u, real v) {
  real corner[3];
  s->uv0[0] = interpolate(c->u[0], c->u[1], c->u[2], u, v);
  SUN_UNROLL
  for (int k = 0; k < 3; k++) SCENE_FLOAT(corner[k], scene, vertices, c->vertex[k], v);
  s->uv0[1] = interpolate(corner[0], corner[1], corner[2], u, v);
  if (scene->frame->flags & SUN_FRAME_EXTRAS) {
    SUN_UNROLL
    for (int i = 0; i < 2; i++) {
      SUN_UNROLL
      for (int k = 0; k < 3; k++) SCENE_FLOAT(corner[k], scene, extras, c->vertex[k], uv1[i]);
      s->uv1[i] = interpolate(corner[0], corner[1], corner[2], u, v);
    }
    SUN_UNROLL
    for (int i = 0; i < 4; i++) {
      SUN_UNROLL
      for (int k = 0; k < 3; k++) SCENE_FLOAT(corner[k], scene, extras, c->vertex[k], color[i]);
      s->color[i] = interpolate(corner[0], corner[1], corner[2], u, v);
    }
  }
}
#endif

// The place on the shape that is hit, from where the ray met it: for shapes that are still.
SUN_INLINE vec3 place_of_meeting(const Scene *scene, uint_n instance, vec3 position) {
  uint_n flags;
  SCENE_UINT(flags, scene, instances, instance, flags);
  if (LANES_ALIKE(scene) && (FIRST_LANE(flags) & SUN_INSTANCE_ALIGNED))
    return aligned_shape_place_near(scene->instances[FIRST_LANE(instance)].to_object, FIRST_LANE(flags), position);
  Matrix to_object = instance_to_object(scene, instance, flags);
  return shape_place_near(flags, transform_point(&to_object, position));
}

// wo: unit vector back along the ray. `place`: on the shape that is hit, in its space; where it is 0 the hit's u and v tell.
SUN_INLINE Surface surface_at(const Scene *scene, const HitLanes *hit, const vec3 *place, vec3 wo) {
  Surface s;
  Corners c = load_corners(scene, hit->instance, hit->primitive);
  s.material = c.material;
  SCENE_UINT(s.material_flags, scene, materials, c.material, flags);
#if SUN_TRIANGLES
  s.position = interpolate3(c.p[0], c.p[1], c.p[2], hit->u, hit->v);
  vec3 n = corners_normal(&c);
  real twice_area = sqrt(dot3(n, n));
  s.area = 0.5f * twice_area;
  vec3 front_normal = normalize3(n);
  s.offset = surface_offset(&c);
#else
  vec3 front_normal = s.position = splat3((real)(0.0f));
  s.area = s.offset = (real)(0.0f);
#endif
#if SUN_SHAPES
  mask shape = LANES_ALIKE(scene) ? !(mask)(0) : hit->hit & is_shape(c.flags, SUN_INSTANCE_SHAPE);
  real shape_uv[2];
  shape_uv[0] = shape_uv[1] = (real)(0.0f);
  if (ANY(shape)) {
    ShapePoint point = point_of_shape(scene, hit->instance, c.flags, place ? *place : shape_place(c.flags, hit->u, hit->v), shape & is_textured(s.material_flags));
    s.position = select3(shape, point.position, s.position);
    front_normal = select3(shape, point.normal, front_normal);
    s.area = shape ? point.area : s.area;
    s.offset = shape ? point.offset : s.offset;
    shape_uv[0] = point.uv[0];
    shape_uv[1] = point.uv[1];
  }
#endif
  s.cos_front = dot3(front_normal, wo);
  s.front = s.cos_front > 0.0f;
  s.normal = select3(s.front, front_normal, negate3(front_normal));

#if SUN_TRIANGLES
  vec3 vertex_normal[3];
  SUN_UNROLL
  for (int k = 0; k < 3; k++) GATHER_CORNER(vertex_normal[k], scene, &c, k, vertices, normal[0]);
  vec3 ns = interpolate3(vertex_normal[0], vertex_normal[1], vertex_normal[2], hit->u, hit->v);
  if (ANY(c.moved)) {
    Matrix to_object = instance_to_object(scene, hit->instance, c.flags);
    ns = select3(c.moved, transform_normal(&to_object, ns), ns);
  }
  real length2 = dot3(ns, ns);
  ns = select3(length2 > 1e-30f, normalize3(ns), front_normal);
  // A shading normal belongs to the front; one that points behind it (bad input) gives way to the geometric one.
  ns = select3(dot3(ns, front_normal) > 0.0f, ns, front_normal);
#else
  vec3 ns = front_normal;
#endif
#if SUN_SHAPES
  ns = select3(shape, front_normal, ns);
#endif
  ns = select3(s.front, ns, negate3(ns));

  SUN_UNROLL

  for (int i = 0; i < 2; i++) s.uv0[i] = s.uv1[i] = (real)(0.0f);
  SUN_UNROLL
  for (int i = 0; i < 4; i++) s.color[i] = (real)(1.0f);
#if SUN_TEXTURES
#if SUN_TRIANGLES
  surface_coordinates(scene, &s, &c, hit->u, hit->v);
#endif
#if SUN_SHAPES
  SUN_UNROLL
  for (int i = 0; i < 2; i++) {
    s.uv0[i] = shape ? shape_uv[i] : s.uv0[i];
    s.uv1[i] = shape ? shape_uv[i] : s.uv1[i];
  }
  SUN_UNROLL
  for (int i = 0; i < 4; i++) s.color[i] = shape ? (real)(1.0f) : s.color[i];
#endif
#if SUN_TRIANGLES
  if (scene->frame->flags & SUN_FRAME_EXTRAS) {
    // The tangent frame of the normal map: interpolated, not made orthogonal again, as the map was baked [Mikkelsen08].
    uint_n normal_slot;
    SCENE_UINT(normal_slot, scene, materials, c.material, slot[SUN_SLOT_NORMAL]);
    mask mapped = hit->hit & (normal_slot != (uint_n)(SUN_NONE));
    if (ANY(mapped)) {
      vec3 corner_tangent[3];
      real handed;
      SUN_UNROLL
      for (int k = 0; k < 3; k++) GATHER_CORNER(corner_tangent[k], scene, &c, k, extras, tangent[0]);
      SCENE_FLOAT(handed, scene, extras, c.vertex[0], tangent[3]);
      vec3 tangent = interpolate3(corner_tangent[0], corner_tangent[1], corner_tangent[2], hit->u, hit->v);
      if (ANY(c.moved)) {
        Matrix to_world = instance_to_world(scene, hit->instance, c.flags);
        tangent = select3(c.moved, transform_direction(&to_world, tangent), tangent);
      }
      mapped = mapped & (dot3(tangent, tangent) > 1e-30f);
      tangent = normalize3(tangent);
      vec3 front_ns = select3(s.front, ns, negate3(ns));
      mask mirrored = (c.flags & (uint_n)(SUN_INSTANCE_MIRRORED)) != (uint_n)(0);
      handed = mirrored ? -handed : handed;
      vec3 bitangent = scale3(cross3(front_ns, tangent), handed);
      Texel4 texel = sample_slot(&scene->pages, scene->textures, scene->texture_refs, scene->tables, normal_slot, s.uv0, s.uv1, mapped);
      real scale;
      SCENE_FLOAT(scale, scene, materials, c.material, normal_scale);
      vec3 m = make_vec3((2.0f * texel.r - 1.0f) * scale, (2.0f * texel.g - 1.0f) * scale, 2.0f * texel.b - 1.0f);
      vec3 bumped = add3(add3(scale3(tangent, m.x), scale3(bitangent, m.y)), scale3(front_ns, m.z));
      mapped = mapped & (dot3(bumped, bumped) > 1e-12f);
      bumped = normalize3(bumped);
      bumped = select3(s.front, bumped, negate3(bumped));
      ns = select3(mapped, bumped, ns);
    }
  }
#endif
#endif
  s.unbent = ns;
#if SUN_TRIANGLES
  vec3 bent = bend_normal(ns, wo, s.normal);
#if SUN_SHAPES
  bent = select3(shape, ns, bent);  // the shading normal is the true one
#endif
  s.shading = frame_of_normal(bent);
#else
  s.shading = frame_of_normal(ns);
#endif
  return s;
}

SUN_FN Surface make_surface(const Scene *scene, const HitLanes *hit, vec3 wo) { return surface_at(scene, hit, 0, wo); }

// Where a ray to the side `direction` of a surface starts.
SUN_FN vec3 offset_origin(vec3 position, vec3 normal, real offset, vec3 direction) {
  real side = dot3(direction, normal) > 0.0f ? offset : -offset;
  return add3(position, scale3(normal, side));
}
SUN_FN vec3 surface_origin(const Surface *s, vec3 direction) { return offset_origin(s->position, s->normal, s->offset, direction); }

#if SUN_TEXTURES
SUN_FN Texel4 material_texel(const Scene *scene, const Surface *s, uint slot, mask wanted) {
  const real uv0[2] = {s->uv0[0], s->uv0[1]}, uv1[2] = {s->uv1[0], s->uv1[1]};  // copies: given away, its own would keep all of the surface in memory
  if (LANES_ALIKE(scene))
    return sample_slot_alike(&scene->pages, scene->textures, scene->texture_refs, scene->tables, scene->materials[FIRST_LANE(s->material)].slot[slot], uv0, uv1, wanted);
  uint_n ref;
  SCENE_UINT(ref, scene, materials, s->material, slot[slot]);
  return sample_slot(&scene->pages, scene->textures, scene->texture_refs, scene->tables, ref, uv0, uv1, wanted);
}
#endif

// Chance that the surface is there: 1 but for alpha cut-out and blend.
SUN_FN real surface_alpha(const Scene *scene, const Surface *s, mask wanted) {
  uint_n flags = s->material_flags;
  mask uses = wanted & ((flags & (uint_n)(SUN_MATERIAL_ALPHA_MASK | SUN_MATERIAL_ALPHA_BLEND)) != (uint_n)(0));
  real alpha = (real)(1.0f);
  if (ANY(uses)) {
    real value, cutoff;
    SCENE_FLOAT(value, scene, materials, s->material, base_color[3]);
    SCENE_FLOAT(cutoff, scene, materials, s->material, alpha_cutoff);
    value = value * s->color[3];
#if SUN_TEXTURES
    value = value * material_texel(scene, s, SUN_SLOT_BASE_COLOR, uses).a * material_texel(scene, s, SUN_SLOT_ALPHA, uses).r;
#endif
    mask cut = (flags & (uint_n)(SUN_MATERIAL_ALPHA_MASK)) != (uint_n)(0);
    value = cut ? (value >= cutoff ? (real)(1.0f) : (real)(0.0f)) : value;
    alpha = uses ? clamp_real(value, (real)(0.0f), (real)(1.0f)) : alpha;
  }
  return alpha;
}

SUN_FN vec3 surface_emission(const Scene *scene, const Surface *s, mask wanted) {
  vec3 emission = splat3((real)(0.0f));
  mask emits = wanted & ((s->material_flags & (uint_n)(SUN_MATERIAL_EMISSIVE)) != (uint_n)(0)) &
               (s->front | ((s->material_flags & (uint_n)(SUN_MATERIAL_DOUBLE_SIDED)) != (uint_n)(0)));
  if (ANY(emits)) {
    vec3 value;
    SCENE_VEC3(value, scene, materials, s->material, emission[0]);
#if SUN_TEXTURES
    Texel4 texel = material_texel(scene, s, SUN_SLOT_EMISSION, emits);
    value = mul3(value, make_vec3(texel.r, texel.g, texel.b));
    // Unlit surfaces show their base colour, vertex colours included.
    mask unlit = (s->material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != (uint_n)(0);
    value = select3(unlit, mul3(value, make_vec3(s->color[0], s->color[1], s->color[2])), value);
#endif
    emission = select3(emits, value, emission);
  }
  return emission;
}

// The bsdf's parameters, textures looked up.
SUN_INLINE Bsdf surface_bsdf(const Scene *scene, const Surface *s, mask wanted) {
  Bsdf b;
  SCENE_VEC3(b.base, scene, materials, s->material, base_color[0]);
#if SUN_TEXTURES
  mask textured = wanted & is_textured(s->material_flags);
  b.base = mul3(b.base, make_vec3(s->color[0], s->color[1], s->color[2]));
  if (ANY(textured)) {
    Texel4 texel = material_texel(scene, s, SUN_SLOT_BASE_COLOR, textured);
    b.base = mul3(b.base, make_vec3(texel.r, texel.g, texel.b));
  }
#endif
  b.base = make_vec3(clamp_real(b.base.x, (real)(0.0f), (real)(1.0f)), clamp_real(b.base.y, (real)(0.0f), (real)(1.0f)), clamp_real(b.base.z, (real)(0.0f), (real)(1.0f)));
  b.specular = wanted & ((s->material_flags & (uint_n)(SUN_MATERIAL_SPECULAR)) != (uint_n)(0));
  b.metallic = b.transmission = b.f90 = (real)(0.0f);
  b.alpha = b.eta = (real)(1.0f);
  b.f0 = splat3((real)(0.0f));
  b.solid = wanted & ((s->material_flags & (uint_n)(SUN_MATERIAL_VOLUME)) != (uint_n)(0));
  b.inside = b.solid & !s->front;
#if SUN_SPECULAR
  if (ANY(b.specular)) {
    Quad quad;
    SCENE_QUAD(quad, scene, materials, s->material, metallic);
    b.metallic = real_of_bits(quad.x);
    real roughness = real_of_bits(quad.y);
    b.transmission = real_of_bits(quad.z);
    real ior = real_of_bits(quad.w);
    SCENE_QUAD(quad, scene, materials, s->material, f0[0]);
    b.f0 = make_vec3(real_of_bits(quad.x), real_of_bits(quad.y), real_of_bits(quad.z));
    b.f90 = real_of_bits(quad.w);
#if SUN_TEXTURES
    if (ANY(textured)) {
      Texel4 texel = material_texel(scene, s, SUN_SLOT_METALLIC_ROUGHNESS, textured);
      roughness = roughness * texel.g;
      b.metallic = b.metallic * texel.b;
      b.transmission = b.transmission * material_texel(scene, s, SUN_SLOT_TRANSMISSION, textured).r;
      real specular = material_texel(scene, s, SUN_SLOT_SPECULAR, textured).a;
      texel = material_texel(scene, s, SUN_SLOT_SPECULAR_COLOR, textured);
      b.f90 = b.f90 * specular;
      b.f0 = mul3(scale3(b.f0, specular), make_vec3(texel.r, texel.g, texel.b));
    }
#endif
    b.alpha = roughness * roughness;
    b.eta = b.inside ? 1.0f / ior : ior;
  }
#endif
  return b;
}

// What is left of light after `distance` within a solid of this material (Beer's law).
SUN_FN vec3 solid_transmittance(const Scene *scene, uint_n material, real distance, mask within) {
  vec3 left = splat3((real)(1.0f));
  if (ANY(within)) {
    vec3 a;
    uint_n known = material;
    if (!LANES_ALIKE(scene)) known = within ? material : (uint_n)(0);  // lanes that are not within one need not name any
    SCENE_VEC3(a, scene, materials, known, absorption[0]);
    within = within & (max_of3(a) > 0.0f);
    if (!ANY(within)) return left;
    vec3 passed = make_vec3(exp_real(-a.x * distance), exp_real(-a.y * distance), exp_real(-a.z * distance));
    left = select3(within, passed, left);
  }
  return left;
}

// The same for the solid that the ray leaves here; 1 where it comes from outside.
SUN_FN vec3 surface_absorption(const Scene *scene, const Surface *s, real distance, mask wanted) {
  mask within = wanted & !s->front & ((s->material_flags & (uint_n)(SUN_MATERIAL_VOLUME)) != (uint_n)(0));
  return solid_transmittance(scene, s->material, distance, within);
}

SUN_NAMESPACE_END
#endif
