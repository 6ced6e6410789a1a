// SPDX-License-Identifier: Apache-2.0
// Scene materials -> kernel::Material records. The last record is the default material, for triangles that name none.
#pragma once
#include "flatten/textures.h"

namespace sunstone {

// Number of a primitive's record.
inline kernel::uint material_number(const Scene &scene, int material) {
  return static_cast<kernel::uint>(material < 0 ? scene.materials.size() : static_cast<std::size_t>(material));
}

// Is what has this material passed by rays that see it from behind?
inline bool single_sided(const kernel::Material &material) {
  return !(material.flags & (SUN_MATERIAL_DOUBLE_SIDED | SUN_MATERIAL_VOLUME)) && !(material.transmission > 0);
}

// Fills flat.materials but for what depends on texels, and collects the textures of materials that an instance shows.
void flatten_materials(const Scene &scene, TextureLibrary &library, FlatScene &flat);

// With the texels in place: drops emission where the texture is black all over and alpha modes that never let a ray pass, sets SUN_MATERIAL_PASSABLE
// where one may, and the scene's feature bits.
void finish_materials(const Scene &scene, FlatScene &flat);

}  // namespace sunstone
