// SPDX-License-Identifier: Apache-2.0
// deposit: what a hit of a light subpath leaves behind, and where the subpath goes next.
//   reads    hits; every column of the path; the walk; status
//   writes   light vertices; a shadow ray to the lens; every column of the path; the walk; status
//   queues   rays -> rays, shadow_rays (by bits of the status)
//   holds    afterwards a light subpath has a ray to trace, or its slot waits for emit to begin the eye subpath (in a light pass: is free)
//   source   [Lafortune93]; weights [Georgiev12 eq. 34-36, 46]; shading normals [Veach97 5.3.2]
#include "path/contribute.h"
#include "path/queue.h"
#include "transport/connect.h"
#include "transport/step.h"

// Triangles of one side let eyes look through from behind, so light passes them from the front as well as being scattered there; which, a coin decides. Rarely,
// as there is seldom anything behind; not so rarely that what is there gets a few photons of great weight (docs/decisions/0006).
#define SUN_PASSES_ONE_SIDED 0.125f

SUN_BODY void deposit_bundle(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *walks, SUN_GLOBAL uint *light_vertices,
                             SUN_GLOBAL uint *status, const SUN_GLOBAL Hit *hits, SUN_GLOBAL ShadowRay *shadow_rays, const SUN_GLOBAL uint *rays,
                             const SUN_GLOBAL uint *counts, uint first) {
  uint_n word;
  QueueLanes lanes = queue_lanes_with(rays, first, counts[SUN_COUNT_LIVE], status, SUN_STATUS_ALIVE | SUN_STATUS_LIGHT, SUN_STATUS_ALIVE | SUN_STATUS_LIGHT, &word);
  const mask active = lanes.active;
  if (!ANY(active)) return;
  Scene opened = open_scene(frame, SCENE_ARGUMENTS);
  const Scene *scene = &opened;
  Paths paths = open_paths(frame, path_words);
  Path path = path_load(&paths, lanes.slot);
  Walk walk = walk_load(walks, lanes.slot);
  HitLanes hit = load_hits(hits, lanes.slot, active);
  const uint_n walking = (uint_n)(SUN_STATUS_ALIVE | SUN_STATUS_LIGHT), zero = (uint_n)(0), one = (uint_n)(1);
  uint_n depth = word & (uint_n)(SUN_STATUS_DEPTH);
  const uint alone = frame->flags & SUN_FRAME_LIGHT_PASS, photons = frame->flags & SUN_FRAME_PHOTONS;
  uint_n next_word = (uint_n)(alone ? 0u : SUN_STATUS_ALIVE | SUN_STATUS_TURN);
  mask found = active & hit.hit;
  if (ANY(found)) {
    SamplerKey key = path_key(frame, &path);
    at_moment(&opened, &key);
    vec3 wo = negate3(path_direction(&path));
    vec3 throughput = path_throughput(&path);
    Surface surface = make_surface(scene, &hit, wo);
    real transmission;
    GATHER_FLOAT(transmission, scene->materials, surface.material, transmission);
    mask one_sided = found & ((surface.material_flags & (uint_n)(SUN_MATERIAL_DOUBLE_SIDED | SUN_MATERIAL_VOLUME)) == zero) & !(transmission > 0.0f);
    mask absent = surface_absent(scene, &surface, &hit, &key, path.vertex, found);
    mask unlit = (surface.material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != zero;
    mask scatters = found & !absent & !unlit & !(one_sided & !surface.front);
    Bsdf bsdf = surface_bsdf(scene, &surface, scatters);
    vec3 wo_local = to_local(&surface.shading, wo);
    Lobes lobes = bsdf_lobes(&bsdf, scene->tables, wo_local);
    scatters = scatters & has_lobes(&lobes);
    // Through the front of what has one side.
    mask through = one_sided & surface.front;
    real chance = unlit | (found & !absent & !scatters) ? (real)(1.0f) : (real)(SUN_PASSES_ONE_SIDED);
    mask passes = through & (chance >= 1.0f);
    if (ANY(through)) passes = passes | (through & (hash_coin(&key, path.vertex, hit.instance, hit.primitive, 1) < chance));
    throughput = select3(through, scale3(throughput, 1.0f / (passes ? chance : 1.0f - (chance < 1.0f ? chance : (real)(0.0f)))), throughput);
    scatters = scatters & !passes;
    mask straight = passes | (absent & !through);
    // What the solid that the ray left into has absorbed: on the eye's way that is found when it hits there.
    mask within = scatters & (max_of3(walk.absorption) > 0.0f);
    if (ANY(within)) {
      vec3 a = walk.absorption;
      vec3 left = make_vec3(exp_real(-a.x * hit.t), exp_real(-a.y * hit.t), exp_real(-a.z * hit.t));
      throughput = select3(within, mul3(throughput, left), throughput);
    }
    uint_n shadows = zero;
    mask turned = found & !found;
    if (ANY(scatters)) {
      Walk arrived = walk;
      weights_arrive(frame, &arrived, hit.t, surface.cos_front);
      LightVertex vertex;
      vertex.at = meeting_of(&surface, &bsdf);
      vertex.to_light = wo;
      vertex.flux = mul3(throughput, walk.emitted);
      vertex.dVCM = arrived.dVCM;
      vertex.dVC = arrived.dVC;
      vertex.dVM = arrived.dVM;
      vertex.depth = depth;
      vertex.material = surface.material;
      vertex.front = surface.front;
      vertex.caustic = (depth > zero) & (walk.rough == zero);
      vertex.unseen = vertex.caustic & walk.unseen;
      mask joins = scatters & !only_delta(&lobes);
      Splat splat;
      splat.ray.valid = joins & !joins;
      if (!photons) splat = connect_lens(scene, &vertex, sample_2d(&key, SUN_DIM_EMITTER_POINT(path.vertex)), sample_1d(&key, SUN_DIM_EMITTER(path.vertex)), joins);
      mask seen = splat.ray.valid;
      if (ANY(seen)) {
        ShadowLanes ray;
        ray.origin = splat.ray.origin;
        ray.direction = splat.ray.direction;
        ray.t_max = splat.ray.t_max;
        ray.contribution = splat.ray.contribution;
        ray.pixel = splat.y * (uint_n)(frame->tile_width) + splat.x;
        ray.sample = path.sample;
        ray.depth = depth + one;
        ray.vertex = hash_step(key.pixel_hash, path.vertex);  // keys the rounding of the film: many light subpaths may meet in a pixel
        ray.number = zero;
        ray.time = scene->moment.time;
        shadow_rays_store(shadow_rays, lanes.slot, seen, &ray);
        shadows = seen ? one : zero;
      }
      // Joined by an edge a path scatters at both of its ends, merged in one point once. What lights send straight to a surface is asked of them there, not of photons.
      mask joined = joins & (depth + (uint_n)(alone ? 1u : 2u) <= (uint_n)(frame->max_depth)) & (depth >= (uint_n)(photons ? 1u : 0u));
      // At the limit it may still go straight on through smooth thin glass, which is no scattering.
      mask limited = depth + one >= (uint_n)(frame->max_depth);
      real u_lobe = sample_1d(&key, SUN_DIM_LOBE(path.vertex));
      vec2 u = sample_2d(&key, SUN_DIM_DIRECTION(path.vertex));
      Walk left = arrived;
      Scatter scatter = scatter_walk(scene, &surface, &vertex.at, &lobes, wo, wo_local, u_lobe, u, scatters & !limited, 1, &left);
      turned = scatters & !limited & scatter.valid & !scatter.straight;
      mask clear = scatters & scatter.valid & scatter.straight;
      straight = straight | clear;
      // Where a vertex of this depth is stored already, before something that the ray went straight on through, the next is stored only if the ray does not do so again, and
      // weighs more: so there are two at most, however many panes there are.
      mask clears = walk.holds & lobes.delta_transmission & !bsdf.solid;
      if (ANY(clears)) {
        real chance_left = clears ? 1.0f - delta_chance(&lobes, wo_local.z, clears) : (real)(1.0f);
        joined = joined & !(clears & clear) & (chance_left > 0.0f);
        vertex.flux = scale3(vertex.flux, 1.0f / (chance_left > 0.0f ? chance_left : (real)(1.0f)));
      }
      vertex.presence = alone ? surface_alpha(scene, &surface, joined) : (real)(1.0f);
      vertex.presence = joined ? vertex.presence : (real)(1.0f);
      if (ANY(joined)) {
        light_vertex_store(light_vertices, light_vertex_record(frame->pool, lanes.slot, walk.vertices), joined, &vertex);
        walk.vertices = walk.vertices + (joined ? one : zero);
        walk.holds = walk.holds | joined;
      }
      throughput = select3(turned | clear, mul3(throughput, scatter.weight), throughput);
      weights_turn(&walk, &left, turned);
      walk.holds = walk.holds & !turned;
      walk.rough = walk.rough + ((turned & (scatter.pdf_solid_angle > 0.0f)) ? one : zero);
      vec3 absorbs;
      GATHER_VEC3(absorbs, scene->materials, surface.material, absorption[0]);
      mask inner = bsdf.solid & ((dot3(scatter.direction, surface.normal) > 0.0f) != surface.front);
      walk.absorption = select3(turned, select3(inner, absorbs, splat3((real)(0.0f))), walk.absorption);
      path_turn(&path, &scatter, turned);
    }
    path_pass(&path, &hit, turned, straight);
    path_set_throughput(&path, throughput);
    mask alive = turned | straight;
    next_word = alive ? walking | (turned ? depth + one : depth) : next_word;
    next_word = next_word | (shadows != zero ? (uint_n)(SUN_STATUS_SHADOW) | (shadows << (uint_n)(SUN_STATUS_SHADOWS_SHIFT)) : zero);
  }
  path.vertex = path.vertex + one;
  path_store(&paths, lanes.slot, active, &path);
  walk_store(walks, lanes.slot, active, &walk);
  store_uint(status, lanes.slot, active, next_word);
}

SUN_KERNEL void deposit(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *walks, SUN_GLOBAL uint *light_vertices,
                        SUN_GLOBAL uint *status, const SUN_GLOBAL Hit *hits, SUN_GLOBAL ShadowRay *shadow_rays, const SUN_GLOBAL uint *rays,
                        const SUN_GLOBAL uint *counts) {
  deposit_bundle(frame, SCENE_ARGUMENTS, path_words, walks, light_vertices, status, hits, shadow_rays, rays, counts, (uint)get_global_id(0) * LANES);
}
