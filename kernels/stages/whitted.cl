// SPDX-License-Identifier: Apache-2.0
// whitted: whole trees of rays, from the camera to the film, LANES at once: stages fused into one kernel.
//   reads    the scene, the tree; counts PATHS, NEXT_PATH
//   writes   film; counts of rays and of why trees ended. whitted_next: NEXT_PATH
//   queues   none
//   holds    a launch works on the next `pool` paths of those that are wanted; a contribution depends on its sample alone, as everywhere
//   source   [Whitted80]: mirrored and refracted rays of every hit, a shadow ray to each light, an ambient term; Fresnel's shares
// A tree is walked depth first. Where a surface does both, the ray goes on into the solid and the mirrored one waits; at a thin pane, which is no depth, it
// is mirrored first and what goes straight on waits. So at most one ray waits at each depth.
#include "math/srgb.h"
#include "path/contribute.h"
#include "path/path.h"
#include "path/number.h"
#include "scene/camera.h"
#include "scene/trace_lanes.h"
#include "transport/direct.h"
#include "transport/layers.h"
#include "transport/pass.h"

// Rays of LANES trees; hits count strictly behind (passed_t, passed_instance, passed_primitive).
typedef struct Branch {
  vec3 origin, direction, throughput;
  uint_n depth;
  real passed_t;
  uint_n passed_instance, passed_primitive;
} Branch;

SUN_FN Branch select_branch(mask m, const Branch *a, const Branch *b) {
  Branch c;
  c.origin = select3(m, a->origin, b->origin);
  c.direction = select3(m, a->direction, b->direction);
  c.throughput = select3(m, a->throughput, b->throughput);
  c.depth = m ? a->depth : b->depth;
  c.passed_t = b->passed_t;
  c.passed_instance = b->passed_instance;
  c.passed_primitive = b->passed_primitive;
  if (SUN_PASSABLE) {
    c.passed_t = m ? a->passed_t : b->passed_t;
    c.passed_instance = m ? a->passed_instance : b->passed_instance;
    c.passed_primitive = m ? a->passed_primitive : b->passed_primitive;
  }
  return c;
}

SUN_FN uint count_lanes(mask on) {
  int flags[LANES];
  int_n ones = on ? (int_n)(1) : (int_n)(0);
  LANES_STORE(ones, flags);
  uint count = 0;
  for (int lane = 0; lane < LANES; lane++) count += (uint)flags[lane];
  return count;
}

// What of a light's contribution arrives: 0 where something blocks; through what lets light pass, nearest first.
SUN_FN vec3 arriving(const Scene *scene, const TraceScene *tree, const DirectSample *direct) {
  Scene of_any = *scene;
  of_any.alike = 0;
  Rays rays = fresh_rays(direct->origin, direct->direction, direct->t_max, scene->moment.time);
  mask open = direct->valid & !blocked_lanes(scene->frame, tree, &rays, direct->valid, SUN_WANT_OPAQUE);
  vec3 worth = select3(open, direct->contribution, splat3((real)(0.0f)));
  vec3 wo = normalize3(negate3(direct->direction));
  while (SUN_PASSABLE && ANY(open)) {
    HitLanes hit = closest_lanes(scene->frame, tree, &rays, open, SUN_WANT_PASSABLE);
    open = open & hit.hit;
    if (!ANY(open)) break;
    worth = select3(open, mul3(worth, passed_share(&of_any, &hit, wo)), worth);
    open = open & (max_of3(worth) > 0.0f);
    rays.passed_t = hit.t;
    rays.passed_instance = hit.instance;
    rays.passed_primitive = hit.primitive;
  }
  return worth;
}

// Lanes that are shaded at once: those that hit one shape, whose records are read once, or all that hit triangles. Takes them out of `left`.
SUN_FN HitLanes take_group(const SUN_GLOBAL Frame *frame, const TraceScene *tree, const HitLanes *hit, mask *left, int *alike) {
  HitLanes group = *hit;
  group.hit = *left;
  *alike = 0;
  if (SUN_FEW_SHAPES) {
    const uint number = least_lane(*left ? hit->instance : (uint_n)(SUN_NONE));
    *alike = number >= frame->first_shape;
    const mask same = *alike ? hit->instance == (uint_n)(number) : hit->instance < (uint_n)(frame->first_shape);
    group.hit = *left & same;
    if (*alike) {
      group.instance = (uint_n)(number);
      group.primitive = (uint_n)(tree->roots[number]);
    }
  }
  *left = *left & !group.hit;
  return group;
}

// What LANES samples see. `film` may be 0: then what they see is the result alone.
SUN_INLINE vec3 walk_trees(const Scene *opened, const TraceScene *tree, const FilmView *film, const PathNumber *place, const SamplerKey *sample_key,
                           const CameraRay *camera_of, mask active, uint *rays_traced) {
  Scene of_group = *opened;
  const Scene *scene = &of_group;
  const SUN_GLOBAL Frame *frame = scene->frame;
  const vec3 black = splat3((real)(0.0f));
  const uint_n none = (uint_n)(SUN_NONE), one = (uint_n)(1);
  const mask nowhere = active & !active;
  const SamplerKey key = *sample_key;
  const CameraRay camera = *camera_of;
  const real cutoff = (real)(frame->cutoff);
  const vec3 ambient = make_vec3((real)(frame->ambient[0]), (real)(frame->ambient[1]), (real)(frame->ambient[2]));
  Path path;
  path.pixel = place->y * (uint_n)(frame->tile_width) + place->x;
  path.sample = place->sample;
  path.vertex = (uint_n)(0);
  Branch now;
  now.origin = camera.origin;
  now.direction = camera.direction;
  now.throughput = splat3(camera.weight);
  now.depth = (uint_n)(0);
  now.passed_t = (real)(0.0f);
  now.passed_instance = now.passed_primitive = none;
  vec3 seen = black;
  // Lanes wait at levels of their own; level k of all lanes stands in waiting[k].
  Branch waiting[SUN_WHITTED_DEPTH];
  uint_n level = (uint_n)(0), deepest = (uint_n)(0);
  mask limited = nowhere, escaped = nowhere, layered = nowhere;
  uint top = 0;  // no lane waits at this level or above
  while (ANY(active)) {
    Rays rays = fresh_rays(now.origin, now.direction, (real)(SUN_INFINITY), scene->moment.time);
    if (SUN_PASSABLE) {
      rays.passed_t = now.passed_t;
      rays.passed_instance = now.passed_instance;
      rays.passed_primitive = now.passed_primitive;
    }
    HitLanes hit = closest_lanes(frame, tree, &rays, active, SUN_WANT_ALL);
    if (film) rays_traced[0] += count_lanes(active);
    vec3 radiance = black;  // that reaches the ray's origin
    mask missed = active & !hit.hit;
    if (ANY(missed)) {
      mask shown = (frame->flags & SUN_FRAME_TRANSPARENT) ? missed & (now.depth != (uint_n)(0)) : missed;
      radiance = select3(shown, environment_radiance(&frame->environment, scene->environment_texels, now.direction), radiance);
      escaped = escaped | (missed & (now.depth == (uint_n)(0)));
    }
    // Lanes that go on: into a solid, mirrored, straight. Where they go is in `onward` and in `mirror`.
    mask through = nowhere, mirrored = nowhere, straight = nowhere;
    Branch onward = now, mirror = now;
    vec3 wo = negate3(now.direction);
    if (film && layers_wanted(frame)) {
      HitLanes first = hit;
      first.hit = hit.hit & (now.depth == (uint_n)(0)) & !layered;
      if (ANY(first.hit)) layered = layered | first_hit_layers(opened, film, &path, &first, wo, camera.weight);
    }
    for (mask left = hit.hit; ANY(left);) {
      HitLanes group = take_group(frame, tree, &hit, &left, &of_group.alike);
      Surface surface = make_surface(scene, &group, wo);
      mask present = group.hit;
      if (SUN_PASSABLE) {
        real alpha = surface_alpha(scene, &surface, group.hit);
        mask passed = group.hit & (alpha < 1.0f);
        if (ANY(passed)) passed = passed & (alpha <= hash_coin(&key, path.vertex, group.instance, group.primitive, 0));
        straight = straight | passed;
        present = present & !passed;
      }
      vec3 throughput = mul3(now.throughput, surface_absorption(scene, &surface, group.t, present));
      now.throughput = select3(present, throughput, now.throughput);
      onward.throughput = select3(present, throughput, onward.throughput);
      radiance = select3(present, surface_emission(scene, &surface, present), radiance);
      mask unlit = (surface.material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != (uint_n)(0);
      mask scatters = present & !unlit;
      if (!ANY(scatters)) continue;
      mask deep = scatters & (now.depth >= (uint_n)(frame->max_depth));
      Bsdf bsdf = surface_bsdf(scene, &surface, scatters);
      vec3 wo_local = to_local(&surface.shading, wo);
      Lobes lobes = bsdf_lobes(&bsdf, scene->tables, wo_local);
      mask lit = scatters & !deep;
      vec3 diffuse = scale3(bsdf.base, (1.0f - bsdf.metallic) * (1.0f - bsdf.transmission));
      vec3 direct = mul3(ambient, diffuse);
      mask spread = lit & lobes_spread(&lobes);
      for (uint light = 0; ANY(spread) && light < frame->light_count; light++) {
        DirectSample sample = direct_from_light(scene, &surface, &lobes, wo_local, light, spread);
        if (!ANY(sample.valid)) continue;
        if (film) rays_traced[1] += count_lanes(sample.valid);
        direct = add3(direct, arriving(scene, tree, &sample));
      }
      // Light that this surface scatters is of the next depth; the ray's own depth has its emission.
      vec3 worth = mul3(now.throughput, direct);
      mask shines = lit & (max_of3(direct) > 0.0f);
      if (film && ANY(shines)) film_contribute_keyed(frame, film, shines, &path, SUN_FILM_KEY_DIRECT(path.vertex, 0u), now.depth + one, worth);
      seen = select3(shines, add3(seen, worth), seen);
      if (!ANY(scatters & lobes.specular)) continue;

      Deltas deltas = lobes_deltas(&lobes, wo_local);
      vec3 reflected = mul3(now.throughput, deltas.reflected);
      vec3 size = make_vec3(fabs(reflected.x), fabs(reflected.y), fabs(reflected.z));
      mask returned = scatters & (max_of3(size) > cutoff);
      if (ANY(returned)) {
        vec3 mirror_local = make_vec3(-wo_local.x, -wo_local.y, wo_local.z);
        vec3 direction = normalize3(to_world(&surface.shading, mirror_local));
        returned = returned & (dot3(direction, surface.normal) > 0.0f);
        mirror.direction = select3(returned, direction, mirror.direction);
        mirror.origin = select3(returned, surface_origin(&surface, direction), mirror.origin);
        mirror.throughput = select3(returned, reflected, mirror.throughput);
        mirrored = mirrored | (returned & !deep);
        limited = limited | (returned & deep);
      }
      vec3 passed = mul3(now.throughput, deltas.transmitted);
      size = make_vec3(fabs(passed.x), fabs(passed.y), fabs(passed.z));
      mask clear = scatters & (max_of3(size) > cutoff);
      if (ANY(clear)) {
        mask null_event = clear & !bsdf.solid;  // smooth thin transmission: the same ray goes on, at no depth
        vec3 bent = normalize3(to_world(&surface.shading, deltas.wi_transmitted));
        clear = clear & (null_event | (dot3(bent, surface.normal) < 0.0f));
        mask enters = clear & bsdf.solid;
        onward.throughput = select3(clear, passed, onward.throughput);
        onward.direction = select3(enters, bent, onward.direction);
        onward.origin = select3(enters, surface_origin(&surface, bent), onward.origin);
        onward.depth = enters ? now.depth + one : onward.depth;
        if (SUN_PASSABLE) straight = straight | null_event;
        through = through | (enters & !deep);
        limited = limited | (enters & deep);
      }
    }
    vec3 worth = mul3(now.throughput, radiance);
    mask shines = active & (max_of3(radiance) > 0.0f);
    if (film && ANY(shines)) film_contribute_lanes(frame, film, shines, &path, now.depth, worth);
    seen = select3(shines, add3(seen, worth), seen);
    path.vertex = path.vertex + one;

    // Straight on: the same ray, strictly behind this hit.
    mirror.depth = now.depth + one;
    if (SUN_PASSABLE) {
      onward.passed_t = straight ? hit.t : (real)(0.0f);
      onward.passed_instance = straight ? hit.instance : none;
      onward.passed_primitive = straight ? hit.primitive : none;
      mirror.passed_t = (real)(0.0f);
      mirror.passed_instance = mirror.passed_primitive = none;
    }
    mask goes = through | straight, waits = goes & mirrored;
    if (ANY(waits)) {
      Branch later = select_branch(straight, &onward, &mirror);
      for (uint k = 0; k < top; k++) {
        mask here = waits & (level == (uint_n)(k));
        if (ANY(here)) waiting[k] = select_branch(here, &later, &waiting[k]);
      }
      level = waits ? level + one : level;
      mask raised = level > (uint_n)(top);
      if (ANY(raised)) waiting[top++] = later;
    }
    mask follows_mirror = mirrored & (straight | !goes);
    mask takes = active & !goes & !mirrored & (level != (uint_n)(0));
    now = select_branch(follows_mirror, &mirror, &onward);
    if (ANY(takes)) {
      for (uint k = 0; k < top; k++) {
        mask here = takes & (level == (uint_n)(k + 1));
        if (ANY(here)) now = select_branch(here, &waiting[k], &now);
      }
      level = takes ? level - one : level;
      for (mask still = level >= (uint_n)(top); top > 0 && !ANY(still); still = level >= (uint_n)(top)) top--;
    }
    active = active & (goes | mirrored | takes);
    deepest = (active & (now.depth > deepest)) ? now.depth : deepest;
  }
  if (film) {
    uint inside[LANES], reason[LANES], depth[LANES];
    uint_n flags = place->inside ? (uint_n)(1) : (uint_n)(0);
    uint_n why = limited ? (uint_n)(SUN_ENDED_DEPTH) : escaped ? (uint_n)(SUN_ENDED_ESCAPED) : (uint_n)(SUN_ENDED_ABSORBED);
    LANES_STORE(flags, inside);
    LANES_STORE(why, reason);
    LANES_STORE(deepest, depth);
    for (int lane = 0; lane < LANES; lane++) {
      if (!inside[lane]) continue;
      film_count(film->counts, SUN_COUNT_ENDED + reason[lane]);
      film_count(film->counts, SUN_COUNT_BY_DEPTH + (depth[lane] < SUN_COUNT_DEPTHS ? depth[lane] : SUN_COUNT_DEPTHS - 1));
      rays_traced[2]++;
    }
  }
  return seen;
}

SUN_BODY void whitted_bundle(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, SCENE_PARAMETERS, FilmCounts counts, FilmWords film_words, uint first) {
  uint begun = counts[SUN_COUNT_NEXT_PATH], left = counts[SUN_COUNT_PATHS] - begun;
  left = left < frame->pool ? left : frame->pool;
  if (first >= left) return;
  Scene scene = open_scene(frame, SCENE_ARGUMENTS);
  TraceScene tree = make_trace_scene(TREE_ARGUMENTS, instances, frame->instance_count, frame->plane_count);
  FilmView film = open_film(frame, film_words, counts);
  uint_n within = (uint_n)(first) + uint_of_int((int_n)(LANE_NUMBERS));
  PathNumber place = path_numbers_from(frame, begun + first);
  mask wanted = within < (uint_n)(left);
  place.inside = place.inside & wanted;
  uint traced[3] = {0, 0, 0};  // rays of trees, shadow rays, trees
  SamplerKey key = sampler_key(frame->seed, place.picture_x, place.picture_y, place.sample, frame->sampler);
  at_moment(&scene, &key);
  CameraRay ray = camera_ray(frame, scene.tables, &key, place.picture_x, place.picture_y);
  walk_trees(&scene, &tree, &film, &place, &key, &ray, place.inside, traced);
  atomic_add(counts + SUN_COUNT_RAYS + 1, traced[0] - traced[2]);  // camera rays are counted as paths
  atomic_add(counts + SUN_COUNT_RAYS + 2, traced[1]);
}

SUN_TRACE_KERNEL void whitted(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, SCENE_PARAMETERS, FilmCounts counts, FilmWords film_words) {
  whitted_bundle(frame, TREE_ARGUMENTS, SCENE_ARGUMENTS, counts, film_words, (uint)get_global_id(0) * LANES);
}

// Behind it: these paths are done. For one work-item.
__kernel void whitted_next(const SUN_GLOBAL Frame *frame, SUN_GLOBAL uint *counts) {
  if (get_global_id(0) != 0) return;
  uint left = counts[SUN_COUNT_PATHS] - counts[SUN_COUNT_NEXT_PATH];
  counts[SUN_COUNT_NEXT_PATH] += left < frame->pool ? left : frame->pool;
}

// A frame for a display: a ray through the middle of each pixel of the tile, and radiance times `scale` in bytes, red lowest. No film.
SUN_BODY void whitted_view_bundle(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, SCENE_PARAMETERS, float scale, SUN_GLOBAL uint *pixels, uint first) {
  if (first >= frame->paths_per_sample) return;
  Scene scene = open_scene(frame, SCENE_ARGUMENTS);
  TraceScene tree = make_trace_scene(TREE_ARGUMENTS, instances, frame->instance_count, frame->plane_count);
  PathNumber place = path_numbers_from(frame, first);
  SamplerKey key = sampler_key(frame->seed, place.picture_x, place.picture_y, place.sample, frame->sampler);
  at_moment(&scene, &key);
  CameraRay ray = camera_ray_at(frame, &key, real_of_uint(place.picture_x) + 0.5f, real_of_uint(place.picture_y) + 0.5f);
  vec3 seen = scale3(walk_trees(&scene, &tree, 0, &place, &key, &ray, place.inside, 0), (real)(scale));
  uint_n color = srgb_byte(seen.x) | (srgb_byte(seen.y) << (uint_n)(8)) | (srgb_byte(seen.z) << (uint_n)(16)) | (uint_n)(0xff000000u);
  uint colors[LANES];
  LANES_STORE(color, colors);
  const uint to = FIRST_LANE(place.y) * frame->tile_width + FIRST_LANE(place.x);
#if LANES > 1
  if (ALL(place.inside)) {  // rows of a block
    for (int row = 0; row < LANES / 4; row++) vstore4(vload4((size_t)row, colors), 0, pixels + to + (uint)row * frame->tile_width);
    return;
  }
#endif
  int inside[LANES];
  LANES_STORE(place.inside, inside);
  for (int lane = 0; lane < LANES; lane++)
    if (inside[lane]) pixels[to + (uint)(lane >> 2) * frame->tile_width + (uint)(lane & 3)] = colors[lane];
}

SUN_TRACE_KERNEL void whitted_view(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, SCENE_PARAMETERS, float scale, SUN_GLOBAL uint *pixels) {
  whitted_view_bundle(frame, TREE_ARGUMENTS, SCENE_ARGUMENTS, scale, pixels, (uint)get_global_id(0) * LANES);
}
