// SPDX-License-Identifier: Apache-2.0
// What a surface that a shadow ray may pass leaves of its light: alpha, and smooth thin transmission.
#ifndef SUN_TRANSPORT_PASS_H
#define SUN_TRANSPORT_PASS_H
#include "scene/surface.h"

SUN_NAMESPACE_BEGIN

// wo: unit vector back along the ray.
SUN_FN vec3 passed_share(const Scene *scene, const HitLanes *hit, vec3 wo) {
  Surface surface = make_surface(scene, hit, wo);
  real alpha = surface_alpha(scene, &surface, hit->hit);
  vec3 share = splat3((real)(1.0f));
  mask there = hit->hit & (alpha > 0.0f);
  if (ANY(there)) {
    Bsdf bsdf = surface_bsdf(scene, &surface, there);
    vec3 straight = bsdf_straight(&bsdf, to_local(&surface.shading, wo));
    mask unlit = (surface.material_flags & (uint_n)(SUN_MATERIAL_UNLIT)) != (uint_n)(0);
    straight = select3(unlit, splat3((real)(0.0f)), straight);
    share = select3(there, lerp3(share, straight, alpha), share);
  }
  return share;
}

SUN_NAMESPACE_END
#endif
