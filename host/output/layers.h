// SPDX-License-Identifier: Apache-2.0
// Film -> OpenEXR with all layers, named as OpenEXR's tools expect.
#pragma once
#include <filesystem>

#include "film/film.h"

namespace sunstone {

void write_layers(const std::filesystem::path &path, const Film &film);

}  // namespace sunstone
