// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "base/error.h"
#include "host/image/pictures.h"
#include "image/image.h"
#include "image/radiance.h"

using namespace sunstone;
using namespace sunstone::test;

namespace {

template <class T>
const std::vector<T> &values(const Image &image) {
  return std::get<std::vector<T>>(image.pixels);
}

// The reason that decoding is refused with; empty where it is not.
std::string refusal(const Encoded &data) {
  try {
    decode_image(data, "picture");
  } catch (const Error &error) {
    EXPECT_EQ(error.place, "picture");
    return error.reason;
  }
  return "";
}

}  // namespace

TEST(ImageDecode, LosslessBytesComeBackAsTheyWere) {
  for (const char *format : {"png", "targa", "bmp"})
    for (int channels = 3; channels <= (std::string(format) == "bmp" ? 3 : 4); channels++) {
      const std::vector<unsigned char> pattern = byte_pattern(13, 7, channels);
      const Image image = decode_image(encode(format, 13, 7, channels, OIIO::TypeDesc::UINT8, pattern), "picture");
      ASSERT_FALSE(image.is_float()) << format;
      EXPECT_EQ(image.width, 13) << format;
      EXPECT_EQ(image.height, 7) << format;
      EXPECT_EQ(image.channels, channels) << format;
      EXPECT_EQ(values<std::uint8_t>(image), pattern) << format << " " << channels;  // alpha is not multiplied in
    }
}

TEST(ImageDecode, RunLengthCodedTargaComesBack) {
  std::vector<unsigned char> pattern(40 * 9 * 3);
  for (std::size_t i = 0; i < pattern.size(); i++) pattern[i] = static_cast<unsigned char>(i / 60);
  const Image image = decode_image(encode("targa", 40, 9, 3, OIIO::TypeDesc::UINT8, pattern, {{"compression", "rle"}}), "picture");
  EXPECT_EQ(values<std::uint8_t>(image), pattern);
}

TEST(ImageDecode, GreyPngKeepsOneChannel) {
  const std::vector<unsigned char> pattern = byte_pattern(5, 3, 1);
  const Image image = decode_image(encode("png", 5, 3, 1, OIIO::TypeDesc::UINT8, pattern), "picture");
  EXPECT_EQ(image.channels, 1);
  EXPECT_EQ(values<std::uint8_t>(image), pattern);
}

TEST(ImageDecode, SixteenBitsBecomeFloatsBetweenZeroAndOne) {
  std::vector<unsigned short> pattern(6 * 4 * 3);
  for (std::size_t i = 0; i < pattern.size(); i++) pattern[i] = static_cast<unsigned short>(i * 911);
  const Image image = decode_image(encode("png", 6, 4, 3, OIIO::TypeDesc::UINT16, pattern), "picture");
  ASSERT_TRUE(image.is_float());
  for (std::size_t i = 0; i < pattern.size(); i++) EXPECT_NEAR(values<float>(image)[i], pattern[i] / 65535.0, 1e-7);
}

TEST(ImageDecode, LossyFormatsComeBackNearly) {
  std::vector<unsigned char> smooth(32 * 32 * 3);
  for (int i = 0; i < 32 * 32; i++)
    for (int c = 0; c < 3; c++) smooth[3 * i + c] = static_cast<unsigned char>(100 + i / 32 + c * 20);
  for (const char *format : {"jpeg", "webp"}) {
    const Image image = decode_image(encode(format, 32, 32, 3, OIIO::TypeDesc::UINT8, smooth), "picture");
    ASSERT_FALSE(image.is_float()) << format;
    ASSERT_EQ(values<std::uint8_t>(image).size() / image.channels, smooth.size() / 3) << format;
    double sum = 0;
    for (int i = 0; i < 32 * 32; i++)
      for (int c = 0; c < 3; c++) sum += std::abs(int(values<std::uint8_t>(image)[i * image.channels + c]) - int(smooth[3 * i + c]));
    EXPECT_LT(sum / smooth.size(), 4) << format;
  }
}

TEST(ImageDecode, FloatsOfExrComeBackExactly) {
  for (const char *compression : {"none", "zip", "piz", "rle"}) {
    const std::vector<float> pattern = float_pattern(33, 70, 4);
    const Image image = decode_image(encode("openexr", 33, 70, 4, OIIO::TypeDesc::FLOAT, pattern, {{"compression", compression}}), "picture");
    ASSERT_TRUE(image.is_float());
    EXPECT_EQ(image.channels, 4);
    EXPECT_EQ(values<float>(image), pattern) << compression;
  }
}

TEST(ImageDecode, ExrKeepsColourAndAlphaAndNoFurtherLayer) {
  const std::vector<float> pattern = float_pattern(4, 4, 6);
  const Encoded depth = encode("openexr", 4, 4, 6, OIIO::TypeDesc::FLOAT, pattern, {}, {"R", "G", "B", "Z", "normal.X", "normal.Y"});
  const Image three = decode_image(depth, "picture");
  ASSERT_EQ(three.channels, 3);
  const Encoded alpha = encode("openexr", 4, 4, 6, OIIO::TypeDesc::FLOAT, pattern, {}, {"R", "G", "B", "A", "Z", "id"});
  const Image four = decode_image(alpha, "picture");
  ASSERT_EQ(four.channels, 4);
  for (int i = 0; i < 16; i++)
    for (int c = 0; c < 4; c++) {
      EXPECT_EQ(values<float>(four)[4 * i + c], pattern[6 * i + c]);
      if (c < 3) {
        EXPECT_EQ(values<float>(three)[3 * i + c], pattern[6 * i + c]);
      }
    }
}

TEST(ImageDecode, RadianceIsRead) {
  const Image image = decode_image(bytes_of(radiance(16, 8)), "picture");
  ASSERT_TRUE(image.is_float());
  EXPECT_EQ(image.channels, 3);
  EXPECT_NEAR(values<float>(image)[1], 90 / 256.0 * 2, 0.01);
}

TEST(ImageDecode, PalettesAreReadWhereEveryIndexIsInThem) {
  const Image image = decode_image(bytes_of(paletted_bmp(4, 2, 10, 3)), "picture");
  ASSERT_EQ(image.channels, 3);
  EXPECT_EQ(values<std::uint8_t>(image)[0], 9);  // red of entry 3
  EXPECT_EQ(values<std::uint8_t>(image)[2], 3);
  EXPECT_NE(refusal(bytes_of(paletted_bmp(4, 2, 5, 3))).find("beyond its palette"), std::string::npos);
}

TEST(ImageDecode, WhatIsCutOffIsRefusedAtEveryLength) {
  const std::vector<unsigned char> bytes = byte_pattern(19, 11, 3);
  const std::vector<std::pair<const char *, Encoded>> pictures = {
      {"png", encode("png", 19, 11, 3, OIIO::TypeDesc::UINT8, bytes)},
      {"jpeg", encode("jpeg", 19, 11, 3, OIIO::TypeDesc::UINT8, bytes)},
      {"webp", encode("webp", 19, 11, 3, OIIO::TypeDesc::UINT8, bytes)},
      {"targa", encode("targa", 19, 11, 3, OIIO::TypeDesc::UINT8, bytes)},
      {"bmp", encode("bmp", 19, 11, 3, OIIO::TypeDesc::UINT8, bytes)},
      {"exr", encode("openexr", 19, 11, 3, OIIO::TypeDesc::FLOAT, float_pattern(19, 11, 3))},
      {"hdr", bytes_of(radiance(19, 11))},
  };
  for (const auto &[name, whole] : pictures) {
    EXPECT_EQ(refusal(whole), "") << name;
    const std::size_t spare = std::string(name) == "targa" ? 600 : 0;  // its footer, behind all the pixels
    const std::size_t last = whole.size() - std::min(whole.size(), spare) - 1;
    for (std::size_t length = 0; length <= last; length += 1 + last / 150) {
      const Encoded part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length));
      EXPECT_NE(refusal(part), "") << name << " cut at " << length << " of " << whole.size();
    }
  }
}

TEST(ImageDecode, HeadersThatClaimTooMuchAreRefusedAtOnce) {
  const auto start = std::chrono::steady_clock::now();
  Encoded png = encode("png", 2, 2, 3, OIIO::TypeDesc::UINT8, byte_pattern(2, 2, 3));
  for (int k = 0; k < 8; k++) png[16 + k] = std::byte(k % 4 == 1 ? 1 : k % 4 == 2 ? 0x86 : k % 4 == 3 ? 0xa0 : 0);  // 100,000 x 100,000
  EXPECT_NE(refusal(png).find("100000 x 100000"), std::string::npos);
  EXPECT_NE(refusal(bytes_of(radiance(4, 4, "-Y 1000000 +X 2000000"))).find("2000000 x 1000000"), std::string::npos);
  EXPECT_NE(refusal(bytes_of(radiance(4, 4, "-Y 16000 +X 16000"))).find("cut off"), std::string::npos);
  EXPECT_NE(refusal(bytes_of(radiance(0, 0))).find("0 x 0"), std::string::npos);
  EXPECT_NE(refusal(bytes_of(radiance(4, 4, "-Y 99999999999999999999 +X 4"))), "");
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 1.0);
}

TEST(ImageDecode, WhatIsNoPictureIsSaidToBeNone) {
  EXPECT_EQ(refusal({}), "is empty");
  EXPECT_NE(refusal(bytes_of("GIF89a...............................................")).find("no picture in a format"), std::string::npos);
  EXPECT_NE(refusal(bytes_of("II*\0 a TIFF file, which is not opened")), "");
  EXPECT_NE(refusal(bytes_of("some text that is no picture at all")), "");
}

TEST(ImageDecode, WebPAlphaIsNotMultipliedIn) {
  std::vector<unsigned char> pattern(16 * 16 * 4);  // the writer takes alpha out again, by a gamma of 2.2: 100 is stored as 137
  for (int i = 0; i < 16 * 16; i++)
    for (int c = 0; c < 4; c++) pattern[4 * i + c] = c == 0 ? 100 : c == 1 ? 50 : c == 2 ? 25 : 128;
  const Image image = decode_image(encode("webp", 16, 16, 4, OIIO::TypeDesc::UINT8, pattern), "picture");
  ASSERT_EQ(image.channels, 4);
  EXPECT_NEAR(values<std::uint8_t>(image)[0], 100 * std::pow(255 / 128.0, 1 / 2.2), 6);
  EXPECT_NEAR(values<std::uint8_t>(image)[3], 128, 2);
}

TEST(RadianceMap, FaultsBecomeZeroAndAreCounted) {
  Image image{"map", 2, 2, 4, std::vector<float>{NAN, 1, 2, 0, INFINITY, -1, 3, 0, 4, 5, 6, 0, 7, -8, 9, NAN}};
  RadianceFaults faults;
  const Image map = radiance_map(image, faults);
  EXPECT_EQ(map.channels, 3);
  EXPECT_EQ(values<float>(map), (std::vector<float>{0, 1, 2, 0, 0, 3, 4, 5, 6, 7, 0, 9}));
  EXPECT_EQ(faults.nan, 1u);
  EXPECT_EQ(faults.infinite, 1u);
  EXPECT_EQ(faults.negative, 2u);
}

TEST(RadianceMap, BytesAreDecodedFromSrgbAndGreyIsSpread) {
  Image image{"map", 3, 1, 2, std::vector<std::uint8_t>{0, 9, 255, 9, 128, 9}};
  RadianceFaults faults;
  const Image map = radiance_map(image, faults);
  EXPECT_EQ(values<float>(map)[0], 0);
  EXPECT_EQ(values<float>(map)[5], 1);
  for (int c = 0; c < 3; c++) EXPECT_NEAR(values<float>(map)[6 + c], 0.21586, 1e-5);
}
