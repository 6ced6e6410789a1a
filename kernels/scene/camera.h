// SPDX-License-Identifier: Apache-2.0
// The camera: pixel and sample -> film position by the filter -> ray.
#ifndef SUN_SCENE_CAMERA_H
#define SUN_SCENE_CAMERA_H
#include "math/sampler.h"
#include "math/warp.h"
#include "scene/moment.h"
#include "shared/frame.h"
#include "shared/tables.h"

SUN_NAMESPACE_BEGIN

typedef struct CameraRay {
  vec3 origin, direction;  // direction has unit length
  real weight;             // of the filter, negative in the outer ring of Mitchell
} CameraRay;

// Where the camera is for LANES paths; `right` and `up` as in Camera.
typedef struct CameraLanes {
  vec3 position, right, up, forward;
} CameraLanes;

SUN_FN vec3 camera_vector(const SUN_GLOBAL float *v) { return make_vec3((real)(v[0]), (real)(v[1]), (real)(v[2])); }

SUN_FN CameraLanes camera_lanes(const SUN_GLOBAL Camera *camera) {
  CameraLanes lanes;
  lanes.position = camera_vector(camera->position);
  lanes.right = camera_vector(camera->right);
  lanes.up = camera_vector(camera->up);
  lanes.forward = camera_vector(camera->forward);
  return lanes;
}

SUN_FN vec3 gather_key_vector(const SUN_GLOBAL Camera *keys, uint_n key, real blend, const SUN_GLOBAL float *field) {
  uint offset = (uint)(field - (const SUN_GLOBAL float *)keys);
  const SUN_GLOBAL float *words = (const SUN_GLOBAL float *)keys;
  uint_n at = key * (uint_n)(sizeof(Camera) / sizeof(float)) + (uint_n)(offset), next = at + (uint_n)(sizeof(Camera) / sizeof(float));
  vec3 before = make_vec3(gather_real(words, at), gather_real(words, at + (uint_n)(1)), gather_real(words, at + (uint_n)(2)));
  vec3 after = make_vec3(gather_real(words, next), gather_real(words, next + (uint_n)(1)), gather_real(words, next + (uint_n)(2)));
  return blend3(before, after, blend);
}

// Between two keys the camera stays rigid: its axes are made perpendicular again, the line of sight first, and keep their lengths.
SUN_FN CameraLanes camera_at(const SUN_GLOBAL Frame *frame, const Moment *moment) {
  CameraLanes lanes = camera_lanes(&frame->camera);
  if (SUN_MOTION && (frame->flags & SUN_FRAME_CAMERA_MOVES)) {
    const SUN_GLOBAL Camera *keys = (const SUN_GLOBAL Camera *)(frame + 1);
    real width = sqrt(dot3(lanes.right, lanes.right)), height = sqrt(dot3(lanes.up, lanes.up));
    lanes.position = gather_key_vector(keys, moment->step, moment->blend, keys->position);
    lanes.forward = normalize3(gather_key_vector(keys, moment->step, moment->blend, keys->forward));
    vec3 right = gather_key_vector(keys, moment->step, moment->blend, keys->right);
    right = normalize3(sub3(right, scale3(lanes.forward, dot3(right, lanes.forward))));
    lanes.up = scale3(cross3(right, lanes.forward), height);
    lanes.right = scale3(right, width);
  }
  return lanes;
}

// One coordinate by the filter's inverse cdf of |f|, linear within a cell.
SUN_FN real filter_offset(const SUN_GLOBAL float *tables, real u) {
  real x = u * (float)SUN_FILTER_TABLE;
  real cell = floor(x);
  cell = min_real(cell, (real)((float)(SUN_FILTER_TABLE - 1)));
  uint_n at = uint_of_int(int_of_real(cell)) + (uint_n)(SUN_TABLE_FILTER);
  real lower = gather_real(tables, at), upper = gather_real(tables, at + (uint_n)(1));
  return lerp_real(lower, upper, x - cell);
}

// The ray of a position on the film; on the lens as the sample says. Its weight is 1.
SUN_FN CameraRay camera_ray_at(const SUN_GLOBAL Frame *frame, const SamplerKey *key, real x, real y) {
  CameraRay ray;
  ray.weight = (real)(1.0f);
  real sx = x * (2.0f / (float)frame->width) - 1.0f, sy = 1.0f - y * (2.0f / (float)frame->height);
  const SUN_GLOBAL Camera *camera = &frame->camera;
  Moment moment = sample_moment(frame, key);
  CameraLanes at = camera_at(frame, &moment);
  vec3 right = at.right, up = at.up, forward = at.forward;
  vec3 across = add3(scale3(right, sx), scale3(up, sy));
  if (camera->kind == SUN_CAMERA_ORTHOGRAPHIC) {
    ray.origin = add3(at.position, across);
    ray.direction = forward;
    return ray;
  }
  vec3 direction = add3(forward, across);
  ray.origin = at.position;
  if (camera->lens_radius > 0.0f) {
    // Thin lens: all rays of a film position meet in the plane of focus.
    vec2 disk = square_to_disk(sample_2d(key, (uint_n)(SUN_DIM_LENS)));
    vec3 on_lens = add3(scale3(normalize3(right), disk.x * camera->lens_radius), scale3(normalize3(up), disk.y * camera->lens_radius));
    direction = sub3(scale3(direction, (real)(camera->focus_distance)), on_lens);
    ray.origin = add3(at.position, on_lens);
  }
  ray.direction = normalize3(direction);
  return ray;
}

// Filter importance sampling [Ernst06]: a sample belongs to one pixel, its position is drawn from the filter about the pixel's centre.
SUN_FN CameraRay camera_ray(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL float *tables, const SamplerKey *key, uint_n pixel_x, uint_n pixel_y) {
  vec2 u = sample_2d(key, (uint_n)(SUN_DIM_FILTER));
  real dx = filter_offset(tables, u.x), dy = filter_offset(tables, u.y);
  // Where |x| is beyond this the filter is negative (Mitchell); the product of two factors decides the sign.
  mask negative_x = fabs(dx) > (real)(frame->filter_negative_from), negative_y = fabs(dy) > (real)(frame->filter_negative_from);
  real weight = (real)(frame->filter_weight);
  weight = negative_x ? -weight : weight;
  weight = negative_y ? -weight : weight;
  CameraRay ray = camera_ray_at(frame, key, real_of_uint(pixel_x) + 0.5f + dx, real_of_uint(pixel_y) + 0.5f + dy);
  ray.weight = weight;
  return ray;
}

SUN_NAMESPACE_END
#endif
