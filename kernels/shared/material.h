// SPDX-License-Identifier: Apache-2.0
// One flat record for every material: the glTF metallic-roughness family with its extensions.
#ifndef SUN_SHARED_MATERIAL_H
#define SUN_SHARED_MATERIAL_H
#include "shared/types.h"

SUN_NAMESPACE_BEGIN

#define SUN_MATERIAL_DOUBLE_SIDED 1u
#define SUN_MATERIAL_ALPHA_MASK 2u     // alpha below alpha_cutoff is not there
#define SUN_MATERIAL_ALPHA_BLEND 4u    // alpha is the chance to be there
#define SUN_MATERIAL_VOLUME 8u         // solid: refracts, and absorbs within; otherwise transmission is thin-walled
#define SUN_MATERIAL_EMISSIVE 16u
#define SUN_MATERIAL_UNLIT 32u         // no bsdf: shows emission alone (the base colour has been moved there)
#define SUN_MATERIAL_TEXTURED 64u      // any texture at all
#define SUN_MATERIAL_PASSABLE 128u     // a ray may pass straight through: alpha, or smooth thin transmission
#define SUN_MATERIAL_SPECULAR 256u     // has anything but a diffuse lobe

// The texture slots of a material; each is an index into TextureRef[], or SUN_NONE.
#define SUN_SLOT_BASE_COLOR 0          // rgb sRGB, a = alpha
#define SUN_SLOT_METALLIC_ROUGHNESS 1  // g roughness, b metallic
#define SUN_SLOT_NORMAL 2
#define SUN_SLOT_EMISSION 3            // sRGB
#define SUN_SLOT_TRANSMISSION 4        // r
#define SUN_SLOT_SPECULAR 5            // a
#define SUN_SLOT_SPECULAR_COLOR 6      // sRGB
#define SUN_SLOT_ALPHA 7               // r: OBJ's map_d
#define SUN_SLOT_COUNT 8

typedef struct Material {
  float base_color[4];    // linear; alpha
  float emission[3];      // radiance
  float alpha_cutoff;
  float metallic;
  float roughness;        // perceptual: alpha of GGX = roughness^2
  float transmission;
  float ior;              // of the inside against the outside
  float f0[3];            // reflectance of the dielectric at normal incidence (glTF: ((ior-1)/(ior+1))^2 * specular * specularColor; OBJ: Ks)
  float f90;              // at grazing incidence (glTF: specular factor; OBJ: 1, or 0 where Ks is 0)
  float absorption[3];    // of the inside, 1/metre (Beer's law): -log(attenuationColor) / attenuationDistance
  float normal_scale;
  uint flags;
  uint slot[SUN_SLOT_COUNT];
  uint pad[3];
} Material;
SUN_STATIC_ASSERT(sizeof(Material) == 128, material_is_128_bytes);

SUN_NAMESPACE_END
#endif
