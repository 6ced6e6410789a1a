// SPDX-License-Identifier: Apache-2.0
// Material libraries (.mtl) -> materials. docs/obj-materials.md has the table.
#pragma once
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "import/import.h"
#include "import/obj_guard.h"

namespace sunstone {

// The statements of all libraries of a scene, made fit for tinyobjloader: a material is called by its number, colours have three numbers, textures
// have their options before their names, all of them in full.
struct GuardedMtl {
  std::string text;
  std::vector<std::string> names;            // of materials
  std::vector<std::set<std::string>> given;  // statements that a material has: the loader does not tell absent ones from zeros
  std::map<std::string, int> numbers;        // by name
};

// Adds one library's text. A name that is already there is left out, with a warning.
void guard_mtl(std::string_view text, GuardedMtl &out, LineFaults &faults);

// Reads the libraries that the OBJ file names. One that is missing, unreadable or outside the folder is a warning.
GuardedMtl read_libraries(const ObjSurvey &survey, const std::filesystem::path &obj, const ImportOptions &options, Notices &notices);

class ObjTextures;
struct LoadedObj;

// The materials of the libraries, in their order; those that no face has (`used`) get no textures. `file` is for warnings.
std::vector<Material> make_obj_materials(const GuardedMtl &libraries, const LoadedObj &obj, const std::vector<bool> &used, ObjTextures &textures,
                                         const std::string &file);

// What faces without a material have: grey, diffuse, seen from both sides.
Material default_obj_material();

}  // namespace sunstone
