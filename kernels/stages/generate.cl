// SPDX-License-Identifier: Apache-2.0
// generate: dead slots become new paths (path regeneration).
//   reads    counts REFILL_*; the ray queue behind its live entries
//   writes   every column of the path; status
//   queues   the slots it fills stand in `rays` already: compact counted them in
//   holds    afterwards a slot of `rays` is alive, or stands for a pixel beyond the tile's edge and is dead
//   source   filter importance sampling [Ernst06]
#include "path/path.h"
#include "path/queue.h"
#include "scene/camera.h"

SUN_BODY void generate_bundle(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *records, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status,
                              const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts, uint first) {
  uint refill = counts[SUN_COUNT_REFILL];
  if (first >= refill) return;
  const SUN_GLOBAL float *tables = (const SUN_GLOBAL float *)(records + frame->at_tables);
  Paths paths;
  paths.words = path_words;
  paths.pool = frame->pool;
  QueueLanes lanes = queue_lanes(rays + counts[SUN_COUNT_REFILL_FIRST], first, refill);

  // Path number -> (sample, block of 4x4 pixels, pixel of the block): neighbours in the queue look the same way, and a launch can end after any sample.
  uint_n number = (uint_n)(counts[SUN_COUNT_REFILL_PATH] + first) + uint_of_int((int_n)(LANE_NUMBERS));
  uint_n of_sample = number / (uint_n)(frame->paths_per_sample);
  uint_n sample = (uint_n)(frame->sample_first) + of_sample;
  uint_n rest = number - of_sample * (uint_n)(frame->paths_per_sample);
  uint_n within = rest & (uint_n)(15);
  uint_n block = rest >> (uint_n)(4);
  uint blocks_across = (frame->tile_width + 3) / 4;
  uint_n block_y = block / (uint_n)(blocks_across);
  uint_n block_x = block - block_y * (uint_n)(blocks_across);
  uint_n x = block_x * (uint_n)(4) + (within & (uint_n)(3)), y = block_y * (uint_n)(4) + (within >> (uint_n)(2));
  mask inside = lanes.active & (x < (uint_n)(frame->tile_width)) & (y < (uint_n)(frame->tile_height));

  uint_n picture_x = x + (uint_n)(frame->tile_x0), picture_y = y + (uint_n)(frame->tile_y0);
  SamplerKey key = sampler_key(frame->seed, picture_x, picture_y, sample, frame->sampler);
  CameraRay ray = camera_ray(frame, tables, &key, picture_x, picture_y);
  Path path;
  path.origin_x = ray.origin.x;
  path.origin_y = ray.origin.y;
  path.origin_z = ray.origin.z;
  path.direction_x = ray.direction.x;
  path.direction_y = ray.direction.y;
  path.direction_z = ray.direction.z;
  path.passed_t = (real)(0.0f);
  path.passed_instance = path.passed_primitive = (uint_n)(SUN_NONE);
  path.throughput_r = path.throughput_g = path.throughput_b = ray.weight;
  path.pdf_solid_angle = (real)(0.0f);
  path.pixel = y * (uint_n)(frame->tile_width) + x;
  path.sample = sample;
  path.vertex = (uint_n)(0);
  path_store(&paths, lanes.slot, inside, &path);
  store_uint(status, lanes.slot, lanes.active, inside ? (uint_n)(SUN_STATUS_ALIVE) : (uint_n)(0));
}

SUN_KERNEL void generate(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *records, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status,
                         const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts) {
  generate_bundle(frame, records, path_words, status, rays, counts, (uint)get_global_id(0) * LANES);
}
