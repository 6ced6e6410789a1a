// SPDX-License-Identifier: Apache-2.0
// Vectors of reals. A vec3 is three reals (SoA in registers), so a vec3 at LANES 16 holds sixteen vectors.
// The order of every sum is written out: no built-in dot or normalize, whose rounding a device may choose.
#ifndef SUN_MATH_VECTOR_H
#define SUN_MATH_VECTOR_H
#include "math/real.h"

SUN_NAMESPACE_BEGIN

typedef struct vec2 { real x, y; } vec2;
typedef struct vec3 { real x, y, z; } vec3;

SUN_FN vec2 make_vec2(real x, real y) { vec2 v; v.x = x; v.y = y; return v; }
SUN_FN vec3 make_vec3(real x, real y, real z) { vec3 v; v.x = x; v.y = y; v.z = z; return v; }
SUN_FN vec3 splat3(real x) { return make_vec3(x, x, x); }
SUN_FN vec3 add3(vec3 a, vec3 b) { return make_vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
SUN_FN vec3 sub3(vec3 a, vec3 b) { return make_vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
SUN_FN vec3 mul3(vec3 a, vec3 b) { return make_vec3(a.x * b.x, a.y * b.y, a.z * b.z); }
SUN_FN vec3 scale3(vec3 a, real s) { return make_vec3(a.x * s, a.y * s, a.z * s); }
SUN_FN vec3 negate3(vec3 a) { return make_vec3(-a.x, -a.y, -a.z); }
SUN_FN vec3 lerp3(vec3 a, vec3 b, real t) { return make_vec3(lerp_real(a.x, b.x, t), lerp_real(a.y, b.y, t), lerp_real(a.z, b.z, t)); }
SUN_FN vec3 select3(mask m, vec3 a, vec3 b) { return make_vec3(m ? a.x : b.x, m ? a.y : b.y, m ? a.z : b.z); }
SUN_FN real dot3(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
SUN_FN vec3 cross3(vec3 a, vec3 b) { return make_vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }
SUN_FN real max_of3(vec3 a) { return max_real(max_real(a.x, a.y), a.z); }
SUN_FN real luminance(vec3 rgb) { return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z; }  // Rec. 709
// The zero vector gives (0, 0, 1).
SUN_FN vec3 normalize3(vec3 a) {
  real squared = dot3(a, a);
  mask some = squared > 0.0f;
  real inverse = 1.0f / sqrt(some ? squared : (real)(1.0f));
  return select3(some, scale3(a, inverse), make_vec3((real)(0.0f), (real)(0.0f), (real)(1.0f)));
}

// An orthonormal frame; local z is the normal. Local directions: x = tangent, y = bitangent, z = normal.
typedef struct Frame3 { vec3 tangent, bitangent, normal; } Frame3;

// [Duff17] without a branch.
SUN_FN Frame3 frame_of_normal(vec3 n) {
  Frame3 f;
  real sign = copysign((real)(1.0f), n.z);
  real a = -1.0f / (sign + n.z);
  real b = n.x * n.y * a;
  f.tangent = make_vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
  f.bitangent = make_vec3(b, sign + n.y * n.y * a, -n.y);
  f.normal = n;
  return f;
}
SUN_FN vec3 to_local(const Frame3 *f, vec3 v) { return make_vec3(dot3(v, f->tangent), dot3(v, f->bitangent), dot3(v, f->normal)); }
SUN_FN vec3 to_world(const Frame3 *f, vec3 v) {
  return add3(add3(scale3(f->tangent, v.x), scale3(f->bitangent, v.y)), scale3(f->normal, v.z));
}

SUN_NAMESPACE_END
#endif
