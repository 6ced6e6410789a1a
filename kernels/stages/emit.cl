// SPDX-License-Identifier: Apache-2.0
// emit: begins walks. Slots that compact gave out begin the light subpath of a new sample; those whose light subpath has ended begin its eye subpath. In a light pass
// there are light subpaths alone, in an eye pass eye subpaths.
//   reads    counts REFILL_*; the ray queue; status
//   writes   every column of the path; the walk; status
//   queues   the slots stand in `rays` already: compact counted them in
//   holds    afterwards a slot of `rays` is alive and has a ray, or stands for a pixel beyond the picture's edge (or a light pass' subpath of no light) and is dead
//   source   [Lafortune93]; weights begin as in [Georgiev12 eq. 31-33]
#include "path/number.h"
#include "path/queue.h"
#include "scene/lens.h"
#include "transport/camera_path.h"
#include "transport/emit.h"
#include "transport/step.h"

SUN_BODY void emit_bundle(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *walks, SUN_GLOBAL uint *status,
                          const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts, uint first) {
  uint length = counts[SUN_COUNT_LIVE], refill_first = counts[SUN_COUNT_REFILL_FIRST];
  if (first >= length) return;
  QueueLanes lanes = queue_lanes(rays, first, length);
  uint_n position = (uint_n)(first) + uint_of_int((int_n)(LANE_NUMBERS));
  mask fresh = lanes.active & (position >= (uint_n)(refill_first));
  uint_n word = gather_uint(status, lanes.slot);
  mask turns = lanes.active & !fresh & ((word & (uint_n)(SUN_STATUS_TURN)) != (uint_n)(0));
  if (!ANY(fresh | turns)) return;
  Scene opened = open_scene(frame, SCENE_ARGUMENTS);
  const Scene *scene = &opened;
  Paths paths = open_paths(frame, path_words);
  uint_n path_count = (uint_n)(counts[SUN_COUNT_REFILL_PATH]) + (fresh ? position - (uint_n)(refill_first) : (uint_n)(0));
  PathNumber number = path_number(frame, path_count);
  if (frame->flags & SUN_FRAME_PHOTONS) number.inside = path_count < (uint_n)(frame->light_paths);
  mask inside = fresh & number.inside;
  Path path = path_load(&paths, lanes.slot);
  Walk walk = walk_load(walks, lanes.slot);
  uint_n y = path.pixel / (uint_n)(frame->tile_width);
  uint_n x = path.pixel - y * (uint_n)(frame->tile_width);
  x = turns ? x : number.x;
  y = turns ? y : number.y;
  uint_n sample = turns ? path.sample : number.sample;
  path = camera_path(frame, scene->tables, x, y, sample);
  if (frame->flags & SUN_FRAME_PHOTONS) {
    path.pixel = path_count;
    path.sample = (uint_n)(frame->sample_first);
  }
  SamplerKey key = path_key(frame, &path);
  at_moment(&opened, &key);
  mask looks = turns | inside;
  uint_n begun = (uint_n)((frame->flags & SUN_FRAME_LIGHT_PASS) ? 0u : SUN_STATUS_ALIVE);
  vec3 camera_direction = path_direction(&path);
  real subpaths = (real)((float)frame->width * (float)frame->height);
  walk.vertices = turns ? walk.vertices : (uint_n)(0);
  walk.rough = (uint_n)(0);
  walk.path = turns ? walk.path : path_count + (uint_n)(1);
  walk.emitted = walk.absorption = splat3((real)(0.0f));
  walk.dVCM = heuristic_ratio(frame, subpaths * inverse_camera_pdf(frame, &scene->moment, camera_direction));
  walk.dVC = walk.dVM = (real)(0.0f);
  mask never = looks & !looks;
  walk.holds = walk.unseen = never;
  walk.far = frame->camera.kind == SUN_CAMERA_ORTHOGRAPHIC ? !never : never;
  if (ANY(inside) && frame->emitter_count > 0 && frame->max_depth > 0 && !(frame->flags & SUN_FRAME_EYE_PASS)) {
    uint_n vertex = (uint_n)(SUN_LIGHT_VERTEX);
    Emission e = sample_emission(scene, sample_1d(&key, SUN_DIM_EMITTER(vertex)), sample_1d(&key, SUN_DIM_LOBE(vertex)), sample_2d(&key, SUN_DIM_EMITTER_POINT(vertex)),
                                 sample_2d(&key, SUN_DIM_DIRECTION(vertex)), inside);
    path_aim(&path, e.valid, e.origin, e.direction);
    path_set_throughput(&path, select3(e.valid, splat3((real)(1.0f)), path_throughput(&path)));
    path.vertex = e.valid ? vertex + (uint_n)(1) : path.vertex;
    walk.emitted = select3(e.valid, e.flux, walk.emitted);
    walk.unseen = e.valid & e.pointed;
    walk.dVCM = e.valid ? e.dVCM : walk.dVCM;
    walk.dVC = e.valid ? e.dVC : walk.dVC;
    walk.dVM = e.valid ? e.dVM : walk.dVM;
    walk.far = (e.valid & e.far) | (walk.far & !e.valid);
    begun = e.valid ? (uint_n)(SUN_STATUS_ALIVE | SUN_STATUS_LIGHT) : begun;
  }
  path_store(&paths, lanes.slot, looks, &path);
  walk_store(walks, lanes.slot, looks, &walk);
  store_uint(status, lanes.slot, fresh | turns, looks ? begun : (uint_n)(0));
}

SUN_KERNEL void emit(const SUN_GLOBAL Frame *frame, SCENE_PARAMETERS, SUN_GLOBAL uint *path_words, SUN_GLOBAL uint *walks, SUN_GLOBAL uint *status,
                     const SUN_GLOBAL uint *rays, const SUN_GLOBAL uint *counts) {
  emit_bundle(frame, SCENE_ARGUMENTS, path_words, walks, status, rays, counts, (uint)get_global_id(0) * LANES);
}
