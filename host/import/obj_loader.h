// SPDX-License-Identifier: Apache-2.0
// The one door to tinyobjloader. It is given text that obj_guard.h and obj_materials.h have checked, from memory, and opens no file.
#pragma once
#include <tiny_obj_loader.h>

#include <string>
#include <vector>

#include "import/obj_guard.h"
#include "import/obj_materials.h"
#include "import/obj_mesh.h"

namespace sunstone {

struct LoadedObj {
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::material_t> materials;  // as in GuardedMtl::names
  ObjFaces faces;                              // its spans lie in `attributes`
};

// Throws Error{place, ...} where the loader's answer does not fit what it was given.
LoadedObj load_obj(const GuardedObj &obj, const GuardedMtl &libraries, const std::string &place);

}  // namespace sunstone
