// SPDX-License-Identifier: Apache-2.0
// The camera as light finds it: from a point to the lens, to the film, and to the one pixel that takes the light.
#ifndef SUN_SCENE_LENS_H
#define SUN_SCENE_LENS_H
#include "scene/camera.h"
#include "scene/emitter.h"

SUN_NAMESPACE_BEGIN

// Square metres of a pixel: a metre before the eye of a perspective camera, anywhere before an orthographic one.
SUN_FN float pixel_area(const SUN_GLOBAL Frame *frame) {
  const SUN_GLOBAL Camera *c = &frame->camera;
  float right = c->right[0] * c->right[0] + c->right[1] * c->right[1] + c->right[2] * c->right[2];
  float up = c->up[0] * c->up[0] + c->up[1] * c->up[1] + c->up[2] * c->up[2];
  return 4.0f * sqrt(right * up) / ((float)frame->width * (float)frame->height);
}

// 1 / the density of camera_ray's directions (perspective, by solid angle, whatever the point of the lens) or origins (orthographic, by area), film positions
// being drawn with density 1 a pixel.
SUN_FN real inverse_camera_pdf(const SUN_GLOBAL Frame *frame, const Moment *moment, vec3 direction) {
  real area = (real)(pixel_area(frame));
  if (frame->camera.kind == SUN_CAMERA_ORTHOGRAPHIC) return area;
  CameraLanes at = camera_at(frame, moment);
  real cosine = dot3(direction, at.forward);
  return area * cosine * cosine * cosine;
}

typedef struct LensSample {
  vec3 origin;          // on the lens, or on the plane of an orthographic camera
  vec3 direction;       // from the point there, unit length
  real film_x, film_y;  // in pixels
  real density;         // of film positions (1 a pixel) by area at the point that faces this way: what the lens takes of its light, too
  mask valid;           // before the camera
} LensSample;

// A point of the lens, uniform in area as for camera rays, and where light from `from` through it falls.
SUN_FN LensSample sample_lens(const SUN_GLOBAL Frame *frame, const Moment *moment, vec3 from, vec2 u) {
  LensSample lens;
  const SUN_GLOBAL Camera *camera = &frame->camera;
  CameraLanes at = camera_at(frame, moment);
  vec3 position = at.position, right = at.right, up = at.up, forward = at.forward;
  vec3 across = sub3(from, position);  // of the film position, times right and up
  real along = dot3(across, forward);
  lens.valid = along > 0.0f;
  real safe = lens.valid ? along : (real)(1.0f);
  if (camera->kind == SUN_CAMERA_ORTHOGRAPHIC) {
    lens.origin = sub3(from, scale3(forward, along));
    lens.direction = negate3(forward);
    lens.density = (real)(1.0f / pixel_area(frame));
  } else {
    vec3 on_lens = splat3((real)(0.0f));
    if (camera->lens_radius > 0.0f) {
      vec2 disk = square_to_disk(u);
      on_lens = add3(scale3(normalize3(right), disk.x * camera->lens_radius), scale3(normalize3(up), disk.y * camera->lens_radius));
    }
    lens.origin = add3(position, on_lens);
    vec3 to = sub3(from, lens.origin);
    // All rays of a film position meet in the plane of focus.
    across = scale3(to, 1.0f / safe);
    if (camera->lens_radius > 0.0f) across = add3(across, scale3(on_lens, (real)(1.0f / camera->focus_distance)));
    real distance2 = dot3(to, to), distance = sqrt(distance2);
    lens.direction = scale3(to, -1.0f / distance);
    real cosine = along / distance;
    lens.density = 1.0f / (distance2 * cosine * cosine * cosine * pixel_area(frame));
  }
  real sx = dot3(across, right) / dot3(right, right), sy = dot3(across, up) / dot3(up, up);
  lens.film_x = (sx + 1.0f) * 0.5f * (float)frame->width;
  lens.film_y = (1.0f - sy) * 0.5f * (float)frame->height;
  lens.valid = lens.valid & (fabs(lens.film_x) < 1e6f) & (fabs(lens.film_y) < 1e6f) & (lens.density > 0.0f) & (lens.density < 1e30f);
  return lens;
}

typedef struct FilmChoice {
  int_n pixel;  // column, or row; may lie beyond the picture
  real weight;  // of the filter there over the chance of the choice
  real rest;    // what is left of u, uniform again
} FilmChoice;

#define SUN_MOST_FILTER_PIXELS 5  // that a position has within two pixels to either side

// One of the pixels whose filters reach `position`, by the filter's size there, as camera_ray draws it: E[weight of pixel j] is the filter's value about j,
// so light that falls at a position counts in every pixel just as camera rays from there would.
SUN_FN FilmChoice choose_film_pixel(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL float *tables, real position, real u) {
  FilmChoice choice;
  float radius = frame->filter_radius;
  real first = floor(position - (real)(0.5f + radius)) + 1.0f;
  real share[SUN_MOST_FILTER_PIXELS], total = (real)(0.0f);
  for (int k = 0; k < SUN_MOST_FILTER_PIXELS; k++) {
    real offset = position - 0.5f - (first + (float)k);
    mask within = (offset < (real)(radius)) & (offset >= (real)(-radius));
    uint_n cell = find_cell(tables, (uint_n)(SUN_TABLE_FILTER), SUN_FILTER_TABLE, within ? offset : (real)(0.0f)) + (uint_n)(SUN_TABLE_FILTER);
    real width = gather_real(tables, cell + (uint_n)(1)) - gather_real(tables, cell);
    mask some = within & (width > 0.0f);
    share[k] = some ? 1.0f / ((float)SUN_FILTER_TABLE * (some ? width : (real)(1.0f))) : (real)(0.0f);
    total = total + share[k];
  }
  // The last one that has a share and begins at or below u.
  real at = u * total, below = (real)(0.0f), begin = (real)(0.0f), chosen = (real)(0.0f), offset = (real)(0.0f);
  choice.pixel = int_of_real(first);
  for (int k = 0; k < SUN_MOST_FILTER_PIXELS; k++) {
    mask takes = (share[k] > 0.0f) & (at >= below);
    choice.pixel = takes ? int_of_real(first) + k : choice.pixel;
    offset = takes ? position - 0.5f - (first + (float)k) : offset;
    begin = takes ? below : begin;
    chosen = takes ? share[k] : chosen;
    below = below + share[k];
  }
  choice.rest = chosen > 0.0f ? min_real((at - begin) / (chosen > 0.0f ? chosen : (real)(1.0f)), (real)(0.99999994f)) : u;
  choice.weight = fabs(offset) > (real)(frame->filter_negative_from) ? -total : total;
  return choice;
}

SUN_NAMESPACE_END
#endif
