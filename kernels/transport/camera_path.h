// SPDX-License-Identifier: Apache-2.0
// The fresh path of a pixel and a sample: its camera ray. Filter importance sampling [Ernst06].
#ifndef SUN_TRANSPORT_CAMERA_PATH_H
#define SUN_TRANSPORT_CAMERA_PATH_H
#include "path/path.h"
#include "scene/camera.h"

SUN_NAMESPACE_BEGIN

// A ray that has passed nothing yet.
SUN_FN void begin_ray(Path *path, vec3 origin, vec3 direction) {
  path->origin_x = origin.x;
  path->origin_y = origin.y;
  path->origin_z = origin.z;
  path->direction_x = direction.x;
  path->direction_y = direction.y;
  path->direction_z = direction.z;
  path->passed_t = (real)(0.0f);
  path->passed_instance = path->passed_primitive = (uint_n)(SUN_NONE);
}

// x and y count within the tile.
SUN_FN Path camera_path(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL float *tables, uint_n x, uint_n y, uint_n sample) {
  uint_n picture_x = x + (uint_n)(frame->tile_x0), picture_y = y + (uint_n)(frame->tile_y0);
  SamplerKey key = sampler_key(frame->seed, picture_x, picture_y, sample, frame->sampler);
  CameraRay ray = camera_ray(frame, tables, &key, picture_x, picture_y);
  Path path;
  begin_ray(&path, ray.origin, ray.direction);
  path.throughput_r = path.throughput_g = path.throughput_b = ray.weight;
  path.pdf_solid_angle = (real)(0.0f);
  path.pixel = y * (uint_n)(frame->tile_width) + x;
  path.sample = sample;
  path.vertex = (uint_n)(0);
  return path;
}

SUN_NAMESPACE_END
#endif
