// SPDX-License-Identifier: Apache-2.0
// The layers of what the camera sees first: albedo, normal ...
#ifndef SUN_TRANSPORT_LAYERS_H
#define SUN_TRANSPORT_LAYERS_H
#include "math/sampler.h"
#include "path/contribute.h"
#include "path/path.h"
#include "scene/camera.h"
#include "scene/surface.h"

SUN_NAMESPACE_BEGIN

SUN_FN int layers_wanted(const SUN_GLOBAL Frame *frame) {
  return (frame->layer_albedo & frame->layer_normal & frame->layer_depth & frame->layer_position & frame->layer_object & frame->layer_material &
          frame->layer_alpha) != SUN_NONE;
}

// LANES values of one layer.
SUN_FN void layer_add(const FilmView *film, uint layer, mask active, const Path *path, uint_n pixel_hash, vec3 value) {
  if (layer != SUN_NONE) film_add_lanes(film, active, (uint_n)(layer), path->pixel, pixel_hash, path->sample, (uint_n)(SUN_FILM_KEY_LAYER(layer)), value);
}

// The lanes of `hit` whose surface is there, as its alpha's coin says: those have been added. wo: back along the ray. `weight`: the filter's.
SUN_FN mask first_hit_layers(const Scene *scene, const FilmView *film, const Path *path, const HitLanes *hit, vec3 wo, real weight) {
  const SUN_GLOBAL Frame *frame = scene->frame;
  Surface surface = make_surface(scene, hit, wo);
  SamplerKey key = path_key(frame, path);
  real alpha = surface_alpha(scene, &surface, hit->hit);
  mask absent = (alpha < 1.0f) & (alpha <= hash_coin(&key, path->vertex, hit->instance, hit->primitive, 0));
  mask present = hit->hit & !absent;
  if (!ANY(present)) return present;

  Bsdf bsdf = surface_bsdf(scene, &surface, present);
  vec3 wo_local = to_local(&surface.shading, wo);
  // The filter's weight belongs to every layer that is averaged.
  if (frame->layer_albedo != SUN_NONE) layer_add(film, frame->layer_albedo, present, path, key.pixel_hash, scale3(bsdf_albedo(&bsdf, scene->tables, wo_local), weight));
  layer_add(film, frame->layer_normal, present, path, key.pixel_hash, scale3(surface.shading.normal, weight));
  // Along the camera's axis, as compositors expect of Z.
  CameraLanes camera = camera_at(frame, &scene->moment);
  layer_add(film, frame->layer_depth, present, path, key.pixel_hash, splat3(dot3(sub3(surface.position, camera.position), camera.forward) * weight));
  layer_add(film, frame->layer_position, present, path, key.pixel_hash, scale3(surface.position, weight));
  layer_add(film, frame->layer_alpha, present, path, key.pixel_hash, splat3(weight));
  // Numbers cannot be averaged: they are those of sample 0, counted from 1, so that 0 is nothing. Objects are the scene's instances.
  mask leading = present & (path->sample == (uint_n)(0));
  if (frame->layer_object != SUN_NONE) {
    uint_n object = gather_uint(scene->instance_object, hit->instance) + gather_uint(scene->triangle_object, hit->primitive);
    layer_add(film, frame->layer_object, leading, path, key.pixel_hash, splat3(real_of_uint(object)));
  }
  layer_add(film, frame->layer_material, leading, path, key.pixel_hash, splat3(real_of_uint(surface.material + (uint_n)(1))));
  return present;
}

SUN_NAMESPACE_END
#endif
