// SPDX-License-Identifier: Apache-2.0
// The importers themselves, one file each; import.cpp chooses.
#pragma once
#include "import/import.h"

namespace sunstone {

Scene import_gltf(const std::filesystem::path &path, const ImportOptions &options, Notices &notices);
Scene import_obj(const std::filesystem::path &path, const ImportOptions &options, Notices &notices);

}  // namespace sunstone
