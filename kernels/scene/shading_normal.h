// SPDX-License-Identifier: Apache-2.0
// Shading normals that suit the way from which a surface is seen.
#ifndef SUN_SCENE_SHADING_NORMAL_H
#define SUN_SCENE_SHADING_NORMAL_H
#include "math/vector.h"

SUN_NAMESPACE_BEGIN

// What mirrors at a shading normal may look into the surface, and would be black; seen from behind the normal a surface would be black or leak. So the normal is bent
// until the mirrored direction just leaves the true surface, whose normal is on wo's side [Keller17 A.3].
SUN_FN vec3 bend_normal(vec3 ns, vec3 wo, vec3 geometric) {
  real cosine = dot3(ns, wo);
  vec3 mirrored = sub3(scale3(ns, 2.0f * cosine), wo);
  real lift = min_real(0.9f * dot3(wo, geometric), (real)(0.01f)) - dot3(mirrored, geometric);
  mask bend = (lift > 0.0f) | (cosine <= 0.0f);
  if (ANY(bend)) {
    vec3 half_way = add3(wo, normalize3(add3(mirrored, scale3(geometric, max_real(lift, (real)(0.0f))))));
    real length2 = dot3(half_way, half_way);
    vec3 bent = scale3(half_way, 1.0f / sqrt(length2 > 1e-6f ? length2 : (real)(1.0f)));
    ns = select3(bend, select3(length2 > 1e-6f, bent, geometric), ns);
  }
  return ns;
}

SUN_NAMESPACE_END
#endif
