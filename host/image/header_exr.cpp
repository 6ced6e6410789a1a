// SPDX-License-Identifier: Apache-2.0
// The header of OpenEXR files: a row of attributes (name, type, size, bytes) for each part.
#include <algorithm>
#include <string>

#include "image/header.h"
#include "image/image.h"

namespace sunstone {

namespace {

constexpr std::size_t longest_name = 255;
constexpr unsigned flag_deep = 0x800, flag_multipart = 0x1000;

std::string text_at(const Bytes &bytes, std::size_t &at) {
  std::string text;
  while (const unsigned c = bytes.u8(at++)) {
    text += static_cast<char>(c);
    if (text.size() > longest_name) bytes.fail("its OpenEXR header is broken: a name of more than 255 characters");
  }
  return text;
}

struct Window {
  std::int64_t width = 0, height = 0;
};

Window window_at(const Bytes &bytes, std::size_t at) {
  const auto value = [&](std::size_t i) { return std::int64_t(static_cast<std::int32_t>(bytes.u32_little(at + 4 * i))); };
  return {value(2) - value(0) + 1, value(3) - value(1) + 1};
}

}  // namespace

PictureHeader read_exr_header(const Bytes &bytes) {
  const unsigned version = bytes.u32_little(4);
  if ((version & 0xff) != 2) bytes.fail("is an OpenEXR file of version " + std::to_string(version & 0xff) + "; 2 is read");
  if (version & flag_deep) bytes.fail("is a deep OpenEXR file; flat ones are read");
  const bool multipart = version & flag_multipart;
  Window first;
  std::size_t at = 8;
  for (int part = 0;; part++) {
    bool has_window = false;
    std::string name = text_at(bytes, at);
    if (name.empty() && part > 0) break;  // the end of a multi-part file's headers
    for (; !name.empty(); name = text_at(bytes, at)) {
      const std::string type = text_at(bytes, at);
      const std::size_t length = bytes.u32_little(at);
      at += 4;
      if (length > bytes.size() - at) bytes.cut_off();
      if ((name == "dataWindow" || name == "displayWindow") && type == "box2i" && length == 16) {
        const Window window = window_at(bytes, at);
        check_picture_size(bytes, window.width, window.height);
        if (name == "dataWindow") {
          has_window = true;
          if (part == 0) first = window;
        }
      } else if (name == "tiles" && length >= 9) {
        const std::int64_t x = bytes.u32_little(at), y = bytes.u32_little(at + 4);
        if (x == 0 || y == 0 || x > 8192 || y > 8192)
          bytes.fail("its tiles are " + std::to_string(x) + " x " + std::to_string(y) + "; 1 to 8192 are read");
      } else if (name == "channels" && length > 1 << 16) {
        bytes.fail("has too many channels");
      } else if (name == "type" && length >= 4 && bytes.starts_with("deep", 4, at)) {
        bytes.fail("is a deep OpenEXR file; flat ones are read");
      }
      at += length;
    }
    if (!has_window) bytes.fail("its OpenEXR header has no data window");
    if (!multipart) break;
    if (part > 1024) bytes.fail("has more than 1024 parts");
  }
  return {"openexr", "exr", first.width, first.height};
}

}  // namespace sunstone
