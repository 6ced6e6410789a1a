// SPDX-License-Identifier: Apache-2.0
// Choosing an emitter, and the emitters that are no surfaces: punctual lights and the environment. Points on emissive triangles need surfaces:
// transport/direct.h. Sample numbers are whole multiples of 2^-24 below 1; the tables are built so that what is chosen has exactly the chance that is
// stated.
#ifndef SUN_SCENE_EMITTER_H
#define SUN_SCENE_EMITTER_H
#include "math/elementary.h"
#include "math/record.h"
#include "math/vector.h"
#include "math/warp.h"
#include "shared/emitter.h"

SUN_NAMESPACE_BEGIN

#define SUN_BEYOND 3.40282347e38f  // distance of what has no place

// The high and the low word of 2^8 * k * n, with k below 2^24: the slot, and the fraction that is left.
#ifdef __cplusplus
SUN_FN uint multiply_high(uint a, uint b) { return (uint)(((ulong)a * b) >> 32); }
#else
#define multiply_high(a, b) mul_hi(a, b)
#endif

typedef struct EmitterChoice {
  uint_n index, kind, a, b;  // as in Emitter
  real pmf;
} EmitterChoice;

// Alias method [Walker77; Vose91]. count > 0. Takes one number; all arithmetic is exact.
SUN_FN EmitterChoice choose_emitter(const SUN_GLOBAL Emitter *emitters, uint count, real u) {
  uint_n scaled = uint_of_int(int_of_real(u * 16777216.0f)) << 8;
  uint_n slot = multiply_high(scaled, (uint_n)(count));
  uint_n rest = scaled * (uint_n)(count);
  real fraction = real_of_uint(rest >> 8) * 5.96046448e-8f;
  Quad quad;
  GATHER_QUAD(quad, emitters, slot, threshold);
  EmitterChoice choice;
  choice.index = fraction < real_of_bits(quad.x) ? slot : quad.y;
  GATHER_QUAD(quad, emitters, choice.index, kind);
  choice.kind = quad.x;
  choice.a = quad.y;
  choice.b = quad.z;
  choice.pmf = real_of_bits(quad.w);
  return choice;
}

// Light leaves a point evenly to all sides, and a spot evenly within its cone: the density by solid angle.
SUN_FN real light_cone_height(uint_n kind, real cos_outer) { return kind == (uint_n)(SUN_LIGHT_SPOT) ? max_real(1.0f - cos_outer, (real)(1e-6f)) : (real)(2.0f); }
SUN_FN real light_cone_pdf(uint_n kind, real cos_outer) { return SUN_INV_TWO_PI / light_cone_height(kind, cos_outer); }

// What a punctual light sends to a point (KHR_lights_punctual).
typedef struct LightSample {
  vec3 direction;  // to the light, unit length
  real distance;   // SUN_BEYOND for directional lights
  vec3 radiance;   // irradiance on a surface that faces the light; 0 outside a spot's cone
  real spread;     // density by solid angle with which emission_of_light sends light here; 1 for directional lights, whose density is by area
} LightSample;

// LANES records.
typedef struct LightLanes {
  uint_n kind, keys;  // where its keys stand; 0: it is still
  vec3 place, axis, intensity;
  real cos_outer, cos_inner;
} LightLanes;

SUN_FN LightLanes load_lights(const SUN_GLOBAL Light *lights, uint_n light) {
  uint at[LANES], lane_kind[LANES];
  float field[11][LANES];
  LANES_STORE(light, at);
  for (int lane = 0; lane < LANES; lane++) {
    const SUN_GLOBAL Light *l = lights + at[lane];
    SUN_UNROLL
    for (int c = 0; c < 3; c++) {
      field[c][lane] = l->position[c];
      field[3 + c][lane] = l->direction[c];
      field[6 + c][lane] = l->intensity[c];
    }
    field[9][lane] = l->cos_outer;
    field[10][lane] = l->cos_inner;
    lane_kind[lane] = l->kind;
  }
  LightLanes lanes;
  lanes.kind = LANES_LOAD(lane_kind);
  lanes.keys = lanes.kind >> (uint_n)(SUN_LIGHT_KEYS_SHIFT);
  lanes.kind = lanes.kind & (uint_n)(SUN_LIGHT_KIND);
  lanes.place = make_vec3(LANES_LOAD(field[0]), LANES_LOAD(field[1]), LANES_LOAD(field[2]));
  lanes.axis = make_vec3(LANES_LOAD(field[3]), LANES_LOAD(field[4]), LANES_LOAD(field[5]));
  lanes.intensity = make_vec3(LANES_LOAD(field[6]), LANES_LOAD(field[7]), LANES_LOAD(field[8]));
  lanes.cos_outer = LANES_LOAD(field[9]);
  lanes.cos_inner = LANES_LOAD(field[10]);
  return lanes;
}

// One record for all lanes.
SUN_FN LightLanes load_light(const SUN_GLOBAL Light *lights, uint light) {
  const SUN_GLOBAL Light *l = lights + light;
  LightLanes lanes;
  lanes.kind = (uint_n)(l->kind & SUN_LIGHT_KIND);
  lanes.keys = (uint_n)(l->kind >> SUN_LIGHT_KEYS_SHIFT);
  lanes.place = make_vec3((real)(l->position[0]), (real)(l->position[1]), (real)(l->position[2]));
  lanes.axis = make_vec3((real)(l->direction[0]), (real)(l->direction[1]), (real)(l->direction[2]));
  lanes.intensity = make_vec3((real)(l->intensity[0]), (real)(l->intensity[1]), (real)(l->intensity[2]));
  lanes.cos_outer = (real)(l->cos_outer);
  lanes.cos_inner = (real)(l->cos_inner);
  return lanes;
}

// Share of a spot's intensity that leaves under this cosine to its axis: the ramp between the cosines of its angles, squared; a ramp narrower than 0.001
// counts as that. 1 for other lights.
SUN_INLINE real spot_share(const LightLanes *l, real cosine) {
  if (!ANY(l->kind == (uint_n)(SUN_LIGHT_SPOT))) return (real)(1.0f);
  real ramp = (cosine - l->cos_outer) / max_real(l->cos_inner - l->cos_outer, (real)(0.001f));
  ramp = clamp_real(ramp, (real)(0.0f), (real)(1.0f));
  return l->kind == (uint_n)(SUN_LIGHT_SPOT) ? ramp * ramp : (real)(1.0f);
}

SUN_INLINE LightSample sample_of_light(const LightLanes *lanes, vec3 position) {
  LightLanes l = *lanes;
  mask placed = l.kind != (uint_n)(SUN_LIGHT_DIRECTIONAL);
  vec3 to = sub3(l.place, position);
  real squared = dot3(to, to);
  mask apart = squared > 0.0f;
  real safe = apart ? squared : (real)(1.0f);
  real distance = sqrt(safe), inverse = 1.0f / distance;
  LightSample sample;
  sample.direction = select3(placed, scale3(to, inverse), negate3(l.axis));
  sample.distance = placed ? (apart ? distance : (real)(0.0f)) : (real)(SUN_BEYOND);
  real factor = spot_share(&l, -dot3(sample.direction, l.axis));
  factor = placed ? (apart ? factor * (inverse * inverse) : (real)(0.0f)) : factor;
  sample.radiance = scale3(l.intensity, factor);
  sample.spread = placed ? light_cone_pdf(l.kind, l.cos_outer) : (real)(1.0f);
  return sample;
}

SUN_FN LightSample light_sample(const SUN_GLOBAL Light *lights, uint_n light, vec3 position) {
  LightLanes l = load_lights(lights, light);
  return sample_of_light(&l, position);
}

// Light that leaves a punctual light.
typedef struct LightEmission {
  vec3 origin, direction;
  vec3 intensity;  // in that direction; irradiance of directional lights
  real pdf;        // by solid angle
  mask far;        // directional: no origin, one direction
} LightEmission;

SUN_FN LightEmission emission_of_light(const LightLanes *lanes, vec2 u) {
  LightLanes l = *lanes;
  LightEmission e;
  e.far = l.kind == (uint_n)(SUN_LIGHT_DIRECTIONAL);
  vec3 within = square_to_cone(u, light_cone_height(l.kind, l.cos_outer));
  Frame3 about = frame_of_normal(l.axis);
  e.direction = select3(e.far, l.axis, normalize3(to_world(&about, within)));
  e.origin = l.place;
  real factor = spot_share(&l, dot3(e.direction, l.axis));
  e.intensity = scale3(l.intensity, factor);
  e.pdf = light_cone_pdf(l.kind, l.cos_outer);
  return e;
}

// Equirectangular coordinates of a unit direction: u wraps and is not reduced, v lies in [0, 1]. `sine` is that of the angle from +y.
SUN_FN vec2 environment_uv(const SUN_GLOBAL Environment *environment, vec3 direction, real *sine) {
  *sine = sqrt(direction.x * direction.x + direction.z * direction.z);
  real u = 0.5f + atan2_real(direction.z, direction.x) * SUN_INV_TWO_PI + environment->rotation;
  real v = atan2_real(*sine, direction.y) * SUN_INV_PI;  // acos(y), without its loss of digits about the poles
  return make_vec2(u - floor(u), clamp_real(v, (real)(0.0f), (real)(1.0f)));
}

SUN_FN vec3 environment_texel(const SUN_GLOBAL Environment *environment, const SUN_GLOBAL float *texels, int_n x, int_n y) {
  uint_n at = (uint_of_int(y) * (uint_n)(environment->width) + uint_of_int(x)) * (uint_n)(3);
  return make_vec3(gather_real(texels, at), gather_real(texels, at + (uint_n)(1)), gather_real(texels, at + (uint_n)(2)));
}

// Radiance that arrives along a ray which leaves the scene in this unit direction.
SUN_FN vec3 environment_radiance(const SUN_GLOBAL Environment *environment, const SUN_GLOBAL float *texels, vec3 direction) {
  if (environment->kind == SUN_ENVIRONMENT_NONE) return splat3((real)(0.0f));
  if (environment->kind == SUN_ENVIRONMENT_CONSTANT)
    return make_vec3((real)(environment->radiance[0]), (real)(environment->radiance[1]), (real)(environment->radiance[2]));
  real sine;
  vec2 uv = environment_uv(environment, direction, &sine);
  real x = uv.x * (float)environment->width - 0.5f, y = uv.y * (float)environment->height - 0.5f;
  real below_x = floor(x), below_y = floor(y);
  int_n x0 = int_of_real(below_x), y0 = int_of_real(below_y);
  int_n x1 = x0 + 1, y1 = y0 + 1;
  int_n width = (int_n)((int)environment->width), last = (int_n)((int)environment->height - 1);
  x0 = x0 < 0 ? x0 + width : x0;
  x1 = x1 >= width ? x1 - width : x1;
  y0 = y0 < 0 ? (int_n)(0) : y0;
  y1 = y1 > last ? last : y1;
  vec3 top = lerp3(environment_texel(environment, texels, x0, y0), environment_texel(environment, texels, x1, y0), x - below_x);
  vec3 bottom = lerp3(environment_texel(environment, texels, x0, y1), environment_texel(environment, texels, x1, y1), x - below_x);
  return lerp3(top, bottom, y - below_y);
}

// The last cell of n whose lower bound in `cdf` (from `base`) is at most u. It is never one of chance 0.
SUN_FN uint_n find_cell(const SUN_GLOBAL float *cdf, uint_n base, uint n, real u) {
  uint_n cell = (uint_n)(0);
  while (n > 1u) {
    uint step = n >> 1;
    uint_n middle = cell + (uint_n)(step);
    cell = gather_real(cdf, base + middle) <= u ? middle : cell;
    n -= step;
  }
  return cell;
}

typedef struct EnvironmentSample {
  vec3 direction;
  real pdf;  // solid angle; 0 where there is no direction to be had
} EnvironmentSample;

#define SUN_UNIFORM_SPHERE_PDF 0.0795774715f
// 2 pi^2: what sin(theta) times the cells of a map of one texel cover.
#define SUN_TWO_PI_SQUARED 19.7392088f

SUN_FN EnvironmentSample environment_sample(const SUN_GLOBAL Environment *environment, const SUN_GLOBAL float *cdf, real u0, real u1) {
  EnvironmentSample sample;
  real sine, cosine, sine_theta;
  if (environment->kind != SUN_ENVIRONMENT_MAP) {
    real y = 1.0f - 2.0f * u0;
    sine_theta = sqrt_or_zero(1.0f - y * y);
    sin_cos(SUN_TWO_PI * u1, &sine, &cosine);
    sample.direction = make_vec3(sine_theta * cosine, y, sine_theta * sine);
    sample.pdf = (real)(environment->kind == SUN_ENVIRONMENT_CONSTANT ? SUN_UNIFORM_SPHERE_PDF : 0.0f);
    return sample;
  }
  uint width = environment->width, height = environment->height;
  uint_n row = find_cell(cdf, (uint_n)(0), height, u0);
  real row_lower = gather_real(cdf, row), row_chance = gather_real(cdf, row + (uint_n)(1)) - row_lower;
  uint_n base = (uint_n)(height + 1u) + row * (uint_n)(width + 1u);
  uint_n column = find_cell(cdf, base, width, u1);
  real column_lower = gather_real(cdf, base + column), column_chance = gather_real(cdf, base + column + (uint_n)(1)) - column_lower;
  real v = (real_of_uint(row) + (u0 - row_lower) / row_chance) / (float)height;
  real u = (real_of_uint(column) + (u1 - column_lower) / column_chance) / (float)width;
  sin_cos(SUN_TWO_PI * (u - 0.5f - environment->rotation), &sine, &cosine);
  sin_cos(SUN_PI * v, &sine_theta, &sample.direction.y);
  sample.direction.x = sine_theta * cosine;
  sample.direction.z = sine_theta * sine;
  mask usable = sine_theta > 0.0f;
  real pdf = row_chance * column_chance * ((float)width * (float)height) / (SUN_TWO_PI_SQUARED * (usable ? sine_theta : (real)(1.0f)));
  sample.pdf = usable ? pdf : (real)(0.0f);
  return sample;
}

// The solid-angle pdf with which environment_sample gives a unit direction.
SUN_FN real environment_pdf(const SUN_GLOBAL Environment *environment, const SUN_GLOBAL float *cdf, vec3 direction) {
  if (environment->kind != SUN_ENVIRONMENT_MAP) return (real)(environment->kind == SUN_ENVIRONMENT_CONSTANT ? SUN_UNIFORM_SPHERE_PDF : 0.0f);
  uint width = environment->width, height = environment->height;
  real sine;
  vec2 uv = environment_uv(environment, direction, &sine);
  uint_n column = uint_of_int(int_of_real(uv.x * (float)width)), row = uint_of_int(int_of_real(uv.y * (float)height));
  column = column < (uint_n)(width) ? column : (uint_n)(width - 1u);
  row = row < (uint_n)(height) ? row : (uint_n)(height - 1u);
  uint_n base = (uint_n)(height + 1u) + row * (uint_n)(width + 1u);
  real row_chance = gather_real(cdf, row + (uint_n)(1)) - gather_real(cdf, row);
  real column_chance = gather_real(cdf, base + column + (uint_n)(1)) - gather_real(cdf, base + column);
  mask usable = sine > 0.0f;
  real pdf = row_chance * column_chance * ((float)width * (float)height) / (SUN_TWO_PI_SQUARED * (usable ? sine : (real)(1.0f)));
  return usable ? pdf : (real)(0.0f);
}

SUN_NAMESPACE_END
#endif
