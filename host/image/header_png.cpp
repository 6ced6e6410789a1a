// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string_view>

#include "image/header.h"

namespace sunstone {

namespace {

// CRC-32 as PNG's annex D has it: the polynomial 0xedb88320, bits from the lowest.
std::uint32_t checksum(std::span<const std::byte> data) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t i = 0; i < 256; i++) {
      t[i] = i;
      for (int k = 0; k < 8; k++) t[i] = t[i] & 1 ? 0xedb88320u ^ t[i] >> 1 : t[i] >> 1;
    }
    return t;
  }();
  std::uint32_t sum = 0xffffffffu;
  for (const std::byte b : data) sum = table[(sum ^ std::to_integer<std::uint32_t>(b)) & 255] ^ sum >> 8;
  return ~sum;
}

}  // namespace

std::vector<std::byte> plain_png(std::span<const std::byte> data, const std::string &name) {
  const Bytes bytes(data, name);
  std::vector<std::byte> out(data.begin(), data.begin() + 8);
  out.reserve(data.size());
  bool has_pixels = false;
  for (std::size_t at = 8;;) {
    const std::size_t length = bytes.u32_big(at);
    if (data.size() - at < 12 || length > data.size() - at - 12) bytes.cut_off();
    const std::string_view kind(reinterpret_cast<const char *>(data.data()) + at + 4, 4);
    const bool kept = kind == "IHDR" || kind == "PLTE" || kind == "tRNS" || kind == "IDAT" || kind == "IEND";
    if (kept) {
      if (checksum(data.subspan(at + 4, length + 4)) != bytes.u32_big(at + 8 + length))
        bytes.fail("is a broken PNG: the sum over its pixels or its header is wrong");
      out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(at), data.begin() + static_cast<std::ptrdiff_t>(at + 12 + length));
    } else if (!(kind[0] & 0x20)) {
      bytes.fail("is a PNG with a critical part of an unknown kind");
    }
    has_pixels = has_pixels || kind == "IDAT";
    at += 12 + length;
    if (kind == "IEND") break;
  }
  if (!has_pixels) bytes.fail("is a broken PNG: it has no pixels");
  return out;
}

}  // namespace sunstone
