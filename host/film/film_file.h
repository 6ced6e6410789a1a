// SPDX-License-Identifier: Apache-2.0
// .film: the integers themselves, with all that is needed to add to them. Also what a checkpoint is.
#pragma once
#include <filesystem>

#include "film/film.h"

namespace sunstone {

// "SUNFILM1", the length of a JSON header, the header, then each layer's values as little-endian 64-bit integers, then an XXH3 hash of all before it.
void write_film(const std::filesystem::path &path, const Film &film);

// Throws Error where the file is no film, is cut off, damaged, of a newer version, or claims sizes that its length cannot hold (checked before
// allocating).
Film read_film(const std::filesystem::path &path);

}  // namespace sunstone
