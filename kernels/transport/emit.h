// SPDX-License-Identifier: Apache-2.0
// The first segment of a light subpath, from any emitter.
#ifndef SUN_TRANSPORT_EMIT_H
#define SUN_TRANSPORT_EMIT_H
#include "transport/direct.h"
#include "transport/vertex_weights.h"

SUN_NAMESPACE_BEGIN

typedef struct Emission {
  vec3 origin, direction;
  vec3 flux;         // radiance times cosine over the density of place and direction
  real dVCM, dVC, dVM;  // [Georgiev12 eq. 31, 32], without what waits for the first hit
  mask pointed;      // from a light without extent
  mask far;          // from infinitely far: a disk across the scene stands for it
  mask valid;
} Emission;

// From a disk that covers the scene, against `to`, the direction there.
SUN_FN vec3 disk_origin(const SUN_GLOBAL Frame *frame, vec3 to, vec2 u) {
  Frame3 across = frame_of_normal(to);
  vec2 disk = square_to_disk(u);
  vec3 center = make_vec3((real)(frame->scene_center[0]), (real)(frame->scene_center[1]), (real)(frame->scene_center[2]));
  vec3 offset = add3(add3(scale3(across.tangent, disk.x), scale3(across.bitangent, disk.y)), to);
  return add3(center, scale3(offset, (real)(frame->scene_radius)));
}

SUN_FN Emission sample_emission(const Scene *scene, real u_choice, real u_side, vec2 u_point, vec2 u_direction, mask active) {
  const SUN_GLOBAL Frame *frame = scene->frame;
  const real zero = (real)(0.0f), one = (real)(1.0f);
  Emission e;
  EmitterChoice choice = choose_emitter(scene->emitters, frame->emitter_count, u_choice);
  mask is_triangle = active & (choice.kind == (uint_n)(SUN_EMITTER_TRIANGLE));
  mask is_light = active & (choice.kind == (uint_n)(SUN_EMITTER_LIGHT));
  mask is_environment = active & (choice.kind == (uint_n)(SUN_EMITTER_ENVIRONMENT));
  real pmf = choice.pmf > 0.0f ? choice.pmf : one;
  e.far = is_environment;
  e.pointed = is_light;
  e.origin = splat3(zero);
  e.direction = make_vec3(zero, zero, one);
  e.flux = splat3(zero);
  real trace_over_direct = one;      // 1 / dVCM, before the heuristic
  real trace = one, cosine = zero;   // dVC = cosine / trace; 0 for deltas, which no walk from the eye meets
  if (ANY(is_triangle)) {
    Surface s = triangle_point(scene, is_triangle ? choice.a : (uint_n)(0), is_triangle ? choice.b : (uint_n)(0), u_point);
    real share = side_share(&s);
    mask front = (share > 0.75f) | (u_side < 0.5f);
    vec3 radiance = point_emission(scene, &s, front, is_triangle);
    Frame3 shading = frame_of_normal(s.normal);
    vec3 upward = square_to_cosine_hemisphere(u_direction);
    mask usable = is_triangle & (upward.z > 0.0f) & (s.area > 0.0f);
    real pdf_direction = share * (usable ? upward.z : one) * SUN_INV_PI, pdf_area = pmf / (usable ? s.area : one);
    e.direction = select3(is_triangle, normalize3(to_world(&shading, upward)), e.direction);
    e.origin = select3(is_triangle, add3(s.position, scale3(s.normal, s.offset)), e.origin);
    e.flux = select3(usable, scale3(radiance, SUN_PI / (share * pdf_area)), e.flux);
    trace_over_direct = is_triangle ? pdf_direction : trace_over_direct;
    trace = is_triangle ? pdf_direction * pdf_area : trace;
    cosine = is_triangle ? upward.z : cosine;
  }
  real disk_area = (real)(SUN_PI * frame->scene_radius * frame->scene_radius);
  if (ANY(is_light)) {
    LightLanes lanes = lights_at(scene, is_light ? choice.a : (uint_n)(0));
    LightEmission light = emission_of_light(&lanes, u_direction);
    vec3 from_disk = disk_origin(frame, negate3(light.direction), u_point);
    e.far = e.far | (is_light & light.far);
    real pdf = light.far ? 1.0f / disk_area : light.pdf;
    e.direction = select3(is_light, light.direction, e.direction);
    e.origin = select3(is_light, select3(light.far, from_disk, light.origin), e.origin);
    e.flux = select3(is_light, scale3(light.intensity, 1.0f / (pdf * pmf)), e.flux);
    trace_over_direct = is_light ? pdf : trace_over_direct;
  }
  if (ANY(is_environment)) {
    EnvironmentSample sky = environment_sample(&frame->environment, scene->environment_cdf, u_direction.x, u_direction.y);
    if (frame->flags & SUN_FRAME_PHOTONS) {
      // A map's chances leave its dim parts to rays that meet them by chance [Karlik19]; what photons do not carry is lost, so half of them come from anywhere.
      sky.direction = select3(u_side >= 0.5f, square_to_uniform_sphere(u_direction), sky.direction);
      sky.pdf = 0.5f * environment_pdf(&frame->environment, scene->environment_cdf, sky.direction) + 0.5f * square_to_uniform_sphere_pdf();
    }
    vec3 radiance = environment_radiance(&frame->environment, scene->environment_texels, sky.direction);
    mask usable = is_environment & (sky.pdf > 0.0f);
    e.direction = select3(is_environment, negate3(sky.direction), e.direction);
    e.origin = select3(is_environment, disk_origin(frame, sky.direction, u_point), e.origin);
    real direct = pmf * (usable ? sky.pdf : one);
    e.flux = select3(usable, scale3(radiance, disk_area / direct), e.flux);
    trace_over_direct = is_environment ? 1.0f / disk_area : trace_over_direct;
    trace = is_environment ? direct / disk_area : trace;
    cosine = is_environment ? one : cosine;
  }
  e.dVCM = heuristic_ratio(frame, 1.0f / trace_over_direct);
  e.dVC = heuristic_ratio(frame, cosine / trace);
  e.dVM = SUN_MERGING ? e.dVC / merging_ratio(frame) : zero;
  e.valid = active & (max_of3(e.flux) > 0.0f);
  return e;
}

SUN_NAMESPACE_END
#endif
