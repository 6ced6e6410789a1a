// SPDX-License-Identifier: Apache-2.0
// Textures live in pages of plain buffers, not image objects: the same filtering bits everywhere, and no limit on their number.
#ifndef SUN_SHARED_TEXTURE_H
#define SUN_SHARED_TEXTURE_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

#define SUN_TEXTURE_PAGES 4  // OpenCL promises that one allocation may take a quarter of the device's memory

#define SUN_TEXEL_RGBA8 0        // one uint, r in the low byte, linear
#define SUN_TEXEL_RGBA8_SRGB 1   // the same, rgb decoded from sRGB, a linear
#define SUN_TEXEL_RGBA16F 2      // two uints of halves
#define SUN_TEXEL_RGBA32F 3      // four floats

#define SUN_WRAP_REPEAT 0
#define SUN_WRAP_MIRROR 1
#define SUN_WRAP_CLAMP 2

typedef struct Texture {
  uint page;
  uint offset;  // in uints, within its page
  uint width;
  uint height;
  uint format;  // SUN_TEXEL_
  uint wrap_u;
  uint wrap_v;
  uint linear;  // 1: bilinear, 0: nearest
} Texture;
SUN_STATIC_ASSERT(sizeof(Texture) == 32, texture_is_32_bytes);

// How a material looks at a texture: (u', v') = M * (u, v, 1), v down as in glTF.
typedef struct TextureRef {
  uint texture;
  uint uv_set;  // 0 or 1
  float m[6];   // 2x3, row major
} TextureRef;
SUN_STATIC_ASSERT(sizeof(TextureRef) == 32, texture_ref_is_32_bytes);

SUN_NAMESPACE_END
#endif
