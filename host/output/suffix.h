// SPDX-License-Identifier: Apache-2.0
// The suffix of a file's name in lower case, with its dot.
#pragma once
#include <filesystem>
#include <string>

namespace sunstone {

std::string suffix_of(const std::filesystem::path &path);

}  // namespace sunstone
