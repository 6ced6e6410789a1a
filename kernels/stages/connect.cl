// SPDX-License-Identifier: Apache-2.0
// connect: what a hit of an eye subpath adds to the film, by itself and joined with the light subpath of its sample, and where it goes next.
//   reads    hits; light vertices, of the slot or (SUN_MERGING) of the map, where those of each path stand together; every column of the path; the walk; status
//   writes   film; shadow rays; every column of the path; the walk; status
//   queues   rays -> rays, shadow_rays (by bits of the status): a slot's rays stand at numbers 0, 1 ... without gaps
//   holds    afterwards an eye subpath is alive with a ray to trace, or has ended with a reason, never both
//   source   [Veach97 10]; weights [Georgiev12 eq. 34-41, 43-45]
#include "path/contribute.h"
#include "path/queue.h"
#include "transport/connect.h"
#include "transport/emission.h"
#include "transport/step.h"

// The light subpath that belongs to each eye subpath: the records of its vertices.
typedef struct OwnVertices {
  uint_n first, step, count;
} OwnVertices;

SUN_FN OwnVertices own_vertices(const SUN_GLOBAL Frame *frame, const SUN_GLOBAL uint *path_starts, const Walk *walk, uint_n slot, mask active) {
  OwnVertices own;
  if (SUN_MERGING) {
    uint_n path = active ? walk->path - (uint_n)(1) : (uint_n)(0), begin = gather_uint(path_starts, path);
    own.first = begin * (uint_n)(SUN_LIGHT_VERTEX_RECORDS);
    own.step = (uint_n)(SUN_LIGHT_VERTEX_RECORDS);
    own.count = gather_uint(path_starts, path + (uint_n)(1)) - begin;
  } else {
    own.first = light_vertex_record(frame->pool, slot, (uint_n)(0));
    own.step = (uint_n)(frame->pool * SUN_LIGHT_VERTEX_RECORDS);
    own.count = walk->vertices;
  }
  return own;
}

// Appends a ray to those of its slot.
SUN_FN void append_ray(const Scene *scene, SUN_GLOBAL ShadowRay *shadow_rays, uint_n slot, const Path *path, vec3 throughput, const Connection *c, uint_n depth,
                       uint number, uint_n *shadows) {
  if (!ANY(c->valid)) return;
  ShadowLanes ray;
  ray.origin = c->origin;
  ray.direction = c->direction;
  ray.t_max = c->t_max;
  ray.contribution = mul3(throughput, c->contribution);
  ray.pixel = path->pixel;
  ray.sample = path->sample;
  ray.depth = depth;
  ray.vertex = path->vertex;
  ray.number = (uint_n)(number);
  ray.time = scene->moment.time;
  shadow_rays_store(shadow_rays, *shadows * (uint_n)(scene->frame->pool) + slot, c->valid, &ray);
  *shadows = *shadows + (c->valid ? (uint_n)(1) : (uint_n)(0));
}

// Weight of light that the subpath ran into after `depth` scatterings (s = 0) [Georgiev12 eq. 45]: `direct` is the density of a shadow ray to there, `emitted` that of a
// light subpath's first segment.
SUN_FN real run_into_weight(const SUN_GLOBAL Frame *frame, const Walk *walk, uint_n depth, real direct, real emitted) {
  real from_eye = heuristic_ratio(frame, direct) * walk->dVCM + heuristic_ratio(frame, emitted) * walk->dVC;
  from_eye = depth == (uint_n)(0) ? (real)(0.0f) : from_eye;
  return strategy_weight(frame, (uint_n)(0), depth + (uint_n)(2), (real)(0.0f), from_eye);
}

SUN_BODY void connect_bundle(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *walks, const SUN_GLOBAL uint *light_vertices,
                             const SUN_GLOBAL uint *path_starts, SUN_GLOBAL uint *status, const SUN_GLOBAL Hit *hits, SUN_GLOBAL ShadowRay *shadow_rays, const SUN_GLOBAL uint *rays, FilmCounts counts,
                             FilmWords film_words, uint first) {
  uint_n word;
  QueueLanes lanes = queue_lanes_with(rays, first, counts[SUN_COUNT_LIVE], status, SUN_STATUS_ALIVE | SUN_STATUS_LIGHT | SUN_STATUS_TURN, SUN_STATUS_ALIVE, &word);
  const mask active = lanes.active;
  if (!ANY(active)) return;
  Scene opened = open_scene(frame, SCENE_ARGUMENTS);
  const Scene *scene = &opened;
  FilmView film = open_film(frame, film_words, counts);
  Paths paths = open_paths(frame, path_words);
  Path path = path_load(&paths, lanes.slot);
  Walk walk = walk_load(walks, lanes.slot);
  HitLanes hit = load_hits(hits, lanes.slot, active);
  const uint_n zero = (uint_n)(0), one = (uint_n)(1), two = (uint_n)(2);
  uint_n depth = word & (uint_n)(SUN_STATUS_DEPTH);
  uint_n kept = word & (uint_n)(SUN_STATUS_FIRST_HIT);
  vec3 direction = path_direction(&path);
  vec3 throughput = path_throughput(&path);
  vec3 radiance = splat3((real)(0.0f)), arrived = throughput;
  SamplerKey key = path_key(frame, &path);
  at_moment(&opened, &key);

  const SUN_GLOBAL Environment *environment = &frame->environment;
  mask escaped = active & !hit.hit;
  if (frame->flags & SUN_FRAME_TRANSPARENT) escaped = escaped & (depth != zero);
  if (ANY(escaped) && environment->kind != SUN_ENVIRONMENT_NONE) {
    real direct = environment_emitter_pdf(scene, direction);
    real weight = run_into_weight(frame, &walk, depth, direct, direct / (SUN_PI * frame->scene_radius * frame->scene_radius));
    radiance = select3(escaped, scale3(environment_radiance(environment, scene->environment_texels, direction), weight), radiance);
  }
  uint_n next_word = (uint_n)(SUN_STATUS_ENDED | (SUN_ENDED_ESCAPED << SUN_STATUS_ENDED_SHIFT)) | depth | kept;

  mask found = active & hit.hit;
  if (ANY(found)) {
    vec3 wo = negate3(direction);
    Surface surface = make_surface(scene, &hit, wo);
    mask straight = surface_absent(scene, &surface, &hit, &key, path.vertex, found);
    mask present = found & !straight;
    throughput = mul3(throughput, surface_absorption(scene, &surface, hit.t, present));
    arrived = throughput;
    Walk there = walk;
    weights_arrive(frame, &there, hit.t, surface.cos_front);
    vec3 emission = surface_emission(scene, &surface, present);
    mask glowing = present & (max_of3(emission) > 0.0f);
    if (ANY(glowing)) {
      real direct = (real)(0.0f);
      if (frame->emitter_count > 0) direct = hit_emitter_pmf(scene, &hit, glowing) / (surface.area > 0.0f ? surface.area : (real)(1.0f));
      real emitted = direct * (side_share(&surface) * abs_cosine(surface.cos_front) * SUN_INV_PI);
      radiance = select3(glowing, scale3(emission, run_into_weight(frame, &there, depth, direct, emitted)), radiance);
    }
    mask unlit = (surface.material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != zero;
    mask limited = present & (depth >= (uint_n)(frame->max_depth));
    // At the limit a path may still go straight on through smooth thin glass, which is no scattering.
    mask passable = (surface.material_flags & (uint_n)(SUN_MATERIAL_PASSABLE)) != zero;
    mask scatters = present & !unlit & (!limited | passable);
    uint_n reason = glowing ? (uint_n)(SUN_ENDED_LIGHT) : limited ? (uint_n)(SUN_ENDED_DEPTH) : (uint_n)(SUN_ENDED_ABSORBED);
    mask turned = found & !found;
    uint_n shadows = zero;
    if (ANY(scatters)) {
      Bsdf bsdf = surface_bsdf(scene, &surface, scatters);
      vec3 wo_local = to_local(&surface.shading, wo);
      Lobes lobes = bsdf_lobes(&bsdf, scene->tables, wo_local);
      EyeVertex vertex;
      vertex.surface = &surface;
      vertex.lobes = &lobes;
      vertex.at = meeting_of(&surface, &bsdf);
      vertex.wo = wo;
      vertex.wo_local = wo_local;
      vertex.depth = depth;
      mask joins = scatters & !limited & !only_delta(&lobes);
      if (frame->emitter_count > 0 && ANY(joins)) {
        Connection c = connect_emitter(scene, &vertex, &there, sample_1d(&key, SUN_DIM_EMITTER(path.vertex)), sample_2d(&key, SUN_DIM_EMITTER_POINT(path.vertex)), joins);
        append_ray(scene, shadow_rays, lanes.slot, &path, throughput, &c, depth + one, 0, &shadows);
        OwnVertices own = own_vertices(frame, path_starts, &walk, lanes.slot, joins);
        for (uint number = 0;; number++) {
          mask some = joins & ((uint_n)(number) < own.count);
          if (!ANY(some)) break;
          LightVertex y = light_vertex_load(light_vertices, some ? own.first + (uint_n)(number) * own.step : zero);
          mask short_enough = some & (depth + y.depth + two <= (uint_n)(frame->max_depth));
          if (!ANY(short_enough)) continue;
          c = connect_vertices(scene, &vertex, &there, &y, short_enough);
          append_ray(scene, shadow_rays, lanes.slot, &path, throughput, &c, depth + y.depth + two, number + 1, &shadows);
        }
      }
      real u_lobe = sample_1d(&key, SUN_DIM_LOBE(path.vertex));
      vec2 u = sample_2d(&key, SUN_DIM_DIRECTION(path.vertex));
      Walk left = there;
      Scatter scatter = scatter_walk(scene, &surface, &vertex.at, &lobes, wo, wo_local, u_lobe, u, scatters & !limited, 0, &left);
      turned = scatters & !limited & scatter.valid & !scatter.straight;
      straight = straight | (scatters & scatter.valid & scatter.straight);
      throughput = select3(scatters & scatter.valid, mul3(throughput, scatter.weight), throughput);
      weights_turn(&walk, &left, turned);
      path_turn(&path, &scatter, turned);
    }
    path_pass(&path, &hit, turned, straight);
    next_word = found ? status_after(turned | straight, reason, shadows, turned ? depth + one : depth) | kept : next_word;
  }

  real sum = fabs(radiance.x) + fabs(radiance.y) + fabs(radiance.z);
  mask shines = active & !(sum == 0.0f);
  if (ANY(shines)) film_contribute_lanes(frame, &film, shines, &path, depth, mul3(arrived, radiance));
  path_set_throughput(&path, throughput);
  path.vertex = path.vertex + one;
  path_store(&paths, lanes.slot, active, &path);
  walk_store(walks, lanes.slot, active, &walk);
  store_uint(status, lanes.slot, active, next_word);
}

SUN_KERNEL void connect(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *walks, const SUN_GLOBAL uint *light_vertices,
                        const SUN_GLOBAL uint *path_starts, SUN_GLOBAL uint *status, const SUN_GLOBAL Hit *hits, SUN_GLOBAL ShadowRay *shadow_rays, const SUN_GLOBAL uint *rays, FilmCounts counts,
                        FilmWords film_words) {
  connect_bundle(frame, SCENE_ARGUMENTS, path_words, walks, light_vertices, path_starts, status, hits, shadow_rays, rays, counts, film_words, (uint)get_global_id(0) * LANES);
}
