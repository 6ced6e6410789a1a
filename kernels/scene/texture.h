// SPDX-License-Identifier: Apache-2.0
// Textures from pages of plain buffers: wrapping, filtering and decoding in defined arithmetic. The records of the lanes differ, so each lane fetches
// for itself.
#ifndef SUN_SCENE_TEXTURE_H
#define SUN_SCENE_TEXTURE_H
#include "math/real.h"
#include "shared/tables.h"
#include "shared/texture.h"

SUN_NAMESPACE_BEGIN

typedef struct TexturePages {
  const SUN_GLOBAL uint *page[SUN_TEXTURE_PAGES];
} TexturePages;

typedef struct Texel4 {
  real r, g, b, a;
} Texel4;

// floor of one float, whatever LANES is.
#ifdef __cplusplus
SUN_FN float floor_one(float x) { return floor(x); }
#else
#define floor_one(x) floor((float)(x))
#endif

// A half in the low 16 bits, by integer operations and one exact product.
SUN_FN float float_of_half(uint half_bits) {
  uint sign = (half_bits & 0x8000u) << 16;
  uint exponent = (half_bits >> 10) & 31u;
  uint mantissa = half_bits & 0x3ffu;
  float subnormal = (float)mantissa * 5.96046448e-8f;  // 2^-24
  uint top = exponent == 31u ? 255u : exponent + 112u;
  float normal = as_float((top << 23) | (mantissa << 13));
  float magnitude = exponent == 0u ? subnormal : normal;
  return sign != 0u ? -magnitude : magnitude;
}

// One texel, decoded. x and y are inside.
SUN_FN void fetch_texel(const TexturePages *pages, const SUN_GLOBAL Texture *texture, const SUN_GLOBAL float *tables, uint x, uint y, float out[4]) {
  uint page = texture->page;
  // Picked by comparisons: an index into an array of pointers would put it into memory.
  const SUN_GLOBAL uint *words = page == 0u ? pages->page[0] : page == 1u ? pages->page[1] : page == 2u ? pages->page[2] : pages->page[3];
  words += texture->offset;
  uint texel = y * texture->width + x;
  uint format = texture->format;
  if (format == SUN_TEXEL_RGBA32F) {
    for (int c = 0; c < 4; c++) out[c] = as_float(words[4u * texel + (uint)c]);
  } else if (format == SUN_TEXEL_RGBA16F) {
    uint low = words[2u * texel], high = words[2u * texel + 1u];
    out[0] = float_of_half(low & 0xffffu);
    out[1] = float_of_half(low >> 16);
    out[2] = float_of_half(high & 0xffffu);
    out[3] = float_of_half(high >> 16);
  } else {
    uint word = words[texel];
    for (int c = 0; c < 4; c++) {
      uint byte = (word >> (8 * c)) & 255u;
      out[c] = (format == SUN_TEXEL_RGBA8_SRGB && c < 3) ? tables[SUN_TABLE_SRGB + byte] : (float)byte / 255.0f;
    }
  }
}

// A coordinate as a place within [0, 1]; NaN and infinity give 0.
SUN_FN float wrap_coordinate(float t, uint wrap) {
  if (wrap == SUN_WRAP_REPEAT) {
    t = t - floor_one(t);
  } else if (wrap == SUN_WRAP_MIRROR) {
    t = t - 2.0f * floor_one(t * 0.5f);
    t = t > 1.0f ? 2.0f - t : t;
  } else {
    t = t > 1.0f ? 1.0f : t;
  }
  return (t >= 0.0f && t <= 1.0f) ? t : 0.0f;
}

// The texels left and right of a place, and the weight of the right one.
SUN_FN float filter_coordinate(float t, uint size, uint wrap, uint *first, uint *second) {
  float x = t * (float)size - 0.5f;
  float below = floor_one(x);
  int lower = (int)below, upper = lower + 1, last = (int)size - 1;
  // Beyond an edge: the other edge where the texture repeats; the same texel again where it is mirrored or clamped.
  int before = wrap == SUN_WRAP_REPEAT ? last : 0, after = wrap == SUN_WRAP_REPEAT ? 0 : last;
  *first = (uint)(lower < 0 ? before : lower > last ? last : lower);
  *second = (uint)(upper > last ? after : upper);
  return x - below;
}

SUN_FN uint nearest_coordinate(float t, uint size) {
  uint i = (uint)(t * (float)size);
  return i < size ? i : size - 1u;
}

SUN_FN void sample_texture_lane(const TexturePages *pages, const SUN_GLOBAL Texture *texture, const SUN_GLOBAL float *tables, float u, float v,
                                float out[4]) {
  u = wrap_coordinate(u, texture->wrap_u);
  v = wrap_coordinate(v, texture->wrap_v);
  if (texture->linear == 0u) {
    fetch_texel(pages, texture, tables, nearest_coordinate(u, texture->width), nearest_coordinate(v, texture->height), out);
    return;
  }
  uint x0, x1, y0, y1;
  float fx = filter_coordinate(u, texture->width, texture->wrap_u, &x0, &x1);
  float fy = filter_coordinate(v, texture->height, texture->wrap_v, &y0, &y1);
  float corner[4][4];
  fetch_texel(pages, texture, tables, x0, y0, corner[0]);
  fetch_texel(pages, texture, tables, x1, y0, corner[1]);
  fetch_texel(pages, texture, tables, x0, y1, corner[2]);
  fetch_texel(pages, texture, tables, x1, y1, corner[3]);
  for (int c = 0; c < 4; c++) {
    float top = corner[0][c] + (corner[1][c] - corner[0][c]) * fx;
    float bottom = corner[2][c] + (corner[3][c] - corner[2][c]) * fx;
    out[c] = top + (bottom - top) * fy;
  }
}

// `texture` has to be an index of `textures` in wanted lanes; the others give 1.
SUN_FN Texel4 sample_texture(const TexturePages *pages, const SUN_GLOBAL Texture *textures, const SUN_GLOBAL float *tables, uint_n texture, real u,
                             real v, mask wanted) {
  uint at[LANES];
  int want[LANES];
  float lane_u[LANES], lane_v[LANES], value[4][LANES];
  LANES_STORE(texture, at);
  LANES_STORE(wanted, want);
  LANES_STORE(u, lane_u);
  LANES_STORE(v, lane_v);
  for (int lane = 0; lane < LANES; lane++) {
    float texel[4] = {1.0f, 1.0f, 1.0f, 1.0f};
    if (want[lane]) sample_texture_lane(pages, textures + at[lane], tables, lane_u[lane], lane_v[lane], texel);
    for (int c = 0; c < 4; c++) value[c][lane] = texel[c];
  }
  Texel4 out;
  out.r = LANES_LOAD(value[0]);
  out.g = LANES_LOAD(value[1]);
  out.b = LANES_LOAD(value[2]);
  out.a = LANES_LOAD(value[3]);
  return out;
}

// What a material's slot shows at these coordinates of the two sets: 1 where it has no texture (ref is SUN_NONE) and in lanes that are not wanted.
SUN_FN Texel4 sample_slot(const TexturePages *pages, const SUN_GLOBAL Texture *textures, const SUN_GLOBAL TextureRef *refs,
                          const SUN_GLOBAL float *tables, uint_n ref, const real *uv0, const real *uv1, mask wanted) {
  mask some = wanted & (ref != (uint_n)(SUN_NONE));
  Texel4 out;
  out.r = out.g = out.b = out.a = (real)(1.0f);
  if (!ANY(some)) return out;
  uint at[LANES], texture[LANES];
  int want[LANES];
  float u[LANES], v[LANES], other_u[LANES], other_v[LANES];
  LANES_STORE(ref, at);
  LANES_STORE(some, want);
  LANES_STORE(uv0[0], u);
  LANES_STORE(uv0[1], v);
  LANES_STORE(uv1[0], other_u);
  LANES_STORE(uv1[1], other_v);
  for (int lane = 0; lane < LANES; lane++) {
    texture[lane] = 0u;
    if (!want[lane]) continue;
    const SUN_GLOBAL TextureRef *r = refs + at[lane];
    float s = r->uv_set == 0u ? u[lane] : other_u[lane], t = r->uv_set == 0u ? v[lane] : other_v[lane];
    texture[lane] = r->texture;
    u[lane] = r->m[0] * s + r->m[1] * t + r->m[2];
    v[lane] = r->m[3] * s + r->m[4] * t + r->m[5];
  }
  return sample_texture(pages, textures, tables, LANES_LOAD(texture), LANES_LOAD(u), LANES_LOAD(v), some);
}

SUN_NAMESPACE_END
#endif
