// SPDX-License-Identifier: Apache-2.0
// scene/trace_lanes.h, asked by LANES rays at once; buffers as stages/trace.cl has them.
#include "scene/trace_lanes.h"

SUN_BODY void probe_bundle(const SUN_GLOBAL Frame *frame, __global const float *rays, __global const uint *passed, __global Hit *hits, __global uint *blocked, uint count,
                           uint want, TREE_PARAMETERS, const SUN_GLOBAL Instance *instances, uint first) {
  TraceScene tree = make_trace_scene(TREE_ARGUMENTS, instances, frame->instance_count, frame->plane_count);
  uint_n number = (uint_n)(first) + uint_of_int((int_n)(LANE_NUMBERS));
  mask on = number < (uint_n)(count);
  uint_n at = on ? number : (uint_n)(0), ray_at = at * (uint_n)(8), passed_at = at * (uint_n)(2);
  Rays all;
  all.origin = make_vec3(gather_real(rays, ray_at), gather_real(rays + 1, ray_at), gather_real(rays + 2, ray_at));
  all.t_max = gather_real(rays + 3, ray_at);
  all.direction = make_vec3(gather_real(rays + 4, ray_at), gather_real(rays + 5, ray_at), gather_real(rays + 6, ray_at));
  all.passed_t = gather_real(rays + 7, ray_at);
  all.passed_instance = gather_uint(passed, passed_at);
  all.passed_primitive = gather_uint(passed + 1, passed_at);
  all.time = (real)(0.0f);
  HitLanes hit = closest_lanes(frame, &tree, &all, on, want);
  mask met = blocked_lanes(frame, &tree, &all, on, want);
  float t[LANES], u[LANES], v[LANES];
  uint instance[LANES], primitive[LANES];
  int some[LANES], any_one[LANES];
  int_n found = hit.hit ? (int_n)(1) : (int_n)(0), stopped = met ? (int_n)(1) : (int_n)(0);
  LANES_STORE(hit.t, t);
  LANES_STORE(hit.u, u);
  LANES_STORE(hit.v, v);
  LANES_STORE(hit.instance, instance);
  LANES_STORE(hit.primitive, primitive);
  LANES_STORE(found, some);
  LANES_STORE(stopped, any_one);
  for (uint lane = 0; lane < LANES && first + lane < count; lane++) {
    Hit out;
    out.t = t[lane];
    out.u = some[lane] ? u[lane] : 0.0f;
    out.v = some[lane] ? v[lane] : 0.0f;
    out.instance = some[lane] ? instance[lane] : SUN_NONE;
    out.primitive = some[lane] ? primitive[lane] : SUN_NONE;
    out.pad[0] = out.pad[1] = out.pad[2] = 0;
    hits[first + lane] = out;
    blocked[first + lane] = (uint)any_one[lane];
  }
}

SUN_TRACE_KERNEL void probe_lanes(const SUN_GLOBAL Frame *frame, __global const float *rays, __global const uint *passed, __global Hit *hits, __global uint *blocked,
                                  uint count, uint want, TREE_PARAMETERS, const SUN_GLOBAL Instance *instances) {
  const uint first = (uint)get_global_id(0) * LANES;
  if (first < count) probe_bundle(frame, rays, passed, hits, blocked, count, want, TREE_ARGUMENTS, instances, first);
}
