// SPDX-License-Identifier: Apache-2.0
// The strategies that end in a shadow ray: an eye vertex with a point of an emitter (s = 1) or a light vertex (s > 1), and a light vertex with the lens (t = 1).
#ifndef SUN_TRANSPORT_CONNECT_H
#define SUN_TRANSPORT_CONNECT_H
#include "path/shadow_ray.h"
#include "scene/lens.h"
#include "transport/direct.h"
#include "transport/light_vertex.h"

SUN_NAMESPACE_BEGIN

// A shadow ray and what it carries, weight included, without the eye subpath's throughput. Rays go the eye's way, as triangles of one side ask.
typedef struct Connection {
  vec3 origin, direction;
  real t_max;
  vec3 contribution;
  mask valid;
} Connection;

// An eye vertex, as found by its subpath.
typedef struct EyeVertex {
  const Surface *surface;
  const Lobes *lobes;
  Meeting at;
  vec3 wo, wo_local;
  uint_n depth;      // scatterings before it
} EyeVertex;

// What of light from `direction` the vertex sends on, f cos, and the density of that direction; 0 where the sides disagree.
SUN_FN BsdfEval eye_eval(const Scene *scene, const EyeVertex *z, vec3 direction) {
  Side side;
  side.shading = z->surface->shading;
  side.lobes = *z->lobes;
  side.wo_local = z->wo_local;
  side.normal = z->at.normal;
  return side_eval(scene, &side, direction);
}

// Density of the way back from z to the vertex before it, for a light subpath that comes from `direction`.
SUN_FN real eye_reverse_pdf(const Scene *scene, const EyeVertex *z, vec3 direction) {
  Side back = side_of(scene, &z->at, direction);
  return side_eval(scene, &back, z->wo).pdf;
}

SUN_FN Connection connect_emitter(const Scene *scene, const EyeVertex *z, const Walk *walk, real u_choice, vec2 u_point, mask active) {
  const SUN_GLOBAL Frame *frame = scene->frame;
  Connection c;
  EmitterSample sample = sample_emitter(scene, z->surface, u_choice, u_point, active);
  c.valid = active & (sample.pdf > 0.0f) & (max_of3(sample.emission) > 0.0f);
  c.contribution = splat3((real)(0.0f));
  if (ANY(c.valid)) {
    BsdfEval eval = eye_eval(scene, z, sample.direction);
    c.valid = c.valid & (max_of3(eval.f_cos) > 0.0f);
    real safe = c.valid ? sample.pdf : (real)(1.0f);
    // [Georgiev12 eq. 43, 44]: s = 0 would have hit the point; s > 1 would have come from it.
    real from_light = sample.is_light ? (real)(0.0f) : heuristic_ratio(frame, eval.pdf / safe);
    real arrives = sample.spread * abs_cosine(dot3(sample.direction, z->at.normal));
    real from_eye = heuristic_ratio(frame, arrives) * earlier_strategies(frame, walk->dVCM, walk->dVC, eye_reverse_pdf(scene, z, sample.direction));
    real weight = strategy_weight(frame, (uint_n)(1), z->depth + (uint_n)(2), from_light, from_eye);
    c.valid = c.valid & (weight > 0.0f);
    c.contribution = select3(c.valid, scale3(mul3(eval.f_cos, sample.emission), weight / safe), c.contribution);
  }
  DirectSample ray;
  direct_ray(z->surface, &sample, &ray);
  c.origin = ray.origin;
  c.direction = ray.direction;
  c.t_max = ray.t_max;
  return c;
}

SUN_FN vec3 meeting_origin(const Meeting *m, vec3 direction) { return offset_origin(m->position, m->normal, m->offset, direction); }

SUN_FN Connection connect_vertices(const Scene *scene, const EyeVertex *z, const Walk *walk, const LightVertex *y, mask active) {
  const SUN_GLOBAL Frame *frame = scene->frame;
  const vec3 black = splat3((real)(0.0f));
  Connection c;
  vec3 to = sub3(y->at.position, z->at.position);
  real distance2 = dot3(to, to);
  c.valid = active & (distance2 > 0.0f);
  real safe2 = c.valid ? distance2 : (real)(1.0f), distance = sqrt(safe2);
  vec3 there = scale3(to, 1.0f / distance), back = negate3(there);
  c.contribution = black;
  BsdfEval at_eye = eye_eval(scene, z, there);
  c.valid = c.valid & (max_of3(at_eye.f_cos) > 0.0f);
  if (ANY(c.valid)) {
    Side seen = side_of(scene, &y->at, back);
    BsdfEval at_light = side_eval(scene, &seen, y->to_light);
    c.valid = c.valid & (max_of3(at_light.f_cos) > 0.0f);
    real cosine_z = abs_cosine(dot3(there, z->at.normal)), cosine_y = abs_cosine(dot3(back, y->at.normal));
    if (ANY(c.valid)) {
      Side lit = side_of(scene, &y->at, y->to_light);
      real pdf_light = side_eval(scene, &lit, back).pdf;
      // [Georgiev12 eq. 40, 41]
      real from_light = heuristic_ratio(frame, at_eye.pdf * cosine_y / safe2) * earlier_strategies(frame, y->dVCM, y->dVC, at_light.pdf);
      real from_eye = heuristic_ratio(frame, pdf_light * cosine_z / safe2) * earlier_strategies(frame, walk->dVCM, walk->dVC, eye_reverse_pdf(scene, z, there));
      real weight = strategy_weight(frame, y->depth + (uint_n)(2), z->depth + (uint_n)(2), from_light, from_eye);
      c.valid = c.valid & (weight > 0.0f);
      vec3 passed = mul3(mul3(at_eye.f_cos, at_light.f_cos), y->flux);
      passed = scale3(passed, weight * flux_factor(&y->at, y->to_light, back) / safe2);
      // Within a solid: as the eye's ray would find when it hits the inner side there.
      mask inner = y->at.bsdf.solid & ((dot3(back, y->at.normal) > 0.0f) != y->front);
      passed = mul3(passed, solid_transmittance(scene, y->material, distance, c.valid & inner));
      c.contribution = select3(c.valid, passed, black);
    }
  }
  c.origin = meeting_origin(&z->at, there);
  c.direction = sub3(meeting_origin(&y->at, back), c.origin);
  c.t_max = (real)(1.0f);
  return c;
}

// Light that falls on a pixel.
typedef struct Splat {
  Connection ray;
  uint_n x, y;  // of the picture
} Splat;

SUN_FN Splat connect_lens(const Scene *scene, const LightVertex *y, vec2 u_lens, real u_pixel, mask active) {
  const SUN_GLOBAL Frame *frame = scene->frame;
  Splat splat;
  Connection *c = &splat.ray;
  LensSample lens = sample_lens(frame, &scene->moment, y->at.position, u_lens);
  FilmChoice column = choose_film_pixel(frame, scene->tables, lens.film_x, u_pixel);
  FilmChoice row = choose_film_pixel(frame, scene->tables, lens.film_y, column.rest);
  mask within = (column.pixel >= 0) & (column.pixel < (int_n)((int)frame->width)) & (row.pixel >= 0) & (row.pixel < (int_n)((int)frame->height));
  splat.x = uint_of_int(within ? column.pixel : (int_n)(0));
  splat.y = uint_of_int(within ? row.pixel : (int_n)(0));
  c->valid = active & lens.valid & within;
  c->contribution = splat3((real)(0.0f));
  c->t_max = (real)(1.0f);
  c->origin = lens.origin;
  c->direction = sub3(meeting_origin(&y->at, lens.direction), lens.origin);
  if (!ANY(c->valid)) return splat;
  Side seen = side_of(scene, &y->at, lens.direction);
  BsdfEval eval = side_eval(scene, &seen, y->to_light);
  c->valid = c->valid & (max_of3(eval.f_cos) > 0.0f);
  // As many light subpaths as the picture has pixels, each of which counts in every pixel [Georgiev12 eq. 46].
  real subpaths = (real)((float)frame->width * (float)frame->height);
  real density = c->valid ? lens.density : (real)(0.0f);
  real from_light = heuristic_ratio(frame, density * abs_cosine(dot3(lens.direction, y->at.normal)) / subpaths) * earlier_strategies(frame, y->dVCM, y->dVC, eval.pdf);
  real weight = strategy_weight(frame, y->depth + (uint_n)(2), (uint_n)(1), from_light, (real)(0.0f));
  c->valid = c->valid & (weight > 0.0f);
  real scale = weight * flux_factor(&y->at, y->to_light, lens.direction) * density / subpaths * (column.weight * row.weight * frame->filter_weight);
  vec3 passed = scale3(mul3(eval.f_cos, y->flux), scale);
  mask inner = y->at.bsdf.solid & ((dot3(lens.direction, y->at.normal) > 0.0f) != y->front);
  vec3 way = sub3(y->at.position, lens.origin);
  passed = mul3(passed, solid_transmittance(scene, y->material, sqrt(dot3(way, way)), c->valid & inner));
  c->contribution = select3(c->valid, passed, c->contribution);
  return splat;
}

SUN_NAMESPACE_END
#endif
