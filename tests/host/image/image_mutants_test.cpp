// SPDX-License-Identifier: Apache-2.0
// Small pictures with bytes changed, cut out and put in: each decodes or is refused, and what decodes has the size that it says.
#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "host/image/pictures.h"
#include "image/image.h"

using namespace sunstone;
using namespace sunstone::test;

TEST(ImageMutants, DecodeOrAreRefused) {
  const std::vector<unsigned char> bytes = byte_pattern(21, 10, 4);
  const std::vector<Encoded> seeds = {
      encode("png", 21, 10, 4, OIIO::TypeDesc::UINT8, bytes),
      encode("jpeg", 21, 10, 3, OIIO::TypeDesc::UINT8, byte_pattern(21, 10, 3)),
      encode("webp", 21, 10, 4, OIIO::TypeDesc::UINT8, bytes),
      encode("targa", 21, 10, 4, OIIO::TypeDesc::UINT8, bytes),
      encode("targa", 21, 10, 3, OIIO::TypeDesc::UINT8, std::vector<unsigned char>(630, 7), {{"compression", "rle"}}),
      encode("bmp", 21, 10, 3, OIIO::TypeDesc::UINT8, byte_pattern(21, 10, 3)),
      bytes_of(paletted_bmp(16, 8, 40, 2)),
      encode("openexr", 21, 10, 4, OIIO::TypeDesc::FLOAT, float_pattern(21, 10, 4), {{"compression", "zip"}}),
      encode("openexr", 21, 10, 3, OIIO::TypeDesc::HALF, float_pattern(21, 10, 3), {{"compression", "none"}}),
      bytes_of(radiance(21, 10)),
  };
  std::mt19937 random(20240611);
  int decoded = 0, refused = 0;
  for (int i = 0; i < 1500; i++) {
    Encoded data = seeds[i % seeds.size()];
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int k = 0; k < changes && !data.empty(); k++) {
      // Half of the changes hit the header, where they matter most.
      const std::size_t at = random() % (random() % 2 ? data.size() : std::min<std::size_t>(data.size(), 128));
      switch (random() % 5) {
        case 0:
          data[at] = std::byte(random() % 256);
          break;
        case 1:
          data[at] ^= std::byte(1u << random() % 8);
          break;
        case 2:
          data[at] = std::byte(random() % 2 ? 0xff : 0);
          break;
        case 3:
          data.erase(data.begin() + static_cast<std::ptrdiff_t>(at));
          break;
        case 4:
          data.insert(data.begin() + static_cast<std::ptrdiff_t>(at), std::byte(random() % 256));
          break;
      }
    }
    try {
      const Image image = decode_image(data, "mutant");
      const std::size_t size = std::visit([](const auto &pixels) { return pixels.size(); }, image.pixels);
      ASSERT_EQ(size, std::size_t(image.width) * image.height * image.channels);
      decoded++;
    } catch (const Error &) {
      refused++;
    }
  }
  EXPECT_GT(decoded, 100);
  EXPECT_GT(refused, 100);
}
