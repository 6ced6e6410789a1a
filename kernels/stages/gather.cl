// SPDX-License-Identifier: Apache-2.0
// gather: what photons around the hit of an eye path add to the film. The path itself is left to shade (or connect), which comes next.
//   reads    hits; every column of the path; the walk; status; a light map
//   writes   film
//   queues   rays
//   holds    a path looks at each map once, at a surface that is not only sharp; a photon counts for the bounce that its scatterings, the path's and this one make
//            (SUN_MERGING: at every surface, weighted against the strategies that join)
//   source   [Jensen96] [Hachisuka09 eq. 4]; the kernel of [Epanechnikov69]; weights [Georgiev12 eq. 38, 39]
#include "path/contribute.h"
#include "path/queue.h"
#include "transport/connect.h"
#include "transport/light_map.h"
#include "transport/photons.h"
#include "transport/step.h"

SUN_BODY void gather_bundle(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, const SUN_GLOBAL uint *path_words, const SUN_GLOBAL uint *walks,
                            const SUN_GLOBAL uint *status, const SUN_GLOBAL Hit *hits, LIGHT_MAP_PARAMETERS, uint phase, const SUN_GLOBAL uint *rays, FilmCounts counts, FilmWords film_words, uint first) {
  uint_n word;
  QueueLanes lanes = queue_lanes_with(rays, first, counts[SUN_COUNT_LIVE], status, SUN_STATUS_ALIVE | SUN_STATUS_PHASE, SUN_STATUS_ALIVE | (phase << SUN_STATUS_PHASE_SHIFT), &word);
  uint_n depth = word & (uint_n)(SUN_STATUS_DEPTH);
  mask active = lanes.active & (depth < (uint_n)(frame->max_depth));
  if (!ANY(active)) return;
  Scene opened = open_scene(frame, SCENE_ARGUMENTS);
  const Scene *scene = &opened;
  Paths paths = open_paths(frame, (SUN_GLOBAL uint *)path_words);
  Path path = path_load(&paths, lanes.slot);
  HitLanes hit = load_hits(hits, lanes.slot, active);
  mask found = active & hit.hit;
  if (!ANY(found)) return;
  SamplerKey key = path_key(frame, &path);
  at_moment(&opened, &key);
  vec3 wo = negate3(path_direction(&path));
  Surface surface = make_surface(scene, &hit, wo);
  mask unlit = (surface.material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != (uint_n)(0);
  mask gathers = found & !surface_absent(scene, &surface, &hit, &key, path.vertex, found) & !unlit;
  if (!ANY(gathers)) return;
  Bsdf bsdf = surface_bsdf(scene, &surface, gathers);
  Side side;
  side.shading = surface.shading;
  side.normal = surface.normal;
  side.wo_local = to_local(&surface.shading, wo);
  Lobes lobes = bsdf_lobes(&bsdf, scene->tables, side.wo_local);
  side.lobes = SUN_MERGING ? lobes : gathering_lobes(frame, &lobes, (uint_n)(phase));
  mask blurred = gathers & !gathers;
  if (!SUN_MERGING) blurred = gathers & blurred_facets(frame, &lobes, (uint_n)(phase));
  Side facets = side;
  facets.lobes = lobes_part(&lobes, blurred, blurred & !blurred);
  gathers = gathers & (SUN_MERGING ? !only_delta(&lobes) : has_lobes(&side.lobes) | blurred);
  if (!ANY(gathers)) return;
  Walk walk;
  EyeVertex vertex;
  if (SUN_MERGING) {
    walk = walk_load(walks, lanes.slot);
    weights_arrive(frame, &walk, hit.t, surface.cos_front);
    vertex.at = meeting_of(&surface, &bsdf);
    vertex.wo = wo;
  }

  // Sums by the photons' depth, as each bounce is rounded by itself.
  float sums[SUN_MOST_BIDIRECTIONAL_DEPTH][3][LANES];
  for (uint d = 0; d < frame->max_depth; d++)
    for (int c = 0; c < 3; c++)
      for (int lane = 0; lane < LANES; lane++) sums[d][c][lane] = 0.0f;
  LightMap map = open_light_map(LIGHT_MAP_ARGUMENTS);
  MapQueries queries;
  map_begin(&map, &queries, surface.position, select3(surface.front, surface.normal, negate3(surface.normal)), bsdf.solid, gathers);
  uint most[LANES];
  uint_n most_depth = (uint_n)(frame->max_depth - 1) - depth;
  LANES_STORE(most_depth, most);
  for (;;) {
    uint_n number;
    mask some = map_next(&map, &queries, &number);
    if (!ANY(some)) break;
    LightVertex photon = light_vertex_arrival(map.vertices, number * (uint_n)(map.records));
    vec3 to = sub3(photon.at.position, surface.position);
    BsdfEval eval = side_eval(scene, &side, photon.to_light);
    mask unseen = some & blurred & photon.unseen;
    if (ANY(unseen)) eval.f_cos = add3(eval.f_cos, select3(unseen, side_eval(scene, &facets, photon.to_light).f_cos, splat3((real)(0.0f))));
    // f cos counts the shading normals' cosine here, flux the true one where the photon arrived: so its own normal, as the density that brought it there has it
    // [Georgiev12], though that is unbounded at grazing light. By the normal here it would be bounded, and wrong where facets meet: Photons.ABallLitFromTheSide.
    real weight = (1.0f - dot3(to, to) / (map.radius * map.radius)) / max_real(fabs(dot3(photon.to_light, photon.at.normal)), (real)(SUN_LEAST_COSINE)) / photon.presence;
    if (SUN_MERGING) {
      real from_light = earlier_than_merging(frame, photon.dVCM, photon.dVM, eval.pdf);
      real from_eye = earlier_than_merging(frame, walk.dVCM, walk.dVM, eye_reverse_pdf(scene, &vertex, photon.to_light));
      weight = weight / (1.0f + from_light + from_eye);
    }
    vec3 light = scale3(mul3(eval.f_cos, photon.flux), weight);
    light = select3(some, light, splat3((real)(0.0f)));
    float rgb[3][LANES];
    uint depths[LANES];
    LANES_STORE(light.x, rgb[0]);
    LANES_STORE(light.y, rgb[1]);
    LANES_STORE(light.z, rgb[2]);
    LANES_STORE(photon.depth, depths);
    for (int lane = 0; lane < LANES; lane++)
      if (depths[lane] <= most[lane])
        for (int c = 0; c < 3; c++) sums[depths[lane]][c][lane] += rgb[c][lane];
  }
  // Over the area, whose mean the kernel is 2 (1 - d^2 / r^2) of, and over the paths that left the lights.
  vec3 throughput = path_throughput(&path);
  throughput = mul3(throughput, surface_absorption(scene, &surface, hit.t, gathers));
  throughput = scale3(throughput, (real)(2.0f / (SUN_PI * map.radius * map.radius) / (float)frame->light_paths));
  FilmView film = open_film(frame, film_words, counts);
  for (uint d = 0; d < frame->max_depth; d++) {
    vec3 sum = make_vec3(LANES_LOAD(sums[d][0]), LANES_LOAD(sums[d][1]), LANES_LOAD(sums[d][2]));
    mask lit = gathers & !(fabs(sum.x) + fabs(sum.y) + fabs(sum.z) == 0.0f);
    if (!ANY(lit)) continue;
    film_contribute_keyed(frame, &film, lit, &path, SUN_FILM_KEY_PHOTONS(path.vertex, (uint_n)(d)), depth + (uint_n)(d + 1), mul3(throughput, sum));
  }
}

SUN_KERNEL void gather(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, const SUN_GLOBAL uint *path_words, const SUN_GLOBAL uint *walks,
                       const SUN_GLOBAL uint *status, const SUN_GLOBAL Hit *hits, LIGHT_MAP_PARAMETERS, uint phase, const SUN_GLOBAL uint *rays, FilmCounts counts, FilmWords film_words) {
  gather_bundle(frame, SCENE_ARGUMENTS, path_words, walks, status, hits, LIGHT_MAP_ARGUMENTS, phase, rays, counts, film_words, (uint)get_global_id(0) * LANES);
}
