// SPDX-License-Identifier: Apache-2.0
// trace: rays from an array, for tests and the bench. The integrators' rays are traced by intersect.cl and occlude.cl, over the same two functions.
//   reads    rays (float8: origin, t_max, direction, passed_t), passed (uint2: instance, primitive), the scene at one time of the shutter
//   writes   hits; or blocked (1 or 0)
#include "scene/traverse.h"

static Ray load_ray(__global const float8 *rays, __global const uint2 *passed, float time, uint i) {
  const float8 r = rays[i];
  const uint2 p = passed[i];
  Ray ray;
  ray.origin[0] = r.s0;
  ray.origin[1] = r.s1;
  ray.origin[2] = r.s2;
  ray.t_max = r.s3;
  ray.direction[0] = r.s4;
  ray.direction[1] = r.s5;
  ray.direction[2] = r.s6;
  ray.passed_t = r.s7;
  ray.passed_instance = p.s0;
  ray.passed_primitive = p.s1;
  ray.time = time;
  return ray;
}

SUN_BODY void trace_closest_ray(__global const float8 *rays, __global const uint2 *passed, __global Hit *hits, uint want, TREE_PARAMETERS,
                                __global const Instance *instances, uint instance_count, uint plane_count, float time, uint i) {
  const TraceScene scene = make_trace_scene(TREE_ARGUMENTS, instances, instance_count, plane_count);
  hits[i] = closest_hit(&scene, load_ray(rays, passed, time, i), want);
}

SUN_BODY void trace_any_ray(__global const float8 *rays, __global const uint2 *passed, __global uint *blocked, uint want, TREE_PARAMETERS,
                            __global const Instance *instances, uint instance_count, uint plane_count, float time, uint i) {
  const TraceScene scene = make_trace_scene(TREE_ARGUMENTS, instances, instance_count, plane_count);
  blocked[i] = any_hit(&scene, load_ray(rays, passed, time, i), want) ? 1u : 0u;
}

SUN_TRACE_KERNEL void trace_closest(__global const float8 *rays, __global const uint2 *passed, __global Hit *hits, uint count, uint want,
                                    TREE_PARAMETERS, __global const Instance *instances, uint instance_count, uint plane_count, float time) {
  const uint i = (uint)get_global_id(0);
  if (i < count) trace_closest_ray(rays, passed, hits, want, TREE_ARGUMENTS, instances, instance_count, plane_count, time, i);
}

SUN_TRACE_KERNEL void trace_any(__global const float8 *rays, __global const uint2 *passed, __global uint *blocked, uint count, uint want,
                                TREE_PARAMETERS, __global const Instance *instances, uint instance_count, uint plane_count, float time) {
  const uint i = (uint)get_global_id(0);
  if (i < count) trace_any_ray(rays, passed, blocked, want, TREE_ARGUMENTS, instances, instance_count, plane_count, time, i);
}
