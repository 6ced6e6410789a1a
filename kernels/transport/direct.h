// SPDX-License-Identifier: Apache-2.0
// Next-event estimation: one emitter, one point on it, and the shadow ray there.
#ifndef SUN_TRANSPORT_DIRECT_H
#define SUN_TRANSPORT_DIRECT_H
#include "math/measure.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "scene/emitter.h"
#include "scene/surface.h"

SUN_NAMESPACE_BEGIN

#define SUN_FAR 3.0e38f  // t_max of a ray to the environment

typedef struct DirectSample {
  vec3 origin, direction;  // the shadow ray; the direction reaches its target at t = 1 where t_max is 1
  real t_max;
  vec3 contribution;       // radiance times bsdf times cosine times weight over pdf, without the path's throughput
  mask valid;
} DirectSample;

// Punctual lights at the scene's moment.
SUN_FN LightLanes lights_at(const Scene *scene, uint_n light) {
  LightLanes lanes = load_lights(scene->lights, light);
  mask moves = lanes.keys != (uint_n)(0);
  if (SUN_MOTION && ANY(moves)) {
    uint_n key = moves ? lanes.keys + scene->moment.step : light;
    LightLanes before = load_lights(scene->lights, key), after = load_lights(scene->lights, moves ? key + (uint_n)(1) : light);
    lanes.place = select3(moves, blend3(before.place, after.place, scene->moment.blend), lanes.place);
    lanes.axis = select3(moves, normalize3(blend3(before.axis, after.axis, scene->moment.blend)), lanes.axis);
  }
  return lanes;
}

// A point on LANES emissive triangles, uniform in area.
typedef struct EmitterPoint {
  vec3 target;       // in front of the emitter by its own offset
  vec3 emission;
  real pdf_solid_angle;
  real spread;       // see EmitterSample
} EmitterPoint;

// As much of its surface as its emission needs: position, the front's normal in `normal`, offset, area, material, coordinates. No side is taken yet.
SUN_FN Surface triangle_point(const Scene *scene, uint_n instance, uint_n primitive, vec2 u) {
  vec2 b = square_to_triangle(u);
  Corners c = load_corners(scene, instance, primitive);
  Surface s;
  s.position = interpolate3(c.p[0], c.p[1], c.p[2], b.x, b.y);
  vec3 n = corners_normal(&c);
  s.area = sqrt(dot3(n, n)) * 0.5f;
  s.normal = normalize3(n);
  s.offset = surface_offset(&c);
  s.material = c.material;
  SCENE_UINT(s.material_flags, scene, materials, c.material, flags);
#if SUN_SHAPES
  mask shape = is_shape(c.flags, SUN_INSTANCE_SHAPE);
  real shape_uv[2];
  shape_uv[0] = shape_uv[1] = (real)(0.0f);
  if (ANY(shape)) {
    ShapePoint of_shape = point_of_shape(scene, instance, c.flags, sample_shape_place(c.flags, u), shape & is_textured(s.material_flags));
    s.position = select3(shape, of_shape.position, s.position);
    s.normal = select3(shape, of_shape.normal, s.normal);
    s.area = shape ? of_shape.area : s.area;
    s.offset = shape ? of_shape.offset : s.offset;
    shape_uv[0] = of_shape.uv[0];
    shape_uv[1] = of_shape.uv[1];
  }
#endif
  s.uv0[0] = s.uv0[1] = s.uv1[0] = s.uv1[1] = (real)(0.0f);
  SUN_UNROLL
  for (int i = 0; i < 4; i++) s.color[i] = (real)(1.0f);
#if SUN_TEXTURES
#if SUN_TRIANGLES
  surface_coordinates(scene, &s, &c, b.x, b.y);
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
#endif
  return s;
}

// What it emits to the side that `front` tells. Part of an emitter that is not there (alpha) emits as much as a ray that meets it by chance would find.
SUN_FN vec3 point_emission(const Scene *scene, Surface *s, mask front, mask wanted) {
  s->front = front;
  s->normal = select3(front, s->normal, negate3(s->normal));
  return scale3(surface_emission(scene, s, wanted), surface_alpha(scene, s, wanted));
}

// Share of a triangle's light that leaves by one side.
SUN_FN real side_share(const Surface *s) {
  mask both = (s->material_flags & (uint_n)(SUN_MATERIAL_DOUBLE_SIDED)) != (uint_n)(0);
  return both ? (real)(0.5f) : (real)(1.0f);
}

SUN_FN EmitterPoint sample_triangle(const Scene *scene, uint_n instance, uint_n primitive, vec2 u, vec3 from, mask wanted) {
  EmitterPoint point;
  // Looked at from `from`: its emission is that of a ray that hits it from there.
  Surface s = triangle_point(scene, instance, primitive, u);
  vec3 to = sub3(from, s.position);
  real distance2 = dot3(to, to);
  real cosine = dot3(s.normal, normalize3(to));
  point.emission = point_emission(scene, &s, cosine > 0.0f, wanted);
  real reach = fabs(cosine) * s.area;
  mask usable = wanted & (reach > 0.0f) & (distance2 > 0.0f);
  point.pdf_solid_angle = usable ? distance2 / (usable ? reach : (real)(1.0f)) : (real)(0.0f);
  point.spread = usable ? side_share(&s) * fabs(cosine) * SUN_INV_PI / (usable ? distance2 : (real)(1.0f)) : (real)(0.0f);
  point.target = add3(s.position, scale3(s.normal, s.offset));
  return point;
}

// A point of one emitter, as it is seen from a surface.
typedef struct EmitterSample {
  vec3 emission;      // radiance; of lights: irradiance on a surface that faces them
  vec3 target;        // of triangles, and of lights that have a place
  vec3 direction;     // there, unit length
  real pdf;           // of the choice and the point, by solid angle; of lights, which are deltas, of the choice
  real spread;        // density, per area that faces it, with which a light subpath that starts there arrives here: transport/emit.h
  mask has_target, is_light;
} EmitterSample;

// The choice and the point take SUN_DIM_EMITTER and SUN_DIM_EMITTER_POINT of this vertex.
SUN_FN EmitterSample sample_emitter(const Scene *scene, const Surface *s, real u_choice, vec2 u_point, mask active) {
  EmitterSample sample;
  const SUN_GLOBAL Frame *frame = scene->frame;
  vec3 black = splat3((real)(0.0f));
  EmitterChoice choice = choose_emitter(scene->emitters, frame->emitter_count, u_choice);
  mask is_triangle = active & (choice.kind == (uint_n)(SUN_EMITTER_TRIANGLE));
  mask is_light = active & (choice.kind == (uint_n)(SUN_EMITTER_LIGHT));
  mask is_environment = active & (choice.kind == (uint_n)(SUN_EMITTER_ENVIRONMENT));

  vec3 emission = black;
  vec3 target = s->position;
  vec3 direction = s->shading.normal;
  real pdf = (real)(0.0f), spread = (real)(0.0f);
  mask has_target = is_triangle;

  if (ANY(is_triangle)) {
    EmitterPoint point = sample_triangle(scene, is_triangle ? choice.a : (uint_n)(0), is_triangle ? choice.b : (uint_n)(0), u_point, s->position, is_triangle);
    emission = select3(is_triangle, point.emission, emission);
    target = select3(is_triangle, point.target, target);
    pdf = is_triangle ? point.pdf_solid_angle : pdf;
    spread = is_triangle ? point.spread : spread;
    direction = select3(is_triangle, normalize3(sub3(point.target, s->position)), direction);
  }
  if (ANY(is_light)) {
    LightLanes lanes = lights_at(scene, is_light ? choice.a : (uint_n)(0));
    LightSample light = sample_of_light(&lanes, s->position);
    emission = select3(is_light, light.radiance, emission);
    mask placed = is_light & (light.distance < SUN_FAR);
    target = select3(placed, add3(s->position, scale3(light.direction, placed ? light.distance : (real)(0.0f))), target);
    has_target = has_target | placed;
    direction = select3(is_light, light.direction, direction);
    pdf = is_light ? (real)(1.0f) : pdf;
    spread = is_light ? light.spread / (placed ? light.distance * light.distance : (real)(SUN_PI * frame->scene_radius * frame->scene_radius)) : spread;
  }
  if (ANY(is_environment)) {
#if SUN_BRANCHING
    // The map's chances leave what is dim to rays that meet it by chance [Karlik19]. Where only effects are followed none may: half of the shadow rays go anywhere.
    mask anywhere = (frame->flags & SUN_FRAME_EFFECTS) ? u_point.x >= 0.5f : is_environment & !is_environment;
    if (frame->flags & SUN_FRAME_EFFECTS) u_point.x = 2.0f * u_point.x - (anywhere ? (real)(1.0f) : (real)(0.0f));
#endif
    EnvironmentSample sky = environment_sample(&frame->environment, scene->environment_cdf, u_point.x, u_point.y);
#if SUN_BRANCHING
    if (frame->flags & SUN_FRAME_EFFECTS) {
      sky.direction = select3(anywhere, square_to_uniform_sphere(u_point), sky.direction);
      sky.pdf = 0.5f * environment_pdf(&frame->environment, scene->environment_cdf, sky.direction) + 0.5f * square_to_uniform_sphere_pdf();
    }
#endif
    vec3 radiance = environment_radiance(&frame->environment, scene->environment_texels, sky.direction);
    emission = select3(is_environment, radiance, emission);
    direction = select3(is_environment, sky.direction, direction);
    pdf = is_environment ? sky.pdf : pdf;
    spread = is_environment ? (real)(1.0f / (SUN_PI * frame->scene_radius * frame->scene_radius)) : spread;
  }
  sample.emission = emission;
  sample.target = target;
  sample.direction = direction;
  sample.pdf = pdf * choice.pmf;
  sample.spread = spread;
  sample.has_target = has_target;
  sample.is_light = is_light;
  return sample;
}

// The ray of a sample.
SUN_FN void direct_ray(const Surface *s, const EmitterSample *sample, DirectSample *direct) {
  direct->origin = surface_origin(s, sample->direction);
  direct->direction = select3(sample->has_target, sub3(sample->target, direct->origin), sample->direction);
  direct->t_max = sample->has_target ? (real)(1.0f) : (real)(SUN_FAR);
}

// Is light that is found by chance weighted against shadow rays?
SUN_FN int weighted_by_chance(const Scene *scene) { return (scene->frame->flags & SUN_FRAME_WEIGHTED) != 0; }

// The shadow ray of a sample, where `valid`; `weighted`: against what the bsdf finds. A light is a delta: no ray finds it by chance, so it keeps its whole weight.
SUN_FN DirectSample direct_of(const Scene *scene, const Surface *s, const Lobes *lobes, vec3 wo_local, const EmitterSample *sample, int weighted, mask valid) {
  DirectSample direct;
  direct.contribution = splat3((real)(0.0f));
  if (ANY(valid)) {
    vec3 wi_local = to_local(&s->shading, sample->direction);
    BsdfEval eval = lobes_eval(lobes, scene->tables, wo_local, wi_local);
    // The true side has to agree with the shading side, or light leaks through.
    mask same_side = (dot3(sample->direction, s->normal) > 0.0f) == (wi_local.z > 0.0f);
    valid = valid & same_side & (max_of3(eval.f_cos) > 0.0f);
    real weight = (real)(1.0f);
    if (weighted) weight = sample->is_light ? weight : power_heuristic(sample->pdf, eval.pdf);
    real scale = valid ? weight / (valid ? sample->pdf : (real)(1.0f)) : (real)(0.0f);
    direct.contribution = select3(valid, scale3(mul3(eval.f_cos, sample->emission), scale), direct.contribution);
  }
  direct_ray(s, sample, &direct);
  direct.valid = valid;
  return direct;
}

// A ray to one punctual light, wherever it is seen from: its pdf is 1.
SUN_FN DirectSample direct_from_light(const Scene *scene, const Surface *s, const Lobes *lobes, vec3 wo_local, uint light, mask active) {
  LightLanes lanes = SUN_MOTION ? lights_at(scene, (uint_n)(light)) : load_light(scene->lights, light);
  LightSample of_light;
  if ((scene->lights[light].kind & SUN_LIGHT_KIND) == SUN_LIGHT_POINT) {  // the same numbers, without what the others need
    lanes.kind = (uint_n)(SUN_LIGHT_POINT);
    of_light = sample_of_light(&lanes, s->position);
  } else {
    of_light = sample_of_light(&lanes, s->position);
  }
  EmitterSample sample;
  sample.emission = of_light.radiance;
  sample.has_target = of_light.distance < SUN_FAR;
  sample.target = add3(s->position, scale3(of_light.direction, sample.has_target ? of_light.distance : (real)(0.0f)));
  sample.direction = of_light.direction;
  sample.pdf = (real)(1.0f);
  sample.spread = (real)(0.0f);
  sample.is_light = active;
  return direct_of(scene, s, lobes, wo_local, &sample, 0, active & (max_of3(of_light.radiance) > 0.0f));
}

// A shadow ray for LANES surfaces. `throughput` is not in it.
SUN_FN DirectSample sample_direct(const Scene *scene, const Surface *s, const Lobes *lobes, vec3 wo_local, real u_choice, vec2 u_point, mask active) {
  EmitterSample sample = sample_emitter(scene, s, u_choice, u_point, active);
  return direct_of(scene, s, lobes, wo_local, &sample, weighted_by_chance(scene), active & (sample.pdf > 0.0f) & (max_of3(sample.emission) > 0.0f));
}

SUN_NAMESPACE_END
#endif
