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
#include "scene/traverse.h"
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
  c.passed_t = m ? a->passed_t : b->passed_t;
  c.passed_instance = m ? a->passed_instance : b->passed_instance;
  c.passed_primitive = m ? a->passed_primitive : b->passed_primitive;
  return c;
}

// LANES rays, a lane at a time over the tree.
typedef struct RayLanes {
  float origin[3][LANES], direction[3][LANES], t_max[LANES], passed_t[LANES], time[LANES];
  uint passed_instance[LANES], passed_primitive[LANES];
  int on[LANES];
} RayLanes;

SUN_INLINE Ray lane_ray(const RayLanes *rays, int lane) {
  Ray ray;
  for (int axis = 0; axis < 3; axis++) {
    ray.origin[axis] = rays->origin[axis][lane];
    ray.direction[axis] = rays->direction[axis][lane];
  }
  ray.t_max = rays->t_max[lane];
  ray.passed_t = rays->passed_t[lane];
  ray.passed_instance = rays->passed_instance[lane];
  ray.passed_primitive = rays->passed_primitive[lane];
  ray.time = SUN_MOTION ? rays->time[lane] : 0.0f;
  return ray;
}

SUN_INLINE void store_rays(RayLanes *rays, vec3 origin, vec3 direction, real t_max, real passed_t, uint_n passed_instance, uint_n passed_primitive, real time, mask on) {
  int_n flags = on ? (int_n)(1) : (int_n)(0);
  LANES_STORE(origin.x, rays->origin[0]);
  LANES_STORE(origin.y, rays->origin[1]);
  LANES_STORE(origin.z, rays->origin[2]);
  LANES_STORE(direction.x, rays->direction[0]);
  LANES_STORE(direction.y, rays->direction[1]);
  LANES_STORE(direction.z, rays->direction[2]);
  LANES_STORE(t_max, rays->t_max);
  LANES_STORE(passed_t, rays->passed_t);
  LANES_STORE(passed_instance, rays->passed_instance);
  LANES_STORE(passed_primitive, rays->passed_primitive);
  if (SUN_MOTION) LANES_STORE(time, rays->time);
  LANES_STORE(flags, rays->on);
}

SUN_BODY void closest_lanes(const TraceScene *tree, const RayLanes *rays, uint want, HitLanes *out) {
  float t[LANES], u[LANES], v[LANES];
  uint instance[LANES], primitive[LANES];
  for (int lane = 0; lane < LANES; lane++) {
    t[lane] = u[lane] = v[lane] = 0.0f;
    instance[lane] = primitive[lane] = SUN_NONE;
    if (!rays->on[lane]) continue;
    const Hit hit = closest_hit(tree, lane_ray(rays, lane), want);
    t[lane] = hit.t;
    u[lane] = hit.u;
    v[lane] = hit.v;
    instance[lane] = hit.instance;
    primitive[lane] = hit.primitive;
  }
  out->t = LANES_LOAD(t);
  out->u = LANES_LOAD(u);
  out->v = LANES_LOAD(v);
  out->instance = LANES_LOAD(instance);
  out->primitive = LANES_LOAD(primitive);
  out->hit = out->instance != (uint_n)(SUN_NONE);
  out->instance = out->hit ? out->instance : (uint_n)(0);
  out->primitive = out->hit ? out->primitive : (uint_n)(0);
}

SUN_BODY mask blocked_lanes(const TraceScene *tree, const RayLanes *rays) {
  int blocked[LANES];
  for (int lane = 0; lane < LANES; lane++) blocked[lane] = rays->on[lane] && any_hit(tree, lane_ray(rays, lane), SUN_WANT_OPAQUE);
  int_n some = LANES_LOAD(blocked);
  return some != (int_n)(0);
}

// What of a light's contribution arrives: 0 where something blocks; through what lets light pass, nearest first.
SUN_FN vec3 arriving(const Scene *scene, const TraceScene *tree, const DirectSample *direct) {
  RayLanes rays;
  uint_n none = (uint_n)(SUN_NONE);
  store_rays(&rays, direct->origin, direct->direction, direct->t_max, (real)(0.0f), none, none, scene->moment.time, direct->valid);
  mask open = direct->valid & !blocked_lanes(tree, &rays);
  vec3 worth = select3(open, direct->contribution, splat3((real)(0.0f)));
  vec3 wo = normalize3(negate3(direct->direction));
  real passed_t = (real)(0.0f);
  uint_n passed_instance = none, passed_primitive = none;
  while (SUN_PASSABLE && ANY(open)) {
    store_rays(&rays, direct->origin, direct->direction, direct->t_max, passed_t, passed_instance, passed_primitive, scene->moment.time, open);
    HitLanes hit;
    closest_lanes(tree, &rays, SUN_WANT_PASSABLE, &hit);
    open = open & hit.hit;
    if (!ANY(open)) break;
    worth = select3(open, mul3(worth, passed_share(scene, &hit, wo)), worth);
    open = open & (max_of3(worth) > 0.0f);
    passed_t = hit.t;
    passed_instance = hit.instance;
    passed_primitive = hit.primitive;
  }
  return worth;
}

// What LANES samples see. `film` may be 0: then what they see is the result alone.
SUN_BODY vec3 walk_trees(const Scene *scene, const TraceScene *tree, const FilmView *film, const PathNumber *place, const SamplerKey *sample_key,
                         const CameraRay *camera_of, mask active, uint *rays_traced) {
  const SUN_GLOBAL Frame *frame = scene->frame;
  const vec3 black = splat3((real)(0.0f));
  const uint_n none = (uint_n)(SUN_NONE);
  const SamplerKey key = *sample_key;
  const CameraRay camera = *camera_of;
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
  mask limited = active & !active, escaped = limited, layered = limited;
  uint top = 0;  // no lane waits at this level or above
  while (ANY(active)) {
    RayLanes rays;
    HitLanes hit;
    store_rays(&rays, now.origin, now.direction, (real)(SUN_INFINITY), now.passed_t, now.passed_instance, now.passed_primitive, scene->moment.time, active);
    closest_lanes(tree, &rays, SUN_WANT_ALL, &hit);
    hit.hit = active & hit.hit;
    if (film)
      for (int lane = 0; lane < LANES; lane++) rays_traced[0] += rays.on[lane] != 0;
    vec3 radiance = black;  // that reaches the ray's origin
    mask missed = active & !hit.hit;
    if (ANY(missed)) {
      mask shown = (frame->flags & SUN_FRAME_TRANSPARENT) ? missed & (now.depth != (uint_n)(0)) : missed;
      radiance = select3(shown, environment_radiance(&frame->environment, scene->environment_texels, now.direction), radiance);
      escaped = escaped | (missed & (now.depth == (uint_n)(0)));
    }
    mask through = active & !active, mirrored = through, straight = through;
    Branch onward = now, mirror = now;
    if (ANY(hit.hit)) {
      vec3 wo = negate3(now.direction);
      if (film && layers_wanted(frame)) {
        HitLanes first = hit;
        first.hit = hit.hit & (now.depth == (uint_n)(0)) & !layered;
        if (ANY(first.hit)) layered = layered | first_hit_layers(scene, film, &path, &first, wo, camera.weight);
      }
      Surface surface = make_surface(scene, &hit, wo);
      real alpha = surface_alpha(scene, &surface, hit.hit);
      straight = hit.hit & (alpha < 1.0f);
      if (ANY(straight)) straight = straight & (alpha <= hash_coin(&key, path.vertex, hit.instance, hit.primitive, 0));
      mask present = hit.hit & !straight;
      vec3 throughput = mul3(now.throughput, surface_absorption(scene, &surface, hit.t, present));
      now.throughput = select3(present, throughput, now.throughput);
      onward.throughput = now.throughput;
      radiance = select3(present, surface_emission(scene, &surface, present), radiance);
      mask unlit = (surface.material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != (uint_n)(0);
      mask scatters = present & !unlit;
      mask deep = scatters & (now.depth >= (uint_n)(frame->max_depth));
      if (ANY(scatters)) {
        Bsdf bsdf = surface_bsdf(scene, &surface, scatters);
        vec3 wo_local = to_local(&surface.shading, wo);
        Lobes lobes = bsdf_lobes(&bsdf, scene->tables, wo_local);
        mask lit = scatters & !deep;
        vec3 ambient = make_vec3((real)(frame->ambient[0]), (real)(frame->ambient[1]), (real)(frame->ambient[2]));
        vec3 diffuse = scale3(bsdf.base, (1.0f - bsdf.metallic) * (1.0f - bsdf.transmission));
        vec3 direct = mul3(ambient, diffuse);
        for (uint light = 0; light < frame->light_count; light++) {
          DirectSample sample = direct_from_light(scene, &surface, &lobes, wo_local, light, lit);
          if (!ANY(sample.valid)) continue;
          if (film) {
            int asked[LANES];
            int_n flags = sample.valid ? (int_n)(1) : (int_n)(0);
            LANES_STORE(flags, asked);
            for (int lane = 0; lane < LANES; lane++) rays_traced[1] += asked[lane] != 0;
          }
          direct = add3(direct, arriving(scene, tree, &sample));
        }
        // Light that this surface scatters is of the next depth; the ray's own depth has its emission.
        vec3 worth = mul3(now.throughput, direct);
        mask shines = lit & (max_of3(direct) > 0.0f);
        if (film && ANY(shines)) film_contribute_keyed(frame, film, shines, &path, SUN_FILM_KEY_DIRECT(path.vertex, 0u), now.depth + (uint_n)(1), worth);
        seen = select3(shines, add3(seen, worth), seen);

        Deltas deltas = lobes_deltas(&lobes, wo_local);
        real cutoff = (real)(frame->cutoff);
        vec3 mirror_local = make_vec3(-wo_local.x, -wo_local.y, wo_local.z);
        mirror.direction = normalize3(to_world(&surface.shading, mirror_local));
        mirror.throughput = mul3(now.throughput, deltas.reflected);
        mirror.origin = surface_origin(&surface, mirror.direction);
        mirror.depth = now.depth + (uint_n)(1);
        vec3 size = make_vec3(fabs(mirror.throughput.x), fabs(mirror.throughput.y), fabs(mirror.throughput.z));
        mirrored = scatters & (max_of3(size) > cutoff) & (dot3(mirror.direction, surface.normal) > 0.0f);
        vec3 passed = mul3(now.throughput, deltas.transmitted);
        size = make_vec3(fabs(passed.x), fabs(passed.y), fabs(passed.z));
        mask clear = scatters & (max_of3(size) > cutoff);
        mask null_event = clear & !bsdf.solid;  // smooth thin transmission: the same ray goes on, at no depth
        vec3 bent = normalize3(to_world(&surface.shading, deltas.wi_transmitted));
        clear = clear & (null_event | (dot3(bent, surface.normal) < 0.0f));
        through = clear & !null_event;
        straight = straight | null_event;
        onward.throughput = select3(clear, passed, onward.throughput);
        onward.direction = select3(through, bent, onward.direction);
        onward.origin = select3(through, surface_origin(&surface, bent), onward.origin);
        onward.depth = through ? now.depth + (uint_n)(1) : onward.depth;
        limited = limited | (deep & (mirrored | through));
        mirrored = mirrored & !deep;
        through = through & !deep;
      }
    }
    vec3 worth = mul3(now.throughput, radiance);
    mask shines = active & (max_of3(radiance) > 0.0f);
    if (film && ANY(shines)) film_contribute_lanes(frame, film, shines, &path, now.depth, worth);
    seen = select3(shines, add3(seen, worth), seen);
    path.vertex = path.vertex + (uint_n)(1);

    // Straight on: the same ray, strictly behind this hit.
    onward.passed_t = straight ? hit.t : (real)(0.0f);
    onward.passed_instance = straight ? hit.instance : none;
    onward.passed_primitive = straight ? hit.primitive : none;
    mirror.passed_t = (real)(0.0f);
    mirror.passed_instance = mirror.passed_primitive = none;
    mask goes = through | straight, waits = goes & mirrored;
    if (ANY(waits)) {
      Branch later = select_branch(straight, &onward, &mirror);
      for (uint k = 0; k < top; k++) {
        mask here = waits & (level == (uint_n)(k));
        if (ANY(here)) waiting[k] = select_branch(here, &later, &waiting[k]);
      }
      level = waits ? level + (uint_n)(1) : level;
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
      level = takes ? level - (uint_n)(1) : level;
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
  PathNumber place = path_number(frame, (uint_n)(begun) + within);
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
  PathNumber place = path_number(frame, (uint_n)(first) + uint_of_int((int_n)(LANE_NUMBERS)));
  SamplerKey key = sampler_key(frame->seed, place.picture_x, place.picture_y, place.sample, frame->sampler);
  at_moment(&scene, &key);
  CameraRay ray = camera_ray_at(frame, &key, real_of_uint(place.picture_x) + 0.5f, real_of_uint(place.picture_y) + 0.5f);
  vec3 seen = scale3(walk_trees(&scene, &tree, 0, &place, &key, &ray, place.inside, 0), (real)(scale));
  uint_n color = srgb_byte(seen.x) | (srgb_byte(seen.y) << (uint_n)(8)) | (srgb_byte(seen.z) << (uint_n)(16)) | (uint_n)(0xff000000u);
  uint colors[LANES], at[LANES];
  uint_n to = place.inside ? place.y * (uint_n)(frame->tile_width) + place.x : (uint_n)(SUN_NONE);
  LANES_STORE(color, colors);
  LANES_STORE(to, at);
  for (int lane = 0; lane < LANES; lane++)
    if (at[lane] != SUN_NONE) pixels[at[lane]] = colors[lane];
}

SUN_TRACE_KERNEL void whitted_view(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, SCENE_PARAMETERS, float scale, SUN_GLOBAL uint *pixels) {
  whitted_view_bundle(frame, TREE_ARGUMENTS, SCENE_ARGUMENTS, scale, pixels, (uint)get_global_id(0) * LANES);
}
