// SPDX-License-Identifier: Apache-2.0
// bsdf_lobes, lobes_eval and lobes_sample of LANES inputs a work item. in: 22 columns of `count` floats, out: 18 columns.
#include "bsdf/bsdf.h"

#define IN(column) LANES_LOAD(in + (column) * count + at)
#define OUT(column, value) LANES_STORE((value), out + (column) * count + at)

SUN_KERNEL void bsdf(uint count, __global const float *tables, __global const float *in, __global float *out) {
  const uint at = (uint)get_global_id(0) * LANES;
  if (at + LANES > count) return;
  const real zero = (real)(0.0f), one = (real)(1.0f);
  Bsdf b;
  b.base = make_vec3(IN(0), IN(1), IN(2));
  b.metallic = IN(3);
  b.alpha = IN(4);
  b.f0 = make_vec3(IN(5), IN(6), IN(7));
  b.f90 = IN(8);
  b.transmission = IN(9);
  b.eta = IN(10);
  b.solid = IN(11) > 0.0f;
  b.inside = b.eta < 1.0f;
  b.specular = IN(12) > 0.0f;
  const vec3 wo = make_vec3(IN(13), IN(14), IN(15)), wi = make_vec3(IN(16), IN(17), IN(18));
  Lobes lobes = bsdf_lobes(&b, tables, wo);
  BsdfEval e = lobes_eval(&lobes, tables, wo, wi);
  BsdfSample s = lobes_sample(&lobes, tables, wo, IN(19), IN(20), IN(21));
  vec3 albedo = bsdf_albedo(&b, tables, wo), straight = bsdf_straight(&b, wo);
  OUT(0, e.f_cos.x);
  OUT(1, e.f_cos.y);
  OUT(2, e.f_cos.z);
  OUT(3, e.pdf);
  OUT(4, s.wi.x);
  OUT(5, s.wi.y);
  OUT(6, s.wi.z);
  OUT(7, s.weight.x);
  OUT(8, s.weight.y);
  OUT(9, s.weight.z);
  OUT(10, s.pdf);
  OUT(11, (s.delta ? one : zero) + (s.valid ? 2.0f * one : zero) + (s.transmitted ? 4.0f * one : zero));
  OUT(12, albedo.x);
  OUT(13, albedo.y);
  OUT(14, albedo.z);
  OUT(15, straight.x);
  OUT(16, straight.y);
  OUT(17, straight.z);
}
