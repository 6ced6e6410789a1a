// SPDX-License-Identifier: Apache-2.0
// A stored vertex of a light subpath: two records of 16 words, textures looked up, so that any eye vertex may join it.
#ifndef SUN_TRANSPORT_LIGHT_VERTEX_H
#define SUN_TRANSPORT_LIGHT_VERTEX_H
#include "shared/bidirectional.h"
#include "shared/light_map.h"
#include "transport/both_ways.h"

SUN_NAMESPACE_BEGIN

typedef struct LightVertex {
  Meeting at;
  vec3 to_light;     // unit length, back along the subpath
  vec3 flux;         // that arrives
  real dVCM, dVC, dVM;
  uint_n depth;      // scatterings before it
  uint_n material;   // whose solid absorbs what leaves on its inner side
  mask front;        // found from the front
  mask caustic;      // every scattering before it was a delta, and there was one
  real presence;     // chance that the surface is there for a path (alpha): where two paths merge on it, both have met it, and one of the two is to count
  mask unseen;       // and the light is one without extent: no eye path meets it by chance
} LightVertex;

// Slot's vertex `number`: those of one number stand together.
SUN_FN uint_n light_vertex_record(uint pool, uint_n slot, uint_n number) { return (number * (uint_n)(pool) + slot) * (uint_n)(SUN_LIGHT_VERTEX_RECORDS); }

SUN_FN void light_vertex_store(SUN_GLOBAL uint *vertices, uint_n record, mask stored, const LightVertex *v) {
  const Bsdf *b = &v->at.bsdf;
  uint_n one = (uint_n)(1), zero = (uint_n)(0);
  uint_n flags = (b->solid ? one : zero) | (b->specular ? one << (uint_n)(1) : zero) | (v->front ? one << (uint_n)(2) : zero) |
                 (v->unseen ? (uint_n)(SUN_LIGHT_VERTEX_UNSEEN) : zero) | (v->caustic ? (uint_n)(SUN_LIGHT_VERTEX_CAUSTIC) : zero) | (v->depth << (uint_n)(SUN_LIGHT_VERTEX_DEPTH_SHIFT));
  // Rounded up, so never 0.
  if (SUN_MERGING) flags = flags | (uint_of_int(int_of_real(65535.0f - floor(65535.0f * (1.0f - v->presence)))) << (uint_n)(SUN_LIGHT_VERTEX_PRESENCE_SHIFT));
  uint_n arrives[16] = {bits_of_real(v->at.position.x), bits_of_real(v->at.position.y), bits_of_real(v->at.position.z), flags,
                        bits_of_real(v->at.normal.x),   bits_of_real(v->at.normal.y),   bits_of_real(v->at.normal.z),   bits_of_real(v->dVCM),
                        bits_of_real(v->flux.x),        bits_of_real(v->flux.y),        bits_of_real(v->flux.z),        bits_of_real(v->dVC),
                        bits_of_real(v->to_light.x),    bits_of_real(v->to_light.y),    bits_of_real(v->to_light.z),    bits_of_real(SUN_MERGING ? v->dVM : v->presence)};
  uint_n leaves[16] = {bits_of_real(b->base.x),       bits_of_real(b->base.y),       bits_of_real(b->base.z),       bits_of_real(b->metallic),
                       bits_of_real(b->f0.x),         bits_of_real(b->f0.y),         bits_of_real(b->f0.z),         bits_of_real(b->f90),
                       bits_of_real(v->at.unbent.x),  bits_of_real(v->at.unbent.y),  bits_of_real(v->at.unbent.z),  bits_of_real(b->transmission),
                       bits_of_real(b->alpha),        bits_of_real(b->eta),          v->material,                   bits_of_real(v->at.offset)};
  store_records(vertices, record, stored, arrives);
  store_records(vertices, record + one, stored, leaves);
}

// What arrives there, without its weight at the surface: the bsdf is left as it is but for its being a solid.
SUN_FN LightVertex light_vertex_arrival(const SUN_GLOBAL uint *vertices, uint_n record) {
  uint_n w[16];
  LightVertex v;
  load_records(vertices, record, w);
  uint_n flags = w[SUN_LIGHT_VERTEX_FLAGS], zero = (uint_n)(0);
  v.at.position = make_vec3(real_of_bits(w[0]), real_of_bits(w[1]), real_of_bits(w[2]));
  v.at.normal = make_vec3(real_of_bits(w[4]), real_of_bits(w[5]), real_of_bits(w[6]));
  v.dVCM = real_of_bits(w[7]);
  v.flux = make_vec3(real_of_bits(w[8]), real_of_bits(w[9]), real_of_bits(w[10]));
  v.dVC = real_of_bits(w[11]);
  v.to_light = make_vec3(real_of_bits(w[12]), real_of_bits(w[13]), real_of_bits(w[14]));
  // Where walks merge the first record has no word left for it: what it has to say is said in 16 bits.
  v.presence = SUN_MERGING ? real_of_uint(flags >> (uint_n)(SUN_LIGHT_VERTEX_PRESENCE_SHIFT)) * (1.0f / 65535.0f) : real_of_bits(w[15]);
  v.dVM = real_of_bits(w[15]);
  v.at.bsdf.solid = (flags & (uint_n)(1)) != zero;
  v.at.bsdf.specular = (flags & (uint_n)(2)) != zero;
  v.front = (flags & (uint_n)(4)) != zero;
  v.caustic = (flags & (uint_n)(SUN_LIGHT_VERTEX_CAUSTIC)) != zero;
  v.unseen = (flags & (uint_n)(SUN_LIGHT_VERTEX_UNSEEN)) != zero;
  v.at.bsdf.inside = v.at.bsdf.solid & !v.front;
  v.depth = (flags >> (uint_n)(SUN_LIGHT_VERTEX_DEPTH_SHIFT)) & (uint_n)(0xff);
  return v;
}

SUN_FN LightVertex light_vertex_load(const SUN_GLOBAL uint *vertices, uint_n record) {
  uint_n w[16];
  LightVertex v = light_vertex_arrival(vertices, record);
  Bsdf *b = &v.at.bsdf;
  load_records(vertices, record + (uint_n)(1), w);
  b->base = make_vec3(real_of_bits(w[0]), real_of_bits(w[1]), real_of_bits(w[2]));
  b->metallic = real_of_bits(w[3]);
  b->f0 = make_vec3(real_of_bits(w[4]), real_of_bits(w[5]), real_of_bits(w[6]));
  b->f90 = real_of_bits(w[7]);
  v.at.unbent = make_vec3(real_of_bits(w[8]), real_of_bits(w[9]), real_of_bits(w[10]));
  b->transmission = real_of_bits(w[11]);
  b->alpha = real_of_bits(w[12]);
  b->eta = real_of_bits(w[13]);
  v.material = w[14];
  v.at.offset = real_of_bits(w[15]);
  return v;
}

SUN_NAMESPACE_END
#endif
