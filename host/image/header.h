// SPDX-License-Identifier: Apache-2.0
// What the first bytes of a picture say, read by us before any library sees the file: its format, its size, and whether the rest is there.
// OpenImageIO's readers trust their headers (HDR ends in bad_alloc, paletted BMP and TGA read past their palettes), so they only get what passed
// here.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sunstone {

struct PictureHeader {
  const char *format = nullptr;  // OpenImageIO's name of it
  const char *suffix = nullptr;
  std::int64_t width = 0, height = 0;
};

// Throws Error{name, ...} for an unknown format, a size of zero or beyond max_image_pixels, and for what can be seen to be cut off or broken.
PictureHeader read_picture_header(std::span<const std::byte> data, const std::string &name);

// A PNG with its picture and nothing else: the chunks that matter, each checked against its sum. libpng tells the terminal, not us, what it thinks of
// profiles and of broken chunks, and never gets to see them. Throws Error{name, ...} where the file is cut off or a sum is wrong.
std::vector<std::byte> plain_png(std::span<const std::byte> data, const std::string &name);

// Bytes with every read checked against the end; reading past it throws Error{name, "is cut off ..."}.
class Bytes {
 public:
  Bytes(std::span<const std::byte> data, const std::string &name) : data_(data), name_(name) {}
  std::size_t size() const { return data_.size(); }
  unsigned u8(std::size_t at) const;
  unsigned u16_little(std::size_t at) const { return u8(at) | u8(at + 1) << 8; }
  unsigned u16_big(std::size_t at) const { return u8(at) << 8 | u8(at + 1); }
  std::uint32_t u32_little(std::size_t at) const { return u16_little(at) | std::uint32_t(u16_little(at + 2)) << 16; }
  std::uint32_t u32_big(std::size_t at) const { return std::uint32_t(u16_big(at)) << 16 | u16_big(at + 2); }
  bool starts_with(const char *text, std::size_t length, std::size_t at = 0) const;
  [[noreturn]] void fail(const std::string &reason) const;
  [[noreturn]] void cut_off() const;

 private:
  std::span<const std::byte> data_;
  const std::string &name_;
};

// Size of an OpenEXR file: the union of the limits of all its parts is checked, the first part's is returned.
PictureHeader read_exr_header(const Bytes &bytes);
void check_picture_size(const Bytes &bytes, std::int64_t width, std::int64_t height);

}  // namespace sunstone
