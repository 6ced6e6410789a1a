// SPDX-License-Identifier: Apache-2.0
// Files that come with the program: share/sunstone beside bin, in an installation and in a build folder alike.
#pragma once
#include <filesystem>
#include <string>

namespace sunstone {

// Of "scenes/cornell/cornell.gltf", say. Error where it is not there.
std::filesystem::path shared_file(const std::string &name);

}  // namespace sunstone
