// SPDX-License-Identifier: Apache-2.0
// shade: what a hit adds to the film, and where its path goes next.
//   reads    hits; every column of the path; status
//   writes   film; every column of the path; status; shadow rays where SUN_FRAME_DIRECT is set; the slot's stack where vertices branch
//   queues   rays -> rays, shadow_rays (by bits of the status; compact makes the queues)
//   holds    afterwards a path is alive with a ray to trace, or has ended with a reason, never both
//   source   [Kajiya86 eq. 1], weights [Veach97 9.2]
#include "path/contribute.h"
#include "path/path.h"
#include "path/queue.h"
#include "path/shadow_ray.h"
#if SUN_BRANCHING
#include "transport/branch.h"
#endif
#include "transport/direct.h"
#include "transport/emission.h"
#include "transport/photons.h"
#include "transport/scatter.h"
#include "transport/step.h"

SUN_FN void store_shadow_rays(SUN_GLOBAL ShadowRay *shadow_rays, uint_n slots, mask stored, const DirectSample *direct, vec3 worth, const Path *path,
                              uint_n depth, uint number, real time) {
  ShadowLanes ray;
  ray.origin = direct->origin;
  ray.direction = direct->direction;
  ray.t_max = direct->valid ? direct->t_max : (real)(-1.0f);
  ray.contribution = worth;
  ray.pixel = path->pixel;
  ray.sample = path->sample;
  ray.depth = depth;
  ray.vertex = path->vertex;
  ray.number = (uint_n)(number);
  ray.time = time;
  shadow_rays_store(shadow_rays, slots, stored, &ray);
}

SUN_BODY void shade_bundle(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status, const SUN_GLOBAL Hit *hits,
                           SUN_GLOBAL ShadowRay *shadow_rays, SUN_GLOBAL uint *branches, const SUN_GLOBAL uint *rays, FilmCounts counts, FilmWords film_words,
                           uint first) {
  uint_n word;
  QueueLanes lanes = queue_lanes_with(rays, first, counts[SUN_COUNT_LIVE], status, SUN_STATUS_ALIVE, SUN_STATUS_ALIVE, &word);
  const mask active = lanes.active;
  if (!ANY(active)) return;
  Scene opened = open_scene(frame, SCENE_ARGUMENTS);
  const Scene *scene = &opened;
  FilmView film = open_film(frame, film_words, counts);
  Paths paths = open_paths(frame, path_words);
  Path path = path_load(&paths, lanes.slot);
  HitLanes hit = load_hits(hits, lanes.slot, active);
  uint_n depth = word & (uint_n)(SUN_STATUS_DEPTH);
  uint_n kept = word & (uint_n)(SUN_STATUS_FIRST_HIT);
  vec3 direction = path_direction(&path);
  vec3 throughput = path_throughput(&path);
  SamplerKey key = path_key(frame, &path);
  at_moment(&opened, &key);  // before branches have numbers of their own: a tree of rays has one time
#if SUN_BRANCHING
  BranchState state = load_branch_state(frame, branches, lanes.slot);
  // A vertex that is taken up again: all it adds was added the first time; its next child is to come.
  mask again = active & ((word & (uint_n)(SUN_STATUS_AGAIN)) != (uint_n)(0));
  mask begins = active & !again & (path.vertex == (uint_n)(0));
  state.height = begins ? (uint_n)(0) : state.height;
  state.branch = begins ? (uint_n)(0) : state.branch;
  BranchVertex vertex;
  vertex.path = path;
  vertex.hit = hit;
  vertex.branch = state.branch;
  vertex.child = (uint_n)(0);
  vertex.word = depth;
  if (ANY(again)) {
    BranchVertex waiting = load_branch_vertex(frame, branches, lanes.slot, again, state.height - (uint_n)(1));
    vertex.branch = again ? waiting.branch : vertex.branch;
    vertex.child = again ? waiting.child : vertex.child;
  }
  key = branch_key(key, vertex.branch);
#else
  (void)branches;
  mask again = active & !active;
#endif

  vec3 radiance = splat3((real)(0.0f));  // that reaches the path's last vertex along this ray ...
  vec3 arrived = throughput;             // ... and what it is worth from there
#if SUN_PHOTONS
  real passed_pdf = path.pdf_solid_angle;
#endif
  mask escaped = active & !hit.hit;
  if (ANY(escaped)) {
    mask seen = (frame->flags & SUN_FRAME_TRANSPARENT) ? escaped & (depth != (uint_n)(0)) : escaped;
    radiance = escaped_emission(scene, direction, depth, path.pdf_solid_angle, seen);
  }
#if SUN_PHOTONS
  uint_n phase = (word & (uint_n)(SUN_STATUS_PHASE)) >> (uint_n)(SUN_STATUS_PHASE_SHIFT), last = (uint_n)(SUN_PHASE_LAST);
  mask ends = active & (phase == last);
#else
  mask ends = active & !active;
#endif
  uint_n next_word = (uint_n)(SUN_STATUS_ENDED | (SUN_ENDED_ESCAPED << SUN_STATUS_ENDED_SHIFT)) | depth | kept;

  mask found = active & hit.hit;
  if (ANY(found)) {
    vec3 wo = negate3(direction);
    Surface surface = make_surface(scene, &hit, wo);
    mask straight = surface_absent(scene, &surface, &hit, &key, path.vertex, found);
    mask present = found & !straight;
    throughput = mul3(throughput, surface_absorption(scene, &surface, hit.t, present));
    arrived = throughput;
    mask glowing;
    vec3 emission = hit_emission(scene, &surface, &hit, depth, path.pdf_solid_angle, present, &glowing);
    radiance = select3(present & !again, emission, radiance);
    mask unlit = (surface.material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != (uint_n)(0);
    mask limited = present & ((depth >= (uint_n)(frame->max_depth)) | ends);
    // At the limit a path may still go straight on through smooth thin glass, which is no scattering.
    mask passable = (surface.material_flags & (uint_n)(SUN_MATERIAL_PASSABLE)) != (uint_n)(0);
    mask scatters = present & !unlit & (!limited | passable);
    if (frame->flags & SUN_FRAME_END_ON_LIGHT) scatters = scatters & !glowing;
    // Why the path ends here, if it does.
    uint_n reason = glowing ? (uint_n)(SUN_ENDED_LIGHT) : (limited & !ends) ? (uint_n)(SUN_ENDED_DEPTH) : (uint_n)(SUN_ENDED_ABSORBED);
    mask turned = found & !found;
    uint_n shadows = (uint_n)(0);
    if (ANY(scatters)) {
      Bsdf bsdf = surface_bsdf(scene, &surface, scatters);
      vec3 wo_local = to_local(&surface.shading, wo);
      Lobes lobes = bsdf_lobes(&bsdf, scene->tables, wo_local);
      mask asks = scatters & !limited & !again;
      if (frame->flags & SUN_FRAME_FIRST) asks = asks & (depth == (uint_n)(0));
      if ((frame->flags & SUN_FRAME_DIRECT) && frame->emitter_count > 0 && ANY(asks)) {
        uint rays_a_vertex = frame->light_samples;
        real share = (real)(1.0f / (float)rays_a_vertex);
        SamplerKey light_key = key;
        for (uint number = 0; number < rays_a_vertex; number++) {
          light_key.sample = key.sample * (uint_n)(rays_a_vertex) + (uint_n)(number);  // further points of the same sequence
          real u_choice = sample_1d(&light_key, SUN_DIM_EMITTER(path.vertex));
          vec2 u_point = sample_2d(&light_key, SUN_DIM_EMITTER_POINT(path.vertex));
#if SUN_PHOTONS
          DirectSample direct = sample_direct_parts(scene, &surface, &lobes, phase, wo_local, u_choice, u_point, asks);
#else
          DirectSample direct = sample_direct(scene, &surface, &lobes, wo_local, u_choice, u_point, asks);
#endif
          vec3 worth = mul3(throughput, scale3(direct.contribution, share));
          store_shadow_rays(shadow_rays + (size_t)number * frame->pool, lanes.slot, rays_a_vertex > 1 ? asks : direct.valid, &direct, worth, &path,
                            depth + (uint_n)(1), number, scene->moment.time);
          shadows = shadows + (direct.valid ? (uint_n)(1) : (uint_n)(0));
        }
      }
      SamplerKey scatter_key = key;
#if SUN_BRANCHING
      uint_n place = again ? state.height - (uint_n)(1) : state.height;
      Children children = vertex_children(frame, &lobes, vertex.child, place, limited);
      scatters = scatters & (children.count > (uint_n)(0));
      mask splits = scatters & (children.count > (uint_n)(1));
      scatter_key.sample = key.sample * children.sharing + children.number;  // siblings are further points of the same sequence
      if (frame->flags & SUN_FRAME_EFFECTS) lobes = facets_alone(&lobes, children.through);
#endif
      real u_lobe = sample_1d(&scatter_key, SUN_DIM_LOBE(path.vertex));
      vec2 u = sample_2d(&scatter_key, SUN_DIM_DIRECTION(path.vertex));
#if SUN_PHOTONS
      mask sharp;
      lobes = next_lobes(frame, &lobes, phase, &u_lobe, &sharp);
      uint_n beyond = (frame->flags & SUN_FRAME_FINAL_GATHER) ? phase + (uint_n)(1) : last;
      phase = sharp ? phase : beyond;
#endif
      Scatter scatter = sample_scatter(scene, &surface, &lobes, bsdf.solid, wo_local, u_lobe, u);
#if SUN_BRANCHING
      scatter.weight = select3(splits, scale3(scatter.weight, 1.0f / real_of_uint(children.sharing)), scatter.weight);
      state.branch = splits ? branch_of_child(vertex.branch, path.vertex, vertex.child) : vertex.branch;
      vertex.child = vertex.child + (uint_n)(1);
      mask waits = splits & (vertex.child < children.count);
      if (ANY(waits)) store_branch_vertex(frame, branches, lanes.slot, waits, place, &vertex);
      state.height = splits ? place + (waits ? (uint_n)(1) : (uint_n)(0)) : state.height;
#endif
      turned = scatters & !limited & scatter.valid & !scatter.straight;
      straight = straight | (scatters & scatter.valid & scatter.straight);
      throughput = select3(scatters & scatter.valid, mul3(throughput, scatter.weight), throughput);
      path_turn(&path, &scatter, turned);
    }
    path_pass(&path, &hit, turned, straight);
    uint_n found_word = status_after(turned | straight, reason, shadows, turned ? depth + (uint_n)(1) : depth);
#if SUN_PHOTONS
    phase = turned ? phase : (word & (uint_n)(SUN_STATUS_PHASE)) >> (uint_n)(SUN_STATUS_PHASE_SHIFT);
    found_word = found_word | (turned | straight ? phase << (uint_n)(SUN_STATUS_PHASE_SHIFT) : (uint_n)(0));
#endif
    next_word = found ? found_word | kept : next_word;
  }

#if SUN_PHOTONS
  // Light that mirrors and glass send to the surface that looked at caustics.
  mask caustic = active & ((word & (uint_n)(SUN_STATUS_PHASE)) == (uint_n)(SUN_PHASE_FINAL << SUN_STATUS_PHASE_SHIFT)) & (passed_pdf <= 0.0f);
  radiance = select3(caustic, splat3((real)(0.0f)), radiance);
#endif
  real sum = fabs(radiance.x) + fabs(radiance.y) + fabs(radiance.z);
  mask shines = active & !(sum == 0.0f);
  if (ANY(shines)) {
    vec3 worth = mul3(arrived, radiance);
    film_contribute_lanes(frame, &film, shines, &path, depth, worth);
  }
  path_set_throughput(&path, throughput);
  path.vertex = path.vertex + (uint_n)(1);
  path_store(&paths, lanes.slot, active, &path);
#if SUN_BRANCHING
  store_branch_state(frame, branches, lanes.slot, active, &state);
#endif
  store_uint(status, lanes.slot, active, next_word);
}

SUN_KERNEL void shade(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *status, const SUN_GLOBAL Hit *hits,
                      SUN_GLOBAL ShadowRay *shadow_rays, SUN_GLOBAL uint *branches, const SUN_GLOBAL uint *rays, FilmCounts counts, FilmWords film_words) {
  shade_bundle(frame, SCENE_ARGUMENTS, path_words, status, hits, shadow_rays, branches, rays, counts, film_words, (uint)get_global_id(0) * LANES);
}
