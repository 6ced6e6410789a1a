// SPDX-License-Identifier: Apache-2.0
// Pixels, and the one door to OpenImageIO.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace sunstone {

// Rows from the top, `channels` interleaved, values as the file has them (no colour is converted, alpha is not multiplied in).
struct Image {
  std::string name;  // where it came from, for messages
  int width = 0, height = 0;
  int channels = 0;  // 1 to 4
  std::variant<std::vector<std::uint8_t>, std::vector<float>> pixels;  // 8-bit files stay 8 bits; all else is float (16-bit: 0..1)
  bool is_float() const { return pixels.index() == 1; }
};

constexpr std::int64_t max_image_pixels = std::int64_t(1) << 28;  // 16384 x 16384

// Decodes a picture that is held in memory. The format is told by its first bytes and opened by name: PNG, JPEG, HDR, EXR, WebP, TGA, BMP alone.
// Throws Error{name, ...} where it is no such picture, is cut off, or claims more than max_image_pixels (before any pixel is allocated).
Image decode_image(std::span<const std::byte> data, const std::string &name);

// Reads and decodes a file.
Image read_image(const std::filesystem::path &path);

}  // namespace sunstone
