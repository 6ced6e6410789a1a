// SPDX-License-Identifier: Apache-2.0
// Textures from pages of plain buffers: wrapping, filtering and decoding in defined arithmetic, LANES at once. Records and words are read once where all
// lanes ask for the same.
#ifndef SUN_SCENE_TEXTURE_H
#define SUN_SCENE_TEXTURE_H
#include "math/record.h"
#include "shared/tables.h"
#include "shared/texture.h"

// Looked up in one function where lanes are sorted by shape, for speed; elsewhere as the compiler likes: textured kernels would take a third longer to compile.
#if SUN_FEW_SHAPES
#define SUN_TEXEL_FN SUN_INLINE
#else
#define SUN_TEXEL_FN SUN_FN
#endif

SUN_NAMESPACE_BEGIN

typedef struct TexturePages {
  const SUN_GLOBAL uint *page[SUN_TEXTURE_PAGES];
} TexturePages;

typedef struct Texel4 {
  real r, g, b, a;
} Texel4;

// A half in the low 16 bits, by integer operations and one exact product.
SUN_FN real float_of_half(uint_n half_bits) {
  uint_n sign = (half_bits & (uint_n)(0x8000u)) << 16;
  uint_n exponent = (half_bits >> 10) & (uint_n)(31u);
  uint_n mantissa = half_bits & (uint_n)(0x3ffu);
  real subnormal = real_of_uint(mantissa) * 5.96046448e-8f;  // 2^-24
  uint_n top = exponent == (uint_n)(31u) ? (uint_n)(255u) : exponent + (uint_n)(112u);
  real normal = real_of_bits((top << 23) | (mantissa << 13));
  real magnitude = exponent == (uint_n)(0u) ? subnormal : normal;
  return sign != (uint_n)(0u) ? -magnitude : magnitude;
}

// Picked by comparisons: an index into an array of pointers would put it into memory.
SUN_FN const SUN_GLOBAL uint *page_of(const TexturePages *pages, uint page) {
  return page == 0u ? pages->page[0] : page == 1u ? pages->page[1] : page == 2u ? pages->page[2] : pages->page[3];
}

SUN_TEXEL_FN uint_n fetch_words(const TexturePages *pages, uint_n page, uint_n at) {
  const uint first = FIRST_LANE(page);
  if (ALL(page == (uint_n)(first))) {
    const SUN_GLOBAL uint *words = page_of(pages, first);
    const uint place = FIRST_LANE(at);
    if (ALL(at == (uint_n)(place))) return (uint_n)(words[place]);
    return gather_uint(words, at);
  }
  uint lane_page[LANES], lane_at[LANES], value[LANES];
  LANES_STORE(page, lane_page);
  LANES_STORE(at, lane_at);
  for (int lane = 0; lane < LANES; lane++) value[lane] = page_of(pages, lane_page[lane])[lane_at[lane]];
  return LANES_LOAD(value);
}

// byte / 255, rounded as the quotient is: the product, and what it lacks (tests/host/flatten/textures_test.cpp: all 256).
SUN_FN real level_of_byte(uint_n byte) {
  const real value = real_of_uint(byte), near = value * 0.00392156886f;
  return fma(fma(near, (real)(-255.0f), value), (real)(0.00392156886f), near);
}

// `alike`: all lanes have the same byte.
SUN_FN real decode_byte(const SUN_GLOBAL float *tables, uint_n byte, mask srgb, int alike) {
  real level = level_of_byte(byte);
  if (!ANY(srgb)) return level;
  const SUN_GLOBAL float *curve = tables + SUN_TABLE_SRGB;
  return srgb ? (alike ? (real)(curve[FIRST_LANE(byte)]) : gather_real(curve, byte)) : level;
}

// LANES records.
typedef struct TextureLanes {
  uint_n page, offset, width, height, format, wrap_u, wrap_v, linear;
} TextureLanes;

// Texels, decoded. x and y are inside.
SUN_TEXEL_FN Texel4 fetch_texels(const TexturePages *pages, const TextureLanes *texture, const SUN_GLOBAL float *tables, uint_n x, uint_n y) {
  const uint_n texel = y * texture->width + x, low_byte = (uint_n)(255u), low_half = (uint_n)(0xffffu);
  const mask full = texture->format == (uint_n)(SUN_TEXEL_RGBA32F), half_size = texture->format == (uint_n)(SUN_TEXEL_RGBA16F), bytes = !(full | half_size);
  Texel4 out;
  out.r = out.g = out.b = out.a = (real)(0.0f);
  if (ANY(bytes)) {
    const uint_n word = fetch_words(pages, texture->page, texture->offset + (bytes ? texel : (uint_n)(0u)));
    const mask srgb = texture->format == (uint_n)(SUN_TEXEL_RGBA8_SRGB);
    const int alike = ALL(word == (uint_n)(FIRST_LANE(word)));
    out.r = decode_byte(tables, word & low_byte, srgb, alike);
    out.g = decode_byte(tables, (word >> 8) & low_byte, srgb, alike);
    out.b = decode_byte(tables, (word >> 16) & low_byte, srgb, alike);
    out.a = level_of_byte(word >> 24);
  }
  if (ANY(half_size)) {
    const uint_n at = texture->offset + (half_size ? (uint_n)(2u) * texel : (uint_n)(0u));
    const uint_n low = fetch_words(pages, texture->page, at), high = fetch_words(pages, texture->page, at + (half_size ? (uint_n)(1u) : (uint_n)(0u)));
    out.r = half_size ? float_of_half(low & low_half) : out.r;
    out.g = half_size ? float_of_half(low >> 16) : out.g;
    out.b = half_size ? float_of_half(high & low_half) : out.b;
    out.a = half_size ? float_of_half(high >> 16) : out.a;
  }
  if (ANY(full)) {
    const uint_n at = texture->offset + (full ? (uint_n)(4u) * texel : (uint_n)(0u)), next = full ? (uint_n)(1u) : (uint_n)(0u);
    out.r = full ? real_of_bits(fetch_words(pages, texture->page, at)) : out.r;
    out.g = full ? real_of_bits(fetch_words(pages, texture->page, at + next)) : out.g;
    out.b = full ? real_of_bits(fetch_words(pages, texture->page, at + (uint_n)(2u) * next)) : out.b;
    out.a = full ? real_of_bits(fetch_words(pages, texture->page, at + (uint_n)(3u) * next)) : out.a;
  }
  return out;
}

// A coordinate as a place within [0, 1]; NaN and infinity give 0.
SUN_FN real wrap_coordinate(real t, uint_n wrap) {
  const mask mirrors = wrap == (uint_n)(SUN_WRAP_MIRROR);
  real wrapped = wrap == (uint_n)(SUN_WRAP_REPEAT) ? t - floor(t) : t > 1.0f ? (real)(1.0f) : t;
  if (ANY(mirrors)) {
    const real pair = t - 2.0f * floor(t * 0.5f);
    wrapped = mirrors ? (pair > 1.0f ? 2.0f - pair : pair) : wrapped;
  }
  return ((wrapped >= 0.0f) & (wrapped <= 1.0f)) ? wrapped : (real)(0.0f);
}

// The texels left and right of a place, and the weight of the right one.
SUN_FN real filter_coordinate(real t, uint_n size, uint_n wrap, uint_n *first, uint_n *second) {
  const real x = t * real_of_uint(size) - 0.5f, below = floor(x);
  const int_n zero = (int_n)(0), lower = int_of_real(below), upper = lower + 1, last = int_of_uint(size) - 1;
  // Beyond an edge: the other edge where the texture repeats; the same texel again where it is mirrored or clamped.
  const mask repeats = wrap == (uint_n)(SUN_WRAP_REPEAT);
  const int_n before = repeats ? last : zero, after = repeats ? zero : last;
  *first = uint_of_int(lower < 0 ? before : lower > last ? last : lower);
  *second = uint_of_int(upper > last ? after : upper);
  return x - below;
}

SUN_FN uint_n nearest_coordinate(real t, uint_n size) {
  const uint_n i = uint_of_int(int_of_real(t * real_of_uint(size)));
  return i < size ? i : size - (uint_n)(1u);
}

SUN_FN real bilinear(real top_left, real top_right, real bottom_left, real bottom_right, real x, real y) {
  const real top = top_left + (top_right - top_left) * x, bottom = bottom_left + (bottom_right - bottom_left) * x;
  return top + (bottom - top) * y;
}

// `texture` has to be an index of `textures` in all lanes; `alike`: all are `first`. Lanes that are not wanted give 1.
SUN_TEXEL_FN Texel4 sample_textures(const TexturePages *pages, const SUN_GLOBAL Texture *textures, const SUN_GLOBAL float *tables, uint_n texture, int alike,
                              uint first, real u, real v, mask wanted) {
  Quad place, look;
  RECORD_QUAD(place, alike, first, textures, texture, page);
  RECORD_QUAD(look, alike, first, textures, texture, format);
  const TextureLanes records = {place.x, place.y, place.z, place.w, look.x, look.y, look.z, look.w};
  const mask linear = wanted & (records.linear != (uint_n)(0u));
  u = wrap_coordinate(u, records.wrap_u);
  v = wrap_coordinate(v, records.wrap_v);
  Texel4 out;
  out.r = out.g = out.b = out.a = (real)(1.0f);
  if (ANY(wanted & !linear)) out = fetch_texels(pages, &records, tables, nearest_coordinate(u, records.width), nearest_coordinate(v, records.height));
  if (ANY(linear)) {
    uint_n x0, x1, y0, y1;
    const real fx = filter_coordinate(u, records.width, records.wrap_u, &x0, &x1), fy = filter_coordinate(v, records.height, records.wrap_v, &y0, &y1);
    const Texel4 a = fetch_texels(pages, &records, tables, x0, y0), b = fetch_texels(pages, &records, tables, x1, y0);
    const Texel4 c = fetch_texels(pages, &records, tables, x0, y1), d = fetch_texels(pages, &records, tables, x1, y1);
    out.r = linear ? bilinear(a.r, b.r, c.r, d.r, fx, fy) : out.r;
    out.g = linear ? bilinear(a.g, b.g, c.g, d.g, fx, fy) : out.g;
    out.b = linear ? bilinear(a.b, b.b, c.b, d.b, fx, fy) : out.b;
    out.a = linear ? bilinear(a.a, b.a, c.a, d.a, fx, fy) : out.a;
  }
  out.r = wanted ? out.r : (real)(1.0f);
  out.g = wanted ? out.g : (real)(1.0f);
  out.b = wanted ? out.b : (real)(1.0f);
  out.a = wanted ? out.a : (real)(1.0f);
  return out;
}

// `texture` has to be an index of `textures` in wanted lanes, of which there is one.
SUN_FN Texel4 sample_texture(const TexturePages *pages, const SUN_GLOBAL Texture *textures, const SUN_GLOBAL float *tables, uint_n texture, real u,
                             real v, mask wanted) {
  const uint first = some_lane(wanted, texture);
  texture = wanted ? texture : (uint_n)(first);
  return sample_textures(pages, textures, tables, texture, ALL(texture == (uint_n)(first)), first, u, v, wanted);
}

// What a material's slot shows at these coordinates of the two sets: 1 where it has no texture (ref is SUN_NONE) and in lanes that are not wanted.
SUN_FN Texel4 sample_slot(const TexturePages *pages, const SUN_GLOBAL Texture *textures, const SUN_GLOBAL TextureRef *refs,
                          const SUN_GLOBAL float *tables, uint_n ref, const real *uv0, const real *uv1, mask wanted) {
  const mask some = wanted & (ref != (uint_n)(SUN_NONE));
  Texel4 out;
  out.r = out.g = out.b = out.a = (real)(1.0f);
  if (!ANY(some)) return out;
  const uint first = some_lane(some, ref);
  ref = some ? ref : (uint_n)(first);
  const int alike = ALL(ref == (uint_n)(first));
  Quad head, tail;
  RECORD_QUAD(head, alike, first, refs, ref, texture);
  RECORD_QUAD(tail, alike, first, refs, ref, m[2]);
  const mask set_0 = head.y == (uint_n)(0u);
  const real s = set_0 ? uv0[0] : uv1[0], t = set_0 ? uv0[1] : uv1[1];
  const real u = real_of_bits(head.z) * s + real_of_bits(head.w) * t + real_of_bits(tail.x);
  const real v = real_of_bits(tail.y) * s + real_of_bits(tail.z) * t + real_of_bits(tail.w);
  return sample_textures(pages, textures, tables, head.x, alike, FIRST_LANE(head.x), u, v, some);
}

// The same where all lanes ask for one: its record is read once, and nothing is sorted.
SUN_FN Texel4 sample_slot_alike(const TexturePages *pages, const SUN_GLOBAL Texture *textures, const SUN_GLOBAL TextureRef *refs,
                                const SUN_GLOBAL float *tables, uint ref, const real *uv0, const real *uv1, mask wanted) {
  Texel4 out;
  out.r = out.g = out.b = out.a = (real)(1.0f);
  if (ref == SUN_NONE) return out;
  const SUN_GLOBAL TextureRef *look = refs + ref;
  const uint set_0 = look->uv_set == 0u;
  const real s = set_0 ? uv0[0] : uv1[0], t = set_0 ? uv0[1] : uv1[1];
  const real u = look->m[0] * s + look->m[1] * t + look->m[2];
  const real v = look->m[3] * s + look->m[4] * t + look->m[5];
  return sample_textures(pages, textures, tables, (uint_n)(look->texture), 1, look->texture, u, v, wanted);
}

SUN_NAMESPACE_END
#endif
