// SPDX-License-Identifier: Apache-2.0
// Buffers, views into them, and the URIs behind them. Nothing is read before it is used, and each buffer once.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "import/gltf_value.h"

namespace sunstone::gltf {

// Strict base64 (RFC 4648, section 4): padded, no blanks, no bits left over. Empty optional where it is not.
std::optional<std::vector<std::byte>> decode_base64(std::string_view text);

// %41 -> A; a per cent sign without two hex digits stays as it is, since some exporters forget to encode it.
std::string decode_percent(std::string_view uri);

// The bytes behind a URI: of a data URI, or of a file below the scene's folder (anywhere, where options allow). Other schemes are refused.
// An Error names the property and the file.
std::vector<std::byte> read_uri(const Value &uri);

struct View {
  std::span<const std::byte> bytes;
  std::size_t stride = 0;  // 0: tightly packed
  Value value;
};

class Buffers {
 public:
  Buffers(const Value &root, std::optional<std::span<const std::byte>> binary);
  View view(const Value &reference);  // `reference` holds the index of a bufferView
  std::size_t bytes_loaded() const { return bytes_loaded_; }

 private:
  std::span<const std::byte> buffer(std::size_t index, const Value &user);

  Value buffers_, views_;
  std::optional<std::span<const std::byte>> binary_;
  struct Loaded {
    bool done = false;
    std::vector<std::byte> own;
    std::span<const std::byte> bytes;
  };
  std::vector<Loaded> loaded_;
  std::size_t bytes_loaded_ = 0;
};

}  // namespace sunstone::gltf
