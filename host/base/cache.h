// SPDX-License-Identifier: Apache-2.0
// Where what can be made again is kept: compiled programs, self-test verdicts.
#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "base/hash.h"

namespace sunstone {

// $SUNSTONE_CACHE, else $XDG_CACHE_HOME/sunstone, else ~/.cache/sunstone; empty where there is none. Not created.
std::filesystem::path cache_folder();

// What was stored under this key, or nothing: missing, of another key, or damaged (its own hash does not match) are all the same.
std::optional<std::vector<std::byte>> cache_read(const std::string &kind, const Hash &key);

// Stores; a cache that cannot be written is no error, it only stays cold.
void cache_write(const std::string &kind, const Hash &key, std::span<const std::byte> data);

// Removes what sunstone stored there and tells how many bytes that were.
std::size_t cache_clear();

}  // namespace sunstone
