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

// What is known beforehand of lanes that are shaded at once. What this rules out is left out when the kernel is compiled; the numbers are the same.
#define SUN_GROUP_ANY 0
#define SUN_GROUP_MATT 1   // one shape, and nothing but diffuse
#define SUN_GROUP_CLEAR 2  // one shape, and nothing but smooth solid glass
#define SUN_GROUP_GLOSS 3  // one shape, and a smooth coat over what is diffuse

typedef struct Group {
  HitLanes hit;
  int alike;  // all lanes, those that are off included, carry one shape, whose records are read once
  int kind;
} Group;

// Lanes that hit one shape, or all that hit triangles. Takes them out of `left`.
SUN_FN Group take_group(const Scene *scene, const TraceScene *tree, const HitLanes *hit, mask *left) {
  Group group;
  group.hit = *hit;
  group.hit.hit = *left;
  group.alike = 0;
  group.kind = SUN_GROUP_ANY;
  if (SUN_FEW_SHAPES) {
    const uint first_shape = scene->frame->first_shape, number = some_lane(*left, hit->instance);
    group.alike = !SUN_TRIANGLES || number >= first_shape;
    const mask same = group.alike ? hit->instance == (uint_n)(number) : hit->instance < (uint_n)(first_shape);
    group.hit.hit = *left & same;
    if (group.alike) {
      const uint primitive = tree->roots[number];
      const SUN_GLOBAL Material *material = &scene->materials[scene->triangles[primitive].material];
      group.hit.instance = (uint_n)(number);
      group.hit.primitive = (uint_n)(primitive);
      const uint flags = material->flags, solid = flags & SUN_MATERIAL_VOLUME;
      const int plain = !(flags & SUN_MATERIAL_TEXTURED) && material->metallic == 0.0f && material->roughness * material->roughness < SUN_ALPHA_SMOOTH;
      if (!(flags & SUN_MATERIAL_SPECULAR)) group.kind = SUN_GROUP_MATT;
      else if (plain && solid && material->transmission == 1.0f) group.kind = SUN_GROUP_CLEAR;
      else if (plain && !solid && material->transmission == 0.0f) group.kind = SUN_GROUP_GLOSS;
    }
  }
  *left = *left & !group.hit.hit;
  return group;
}

// The trees of LANES samples.
typedef struct Trees {
  Branch now;
  vec3 seen;
  uint_n level;    // lanes wait at levels of their own: how many rays wait
  uint top;        // no lane waits at this level or above
  mask on;         // lanes whose `now` is a ray that is to be followed
  mask limited;    // rays were left out, being too deep
} Trees;

// Adds what LANES rays bring, of the trees in `shines`.
SUN_FN void see(const SUN_GLOBAL Frame *frame, const FilmView *film, const Path *path, Trees *trees, mask shines, vec3 radiance) {
  vec3 worth = mul3(trees->now.throughput, radiance);
  shines = shines & (max_of3(radiance) > 0.0f);
  if (film && ANY(shines)) film_contribute_lanes(frame, film, shines, path, trees->now.depth, worth);
  trees->seen = select3(shines, add3(trees->seen, worth), trees->seen);
}

// One lane's ray waits in waiting[k], k below its level.
SUN_FN void put_aside(Branch *waiting, Trees *trees, mask waits, const Branch *later) {
  if (!ANY(waits)) return;
  for (uint k = 0; k < trees->top; k++) {
    mask here = waits & (trees->level == (uint_n)(k));
    if (ANY(here)) waiting[k] = select_branch(here, later, &waiting[k]);
  }
  trees->level = waits ? trees->level + (uint_n)(1) : trees->level;
  if (ANY(trees->level > (uint_n)(trees->top))) waiting[trees->top++] = *later;
}

SUN_FN void take_up(const Branch *waiting, Trees *trees, mask takes) {
  if (!ANY(takes)) return;
  for (uint k = 0; k < trees->top; k++) {
    mask here = takes & (trees->level == (uint_n)(k + 1));
    if (ANY(here)) trees->now = select_branch(here, &waiting[k], &trees->now);
  }
  trees->level = takes ? trees->level - (uint_n)(1) : trees->level;
  while (trees->top > 0 && !ANY(trees->level >= (uint_n)(trees->top))) trees->top--;
}

// What the surfaces of a group emit and scatter is seen, and the rays that leave them are to be followed.
SUN_INLINE void shade_group(const Scene *opened, const TraceScene *tree, const FilmView *film, const Path *path, const SamplerKey *key, const Group *group, int alike,
                            int kind, Branch *waiting, Trees *trees, uint *rays_traced) {
  Scene of_group = *opened;
  of_group.alike = alike;
  const Scene *scene = &of_group;
  const SUN_GLOBAL Frame *frame = scene->frame;
  const HitLanes *hit = &group->hit;
  const mask all = !(mask)(0), nowhere = (mask)(0);
  const uint_n none = (uint_n)(SUN_NONE), one = (uint_n)(1);
  const real cutoff = (real)(frame->cutoff);
  Branch *now = &trees->now;
  vec3 wo = negate3(now->direction);
  // Where the ray is at hand it tells more of a shape's place than u and v, which are rounded.
#if SUN_SHAPES && !SUN_MOTION
  vec3 place = place_of_meeting(scene, hit->instance, place_along(now->origin, now->direction, hit->t));
  Surface surface = surface_at(scene, hit, &place, wo);
#else
  Surface surface = make_surface(scene, hit, wo);
#endif
  mask present = hit->hit, straight = nowhere;
  if (SUN_PASSABLE) {
    real alpha = surface_alpha(scene, &surface, hit->hit);
    mask passed = hit->hit & (alpha < 1.0f);
    if (ANY(passed)) passed = passed & (alpha <= hash_coin(key, path->vertex, hit->instance, hit->primitive, 0));
    straight = passed;
    present = present & !passed;
  }
  now->throughput = select3(present, mul3(now->throughput, surface_absorption(scene, &surface, hit->t, present)), now->throughput);
  mask unlit = (surface.material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != (uint_n)(0);
  mask scatters = present & !unlit;
  mask deep = scatters & (now->depth >= (uint_n)(frame->max_depth));
  Branch onward = *now, mirror = *now;
  mask through = nowhere, mirrored = nowhere;
  if (ANY(scatters)) {
    Bsdf bsdf = surface_bsdf(scene, &surface, scatters);
    if (kind == SUN_GROUP_MATT) {
      bsdf.specular = bsdf.solid = nowhere;
      bsdf.metallic = bsdf.transmission = (real)(0.0f);
    }
    if (kind == SUN_GROUP_CLEAR || kind == SUN_GROUP_GLOSS) {
      bsdf.specular = all;
      bsdf.solid = kind == SUN_GROUP_CLEAR ? all : nowhere;
      bsdf.metallic = bsdf.alpha = (real)(0.0f);
      bsdf.transmission = (real)(kind == SUN_GROUP_CLEAR ? 1.0f : 0.0f);
    }
    vec3 wo_local = to_local(&surface.shading, wo);
    Lobes lobes = bsdf_lobes(&bsdf, scene->tables, wo_local);
    mask lit = scatters & !deep;
    vec3 diffuse = scale3(bsdf.base, (1.0f - bsdf.metallic) * (1.0f - bsdf.transmission));
    vec3 direct = mul3(make_vec3((real)(frame->ambient[0]), (real)(frame->ambient[1]), (real)(frame->ambient[2])), diffuse);
    mask spread = lit & lobes_spread(&lobes);
    for (uint light = 0; ANY(spread) && light < frame->light_count; light++) {
      DirectSample sample = direct_from_light(scene, &surface, &lobes, wo_local, light, spread);
      if (!ANY(sample.valid)) continue;
      if (film) rays_traced[1] += count_lanes(sample.valid);
      direct = add3(direct, arriving(scene, tree, &sample));
    }
    // Light that this surface scatters is of the next depth; the ray's own depth has its emission.
    vec3 worth = mul3(now->throughput, direct);
    mask shines = lit & (max_of3(direct) > 0.0f);
    if (film && ANY(shines)) film_contribute_keyed(frame, film, shines, path, SUN_FILM_KEY_DIRECT(path->vertex, 0u), now->depth + one, worth);
    trees->seen = select3(shines, add3(trees->seen, worth), trees->seen);
    if (ANY(scatters & lobes.specular)) {
      const vec3 normal = surface.shading.normal;
      Deltas deltas = lobes_deltas(&lobes, wo_local.z);
      vec3 reflected = mul3(now->throughput, deltas.reflected);
      vec3 size = make_vec3(fabs(reflected.x), fabs(reflected.y), fabs(reflected.z));
      mask returned = scatters & (max_of3(size) > cutoff);
      if (ANY(returned)) {
        mirror.direction = mirror_about(wo, normal);
        returned = returned & (dot3(mirror.direction, surface.normal) > 0.0f);
        mirror.origin = surface_origin(&surface, mirror.direction);
        mirror.throughput = reflected;
        mirrored = returned & !deep;
        trees->limited = trees->limited | (returned & deep);
      }
      vec3 passed = mul3(now->throughput, deltas.transmitted);
      size = make_vec3(fabs(passed.x), fabs(passed.y), fabs(passed.z));
      mask clear = scatters & (max_of3(size) > cutoff);
      if (ANY(clear)) {
        mask null_event = clear & !bsdf.solid;  // smooth thin transmission: the same ray goes on, at no depth
        vec3 bent = select3(deltas.straight, now->direction, refract_about(wo, normal, lobes.inverse_eta, wo_local.z, deltas.cosine_far));
        clear = clear & (null_event | (dot3(bent, surface.normal) < 0.0f));
        mask enters = clear & bsdf.solid;
        onward.throughput = select3(clear, passed, onward.throughput);
        onward.direction = select3(enters, bent, onward.direction);
        onward.origin = select3(enters, surface_origin(&surface, bent), onward.origin);
        onward.depth = enters ? now->depth + one : onward.depth;
        if (SUN_PASSABLE) straight = straight | null_event;
        through = enters & !deep;
        trees->limited = trees->limited | (enters & deep);
      }
    }
  }
  mask shining = present & ((surface.material_flags & (uint_n)(SUN_MATERIAL_EMISSIVE)) != (uint_n)(0));
  if (ANY(shining)) see(frame, film, path, trees, shining, surface_emission(scene, &surface, shining));
  if (!ANY(straight | through | mirrored)) return;

  // Straight on: the same ray, strictly behind this hit.
  mirror.depth = now->depth + one;
  if (SUN_PASSABLE) {
    onward.passed_t = straight ? hit->t : (real)(0.0f);
    onward.passed_instance = straight ? hit->instance : none;
    onward.passed_primitive = straight ? hit->primitive : none;
    mirror.passed_t = (real)(0.0f);
    mirror.passed_instance = mirror.passed_primitive = none;
  }
  mask goes = through | straight;
  Branch later = select_branch(straight, &onward, &mirror);
  put_aside(waiting, trees, goes & mirrored, &later);
  onward = select_branch(mirrored & (straight | !goes), &mirror, &onward);
  *now = select_branch(goes | mirrored, &onward, now);
  trees->on = trees->on | goes | mirrored;
}

// What LANES samples see. `film` may be 0: then what they see is the result alone.
SUN_INLINE vec3 walk_trees(const Scene *scene, const TraceScene *tree, const FilmView *film, const PathNumber *place, const SamplerKey *key,
                           const CameraRay *camera, mask active, uint *rays_traced) {
  const SUN_GLOBAL Frame *frame = scene->frame;
  const uint_n none = (uint_n)(SUN_NONE), zero = (uint_n)(0);
  const mask nowhere = (mask)(0);
  Path path;
  path.pixel = place->y * (uint_n)(frame->tile_width) + place->x;
  path.sample = place->sample;
  path.vertex = zero;
  Branch waiting[SUN_WHITTED_DEPTH];
  Trees trees;
  trees.now.origin = camera->origin;
  trees.now.direction = camera->direction;
  trees.now.throughput = splat3(camera->weight);
  trees.now.depth = zero;
  trees.now.passed_t = (real)(0.0f);
  trees.now.passed_instance = trees.now.passed_primitive = none;
  trees.seen = splat3((real)(0.0f));
  trees.level = zero;
  trees.top = 0;
  trees.limited = nowhere;
  uint_n deepest = zero;
  mask escaped = nowhere, layered = nowhere;
  while (ANY(active)) {
    Rays rays = fresh_rays(trees.now.origin, trees.now.direction, (real)(SUN_INFINITY), scene->moment.time);
    if (SUN_PASSABLE) {
      rays.passed_t = trees.now.passed_t;
      rays.passed_instance = trees.now.passed_instance;
      rays.passed_primitive = trees.now.passed_primitive;
    }
    HitLanes hit = closest_lanes(frame, tree, &rays, active, SUN_WANT_ALL);
    if (film) rays_traced[0] += count_lanes(active);
    mask missed = active & !hit.hit;
    if (ANY(missed)) {
      mask first = trees.now.depth == zero;
      mask shown = (frame->flags & SUN_FRAME_TRANSPARENT) ? missed & !first : missed;
      see(frame, film, &path, &trees, shown, environment_radiance(&frame->environment, scene->environment_texels, trees.now.direction));
      escaped = escaped | (missed & first);
    }
    if (film && layers_wanted(frame)) {
      HitLanes first = hit;
      first.hit = hit.hit & (trees.now.depth == zero) & !layered;
      if (ANY(first.hit)) layered = layered | first_hit_layers(scene, film, &path, &first, negate3(trees.now.direction), camera->weight);
    }
    trees.on = nowhere;
    for (mask left = hit.hit; ANY(left);) {
      Group group = take_group(scene, tree, &hit, &left);
      if (SUN_FEW_SHAPES && group.kind == SUN_GROUP_MATT)
        shade_group(scene, tree, film, &path, key, &group, 1, SUN_GROUP_MATT, waiting, &trees, rays_traced);
      else if (SUN_FEW_SHAPES && SUN_SPECULAR && group.kind == SUN_GROUP_CLEAR)
        shade_group(scene, tree, film, &path, key, &group, 1, SUN_GROUP_CLEAR, waiting, &trees, rays_traced);
      else if (SUN_FEW_SHAPES && SUN_SPECULAR && group.kind == SUN_GROUP_GLOSS)
        shade_group(scene, tree, film, &path, key, &group, 1, SUN_GROUP_GLOSS, waiting, &trees, rays_traced);
      else
        shade_group(scene, tree, film, &path, key, &group, SUN_TRIANGLES ? group.alike : SUN_FEW_SHAPES, SUN_GROUP_ANY, waiting, &trees, rays_traced);
    }
    path.vertex = path.vertex + (uint_n)(1);
    mask takes = active & !trees.on & (trees.level != zero);
    take_up(waiting, &trees, takes);
    active = active & (trees.on | takes);
    deepest = (active & (trees.now.depth > deepest)) ? trees.now.depth : deepest;
  }
  if (film) {
    uint inside[LANES], reason[LANES], depth[LANES];
    uint_n flags = place->inside ? (uint_n)(1) : (uint_n)(0);
    uint_n why = trees.limited ? (uint_n)(SUN_ENDED_DEPTH) : escaped ? (uint_n)(SUN_ENDED_ESCAPED) : (uint_n)(SUN_ENDED_ABSORBED);
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
  return trees.seen;
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
