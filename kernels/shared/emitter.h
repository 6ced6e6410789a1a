// SPDX-License-Identifier: Apache-2.0
// All that emits stands in one alias table [Vose91]: emissive triangles, punctual lights, the environment.
#ifndef SUN_SHARED_EMITTER_H
#define SUN_SHARED_EMITTER_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

#define SUN_EMITTER_TRIANGLE 0     // a = instance, b = primitive; of a shape: the one that stands for it
#define SUN_EMITTER_LIGHT 1        // a = index into Light[]
#define SUN_EMITTER_ENVIRONMENT 2

typedef struct Emitter {
  uint kind;
  uint a, b;
  float pmf;        // chance that this emitter is chosen
  float threshold;  // alias table: the slot keeps itself where the fraction is below this ...
  uint alias;       // ... and otherwise gives this one
  uint pad[2];
} Emitter;
SUN_STATIC_ASSERT(sizeof(Emitter) == 32, emitter_is_32_bytes);

#define SUN_LIGHT_POINT 0
#define SUN_LIGHT_SPOT 1
#define SUN_LIGHT_DIRECTIONAL 2
#define SUN_LIGHT_KIND 0xffu
#define SUN_LIGHT_KEYS_SHIFT 8  // the rest of `kind`: where the keys of a light that moves stand in Light[] (shared/motion.h); 0: it is still

typedef struct Light {
  float position[3];
  uint kind;
  float direction[3];    // that the light shines to, unit length
  float cos_outer;       // spot: nothing beyond; angular attenuation as in KHR_lights_punctual
  float intensity[3];    // W/sr (point, spot) or irradiance (directional)
  float cos_inner;
} Light;
SUN_STATIC_ASSERT(sizeof(Light) == 48, light_is_48_bytes);

#define SUN_ENVIRONMENT_NONE 0
#define SUN_ENVIRONMENT_CONSTANT 1
#define SUN_ENVIRONMENT_MAP 2

// Equirectangular: direction (x, y, z) -> u = 0.5 + atan2(z, x) / 2pi, v = acos(y) / pi, after turning about +y.
// Radiance is bilinear in the map (u wraps, v clamps). Chosen by the marginal cdf over rows, then the conditional cdf of that row, uniform within a cell.
typedef struct Environment {
  uint kind;
  uint width, height;    // of the map, and of the distribution
  uint emitter;          // its place in the alias table, or SUN_NONE
  float radiance[3];     // SUN_ENVIRONMENT_CONSTANT (`constant` is a keyword of OpenCL C)
  float rotation;        // turns about +y by this many radians / 2pi: added to u
} Environment;
SUN_STATIC_ASSERT(sizeof(Environment) == 32, environment_is_32_bytes);

SUN_NAMESPACE_END
#endif
