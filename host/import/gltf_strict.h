// SPDX-License-Identifier: Apache-2.0
// Bytes -> a JSON document and, in a GLB, its binary chunk. The strict pass: what it lets through has bounded depth and size, no key twice,
// finite numbers and valid UTF-8. What the properties mean is checked where they are read (gltf_value.h).
#pragma once
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "base/notice.h"

namespace sunstone::gltf {

using Json = nlohmann::json;

constexpr std::size_t max_json_depth = 256;
constexpr std::size_t max_json_values = std::size_t(1) << 25;  // some 3 GiB once they are objects
constexpr std::size_t max_json_bytes = std::size_t(1) << 30;

struct Document {
  Json root;                                         // an object
  std::optional<std::span<const std::byte>> binary;  // GLB's BIN chunk, within the bytes that were given
};

// `file` is for messages. A file that begins with GLB's magic is one whatever its suffix; one that is said to be GLB has to.
Document parse_document(std::span<const std::byte> data, const std::string &file, bool said_to_be_glb, Notices &notices);

}  // namespace sunstone::gltf
