// SPDX-License-Identifier: Apache-2.0
// occlude_all: occlude for slots that send different numbers of shadow rays, one slot a work-item.
//   reads    status: how many; shadow rays, those of a slot without gaps; the tree; materials of what a ray may pass
//   writes   film
//   queues   shadow_rays
#include "stages/occlude.cl"

SUN_TRACE_KERNEL void occlude_all(const SUN_GLOBAL Frame *frame, TREE_PARAMETERS, SCENE_PARAMETERS, const SUN_GLOBAL ShadowRay *shadow_rays,
                                  const SUN_GLOBAL uint *queue, const SUN_GLOBAL uint *status, FilmCounts counts, FilmWords film_words) {
  uint position = (uint)get_global_id(0);
  if (position >= counts[SUN_COUNT_SHADOW]) return;
  uint rays = (status[queue[position]] & SUN_STATUS_SHADOWS) >> SUN_STATUS_SHADOWS_SHIFT;
  for (uint number = 0; number < rays; number++)
    occlude_ray(frame, TREE_ARGUMENTS, SCENE_ARGUMENTS, shadow_rays, queue, counts, film_words, number * frame->pool, position);
}
