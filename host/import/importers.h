// SPDX-License-Identifier: Apache-2.0
// The importers themselves, one file each; import.cpp chooses.
#pragma once
#include "import/import.h"

namespace sunstone {

// Says that a file has nothing to play, where options ask for a time; an animation that they name is an Error.
void expect_no_animation(const std::string &file, const ImportOptions &options, Notices &notices);

Scene import_gltf(const std::filesystem::path &path, const ImportOptions &options, Notices &notices);
Scene import_obj(const std::filesystem::path &path, const ImportOptions &options, Notices &notices);

}  // namespace sunstone
