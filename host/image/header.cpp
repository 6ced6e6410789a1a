// SPDX-License-Identifier: Apache-2.0
#include "image/header.h"

#include <charconv>
#include <cstring>
#include <string_view>

#include "base/error.h"
#include "image/image.h"

namespace sunstone {

unsigned Bytes::u8(std::size_t at) const {
  if (at >= data_.size()) cut_off();
  return std::to_integer<unsigned>(data_[at]);
}

bool Bytes::starts_with(const char *text, std::size_t length, std::size_t at) const {
  return at <= data_.size() && length <= data_.size() - at && std::memcmp(data_.data() + at, text, length) == 0;
}

void Bytes::fail(const std::string &reason) const { throw Error(name_, reason); }
void Bytes::cut_off() const { fail("is cut off: it ends after " + std::to_string(data_.size()) + " bytes"); }

void check_picture_size(const Bytes &bytes, std::int64_t width, std::int64_t height) {
  const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
  if (width <= 0 || height <= 0) bytes.fail("has " + size);
  if (width > max_image_pixels / height) bytes.fail("claims " + size + "; at most " + std::to_string(max_image_pixels) + " are read");
}

namespace {

PictureHeader png_header(const Bytes &bytes) {
  if (!bytes.starts_with("\0\0\0\x0dIHDR", 8, 8)) bytes.fail("is a broken PNG: it does not begin with its header");
  return {"png", "png", bytes.u32_big(16), bytes.u32_big(20)};
}

// Walks all markers: libjpeg makes a half-grey picture of a file that is cut off, so the end marker has to be there.
PictureHeader jpeg_header(const Bytes &bytes) {
  PictureHeader header{"jpeg", "jpg"};
  for (std::size_t at = 2;;) {
    while (bytes.u8(at) != 0xff) at++;  // entropy-coded data
    while (bytes.u8(at) == 0xff) at++;
    const unsigned marker = bytes.u8(at++);
    if (marker == 0xd9) break;
    if (marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8)) continue;  // stuffed byte, restart: no length
    const unsigned length = bytes.u16_big(at);
    if (length < 2) bytes.fail("is a broken JPEG: a segment of length " + std::to_string(length));
    const bool is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame && header.width == 0) {
      header.height = bytes.u16_big(at + 3);
      header.width = bytes.u16_big(at + 5);
    }
    at += length;
  }
  if (header.width == 0) bytes.fail("is a broken JPEG: it has no picture");
  return header;
}

std::string line_at(const Bytes &bytes, std::size_t &at) {
  std::string line;
  for (unsigned c; (c = bytes.u8(at++)) != '\n'; line += static_cast<char>(c))
    if (line.size() > 4096) bytes.fail("its Radiance header is broken: a line of more than 4096 bytes");
  return line;
}

// Reads "-Y 512 +X 1024"; other orders of rows and columns are not written by any tool we know, and are refused.
PictureHeader hdr_header(const Bytes &bytes) {
  PictureHeader header{"hdr", "hdr"};
  std::size_t at = 0;
  for (std::string line = line_at(bytes, at); !line.empty() && line != "\r"; line = line_at(bytes, at))
    if (line.starts_with("FORMAT=") && line.find("rgbe") == std::string::npos)
      bytes.fail("is a Radiance picture of \"" + printable(line) + "\"; rgbe is read");
  const std::string size = line_at(bytes, at);
  const auto number = [&](std::size_t from, const char *what) {
    std::int64_t value = -1;
    std::size_t begin = size.find(what, from);
    if (begin == std::string::npos) bytes.fail("is a Radiance picture of the size \"" + printable(size) + "\"; \"-Y height +X width\" is read");
    begin += 3;
    const auto result = std::from_chars(size.data() + begin, size.data() + size.size(), value);
    if (result.ec != std::errc()) bytes.fail("its size \"" + printable(size) + "\" cannot be read");
    return value;
  };
  header.height = number(0, "-Y ");
  header.width = number(4, "+X ");
  check_picture_size(bytes, header.width, header.height);
  // A run is two bytes for at most 127 values, and a pixel has four of them: what is shorter than this is not all there.
  if (static_cast<std::int64_t>(bytes.size() - at) < header.width * header.height / 16) bytes.cut_off();
  return header;
}

PictureHeader webp_header(const Bytes &bytes) {
  if (std::size_t(bytes.u32_little(4)) + 8 > bytes.size()) bytes.cut_off();
  PictureHeader header{"webp", "webp"};
  if (bytes.starts_with("VP8X", 4, 12)) {
    const auto u24 = [&](std::size_t at) { return std::int64_t(bytes.u16_little(at) | bytes.u8(at + 2) << 16); };
    header.width = u24(24) + 1;
    header.height = u24(27) + 1;
  } else if (bytes.starts_with("VP8L", 4, 12)) {
    const std::uint32_t bits = bytes.u32_little(21);
    header.width = (bits & 0x3fff) + 1;
    header.height = (bits >> 14 & 0x3fff) + 1;
  } else if (bytes.starts_with("VP8 ", 4, 12)) {
    header.width = bytes.u16_little(26) & 0x3fff;
    header.height = bytes.u16_little(28) & 0x3fff;
  } else {
    bytes.fail("is a broken WebP: it does not begin with a picture");
  }
  return header;
}

// Every row has to be there, and every index has to be within the palette: OpenImageIO's reader checks neither.
PictureHeader bmp_header(const Bytes &bytes) {
  const std::uint32_t pixels_at = bytes.u32_little(10), info = bytes.u32_little(14);
  const bool old = info == 12;
  if (!old && (info < 40 || info > 124)) bytes.fail("is a BMP with an unknown header of " + std::to_string(info) + " bytes");
  const std::int64_t width = old ? bytes.u16_little(18) : static_cast<std::int32_t>(bytes.u32_little(18));
  const std::int64_t rows = old ? bytes.u16_little(20) : static_cast<std::int32_t>(bytes.u32_little(22));
  const unsigned bits = bytes.u16_little(old ? 24 : 28);
  const std::uint32_t coding = old ? 0 : bytes.u32_little(30);
  const std::int64_t height = rows < 0 ? -rows : rows;
  check_picture_size(bytes, width, height);
  if (coding != 0 && coding != 3) bytes.fail("is a compressed BMP; uncompressed ones are read");
  if (bits != 1 && bits != 4 && bits != 8 && bits != 16 && bits != 24 && bits != 32)
    bytes.fail("is a BMP of " + std::to_string(bits) + " bits a pixel");
  const std::int64_t stride = (width * bits + 31) / 32 * 4;
  if (pixels_at > bytes.size() || height > static_cast<std::int64_t>(bytes.size() - pixels_at) / stride) bytes.cut_off();
  if (bits <= 8) {
    const std::uint32_t named = old ? 0 : bytes.u32_little(46);
    const std::uint32_t colours = named ? named : 1u << bits;
    if (colours > 1u << bits)
      bytes.fail("is a broken BMP: a palette of " + std::to_string(colours) + " colours for " + std::to_string(bits) + " bits");
    if (14 + std::size_t(info) + colours * std::size_t(old ? 3 : 4) > pixels_at) bytes.fail("is a broken BMP: its palette runs into its pixels");
    for (std::int64_t y = 0; colours < 1u << bits && y < height; y++)
      for (std::int64_t x = 0; x < width; x++) {
        const unsigned byte = bytes.u8(pixels_at + y * stride + x * bits / 8);
        if ((byte >> (8 - bits - x * bits % 8) & ((1u << bits) - 1)) >= colours) bytes.fail("is a broken BMP: a pixel beyond its palette");
      }
  }
  return {"bmp", "bmp", width, height};
}

// TGA has no mark at its beginning; a header that makes sense in all its fields is taken for one.
bool looks_like_targa(const Bytes &bytes) {
  if (bytes.size() < 18 || bytes.u8(1) > 1) return false;
  const unsigned kind = bytes.u8(2), bits = bytes.u8(16);
  const bool paletted = kind == 1 || kind == 9, grey = kind == 3 || kind == 11, colour = kind == 2 || kind == 10;
  if (paletted) return bytes.u8(1) == 1 && bits == 8;
  if (grey) return bits == 8 || bits == 16;
  return colour && (bits == 15 || bits == 16 || bits == 24 || bits == 32);
}

PictureHeader targa_header(const Bytes &bytes) {
  const unsigned kind = bytes.u8(2), pixel = (bytes.u8(16) + 7) / 8;
  const std::int64_t width = bytes.u16_little(12), height = bytes.u16_little(14), count = width * height;
  check_picture_size(bytes, width, height);
  const unsigned palette = bytes.u8(1) ? bytes.u16_little(5) : 0, entry_bits = bytes.u8(7);
  if (palette && entry_bits != 15 && entry_bits != 16 && entry_bits != 24 && entry_bits != 32) bytes.fail("is a broken TGA: its palette");
  if ((kind == 1 || kind == 9) && (palette != 256 || bytes.u16_little(3) != 0)) bytes.fail("is a TGA with a palette of other than 256 colours");
  std::size_t at = 18 + bytes.u8(0) + std::size_t(palette) * ((entry_bits + 7) / 8);
  if (kind < 9) {
    if (at > bytes.size() || static_cast<std::int64_t>(bytes.size() - at) < count * pixel) bytes.cut_off();
  } else {
    for (std::int64_t done = 0; done < count;) {
      const unsigned packet = bytes.u8(at);
      const std::int64_t run = (packet & 0x7f) + 1;
      at += 1 + (packet & 0x80 ? pixel : pixel * std::size_t(run));
      if (at > bytes.size()) bytes.cut_off();
      done += run;
      if (done > count) bytes.fail("is a broken TGA: a run that is longer than the picture");
    }
  }
  return {"targa", "tga", width, height};
}

PictureHeader any_header(const Bytes &bytes) {
  if (bytes.size() == 0) bytes.fail("is empty");
  if (bytes.starts_with("\x89PNG\r\n\x1a\n", 8)) return png_header(bytes);
  if (bytes.starts_with("\xff\xd8\xff", 3)) return jpeg_header(bytes);
  if (bytes.starts_with("#?", 2)) return hdr_header(bytes);
  if (bytes.starts_with("\x76\x2f\x31\x01", 4)) return read_exr_header(bytes);
  if (bytes.starts_with("RIFF", 4) && bytes.starts_with("WEBP", 4, 8)) return webp_header(bytes);
  if (bytes.starts_with("BM", 2)) return bmp_header(bytes);
  if (looks_like_targa(bytes)) return targa_header(bytes);
  bytes.fail("is no picture in a format that is read (PNG, JPEG, HDR, EXR, WebP, TGA, BMP)");
}

}  // namespace

PictureHeader read_picture_header(std::span<const std::byte> data, const std::string &name) {
  const Bytes bytes(data, name);
  const PictureHeader header = any_header(bytes);
  check_picture_size(bytes, header.width, header.height);
  return header;
}

}  // namespace sunstone
