// SPDX-License-Identifier: Apache-2.0
// Pictures in memory, encoded by OpenImageIO's own writers.
#pragma once
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace sunstone::test {

using Encoded = std::vector<std::byte>;

// `values` are interleaved, of the kind that `type` says.
template <class T>
Encoded encode(const char *format, int width, int height, int channels, OIIO::TypeDesc type, const std::vector<T> &values,
               const std::vector<std::pair<std::string, std::string>> &options = {}, const std::vector<std::string> &names = {}) {
  OIIO::ImageSpec spec(width, height, channels, type);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  for (const auto &[name, value] : options) spec.attribute(name, value);
  if (!names.empty()) spec.channelnames = names;
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
  if (!output || !output->supports("ioproxy")) throw std::runtime_error(std::string(format) + " cannot be written to memory");
  output->set_ioproxy(&memory);
  const std::string suffix = std::string(format) == "openexr" ? "exr" : std::string(format) == "targa" ? "tga" : format;
  if (!output->open("picture." + suffix, spec)) throw std::runtime_error(output->geterror());
  if (!output->write_image(OIIO::BaseTypeFromC<T>::value, values.data())) throw std::runtime_error(output->geterror());
  output->close();
  Encoded out(bytes.size());
  std::memcpy(out.data(), bytes.data(), bytes.size());
  return out;
}

inline Encoded bytes_of(const std::string &text) {
  Encoded out(text.size());
  std::memcpy(out.data(), text.data(), text.size());
  return out;
}

// A few values that differ in every channel and pixel.
inline std::vector<unsigned char> byte_pattern(int width, int height, int channels) {
  std::vector<unsigned char> out(std::size_t(width) * height * channels);
  for (std::size_t i = 0; i < out.size(); i++) out[i] = static_cast<unsigned char>((i * 37 + i / channels * 11) % 251);
  return out;
}
inline std::vector<float> float_pattern(int width, int height, int channels) {
  std::vector<float> out(std::size_t(width) * height * channels);
  for (std::size_t i = 0; i < out.size(); i++) out[i] = static_cast<float>(i % 97) * 0.125f;
  return out;
}

// Radiance with flat pixels; `size` stands in for the line "-Y h +X w".
inline std::string radiance(int width, int height, const std::string &size = {}) {
  std::string text =
      "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + (size.empty() ? "-Y " + std::to_string(height) + " +X " + std::to_string(width) : size) + "\n";
  for (int i = 0; i < width * height; i++) text += {char(60 + i % 60), char(90), char(120), char(129)};
  return text;
}

// An uncompressed BMP of 8 bits a pixel with `colours` palette entries, pixel i being `first` + i.
inline std::string paletted_bmp(int width, int height, unsigned colours, unsigned first) {
  std::string out = "BM";
  const auto u32 = [&](unsigned value) {
    for (int k = 0; k < 4; k++) out += static_cast<char>(value >> 8 * k & 255);
  };
  const unsigned stride = (width + 3) / 4 * 4, pixels = 54 + 4 * colours;
  u32(pixels + stride * height);
  u32(0);
  u32(pixels);
  u32(40);
  u32(width);
  u32(height);
  u32(1 | 8 << 16);
  for (const unsigned value : {0u, stride * height, 2835u, 2835u, colours, 0u}) u32(value);
  for (unsigned i = 0; i < colours; i++) u32(i | i * 2 % 256 << 8 | i * 3 % 256 << 16);
  for (int y = 0; y < height; y++)
    for (unsigned x = 0; x < stride; x++) out += static_cast<char>(first + x);
  return out;
}

}  // namespace sunstone::test
