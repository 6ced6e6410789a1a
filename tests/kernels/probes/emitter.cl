// SPDX-License-Identifier: Apache-2.0
// scene/texture.h and scene/emitter.h, asked by LANES items at once: 16 reals an item, in rows of `count`.
#include "scene/emitter.h"
#include "scene/texture.h"

SUN_KERNEL void probe_emitter(__global float *out, __global const float *numbers, uint count, uint emitter_count, __global const uint *page,
                              __global const Texture *textures, __global const TextureRef *refs, __global const float *tables,
                              __global const Emitter *emitters, __global const Light *lights, __global const Environment *environment,
                              __global const float *texels, __global const float *cdf) {
  uint first = (uint)get_global_id(0) * LANES;
  if (first >= count) return;
  uint_n item = uint_of_int((int_n)((int)first) + LANE_NUMBERS);
  real u0 = gather_real(numbers, item), u1 = gather_real(numbers, item + (uint_n)(count));
  TexturePages pages;
  for (int i = 0; i < SUN_TEXTURE_PAGES; i++) pages.page[i] = page;
  real uv[2];
  uv[0] = u0 * 6.0f - 3.0f;
  uv[1] = u1 * 6.0f - 3.0f;
  uint_n odd = item & (uint_n)(1);  // one slot or the other
  Texel4 texel = sample_slot(&pages, textures, refs, tables, odd, uv, uv, (item & (uint_n)(6)) != (uint_n)(6));
  EmitterChoice choice = choose_emitter(emitters, emitter_count, u0);
  vec3 place = make_vec3(uv[0], uv[1], u0 + u1);
  LightSample light = light_sample(lights, item % (uint_n)(3), place);
  EnvironmentSample sky = environment_sample(environment, cdf, u0, u1);
  vec3 radiance = environment_radiance(environment, texels, sky.direction);
  real value[16];
  value[0] = texel.r;
  value[1] = texel.g;
  value[2] = texel.b;
  value[3] = texel.a;
  value[4] = real_of_uint(choice.index);
  value[5] = choice.pmf;
  value[6] = light.direction.x;
  value[7] = light.distance;
  value[8] = light.radiance.y;
  value[9] = sky.direction.x;
  value[10] = sky.direction.y;
  value[11] = sky.direction.z;
  value[12] = sky.pdf;
  value[13] = radiance.x;
  value[14] = radiance.z;
  value[15] = environment_pdf(environment, cdf, normalize3(place));
  for (uint k = 0; k < 16; k++) {
    float lane[LANES];
    LANES_STORE(value[k], lane);
    for (uint i = 0; i < LANES; i++) out[k * count + first + i] = lane[i];
  }
}
