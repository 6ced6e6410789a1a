// SPDX-License-Identifier: Apache-2.0
#include "image/image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "image/header.h"

namespace sunstone {

namespace {

constexpr int rows_at_once = 64;

// OpenImageIO keeps limits of its own, one set for the process. They are set once, and no lower than what check_picture_size lets through.
void set_library_limits() {
  static const bool done = [] {
    OIIO::attribute("limits:imagesize_MB", static_cast<int>(max_image_pixels / (1 << 20) * 16));
    OIIO::attribute("limits:channels", 1024);
    return true;
  }();
  static_cast<void>(done);
}

// The channels to keep, from the first: a colour and its alpha; no depth, no further layers.
int kept_channels(const OIIO::ImageSpec &spec) {
  const auto ends_in = [&](int i, char letter) {
    if (i >= spec.nchannels) return false;
    const std::string name = spec.channel_name(i);
    return !name.empty() && name.back() == letter && (name.size() == 1 || name[name.size() - 2] == '.');
  };
  if (ends_in(0, 'R') && ends_in(1, 'G') && ends_in(2, 'B')) return ends_in(3, 'A') ? 4 : 3;
  if (ends_in(0, 'Y')) return ends_in(1, 'A') ? 2 : 1;
  return std::min(spec.nchannels, 4);
}

// One line, and no more than a line, of what the library says.
std::string library_message(OIIO::ImageInput &input) {
  const std::string text = input.geterror();
  return text.empty() ? "" : ": " + printable(text.substr(0, text.find('\n')), 200);
}

template <class T>
std::vector<T> read_pixels(OIIO::ImageInput &input, const OIIO::ImageSpec &spec, int channels, OIIO::TypeDesc type, const std::string &name) {
  std::vector<T> pixels;
  const std::size_t row = std::size_t(spec.width) * channels;
  const auto broken = [&] { return Error(name, "is cut off or broken" + library_message(input)); };
  pixels.reserve(row * spec.height);  // memory is touched only as rows arrive, so that a small file cannot ask for much
  if (spec.tile_width > 0) {
    pixels.resize(row * spec.height);
    if (!input.read_image(0, 0, 0, channels, type, pixels.data())) throw broken();
    return pixels;
  }
  for (int y = 0; y < spec.height; y += rows_at_once) {
    const int end = std::min(y + rows_at_once, spec.height);
    pixels.resize(row * end);
    if (!input.read_scanlines(0, 0, spec.y + y, spec.y + end, spec.z, 0, channels, type, pixels.data() + row * y)) throw broken();
  }
  return pixels;
}

// OpenImageIO 2.4's WebP reader multiplies alpha in, whatever it is asked. Dividing brings the colours back but for rounding; behind no alpha they
// are lost.
void divide_by_alpha(std::vector<std::uint8_t> &pixels) {
  for (std::size_t i = 0; i + 3 < pixels.size(); i += 4) {
    const unsigned alpha = pixels[i + 3];
    if (alpha == 0 || alpha == 255) continue;
    for (int c = 0; c < 3; c++) pixels[i + c] = static_cast<std::uint8_t>(std::min(255u, (pixels[i + c] * 255u + alpha / 2) / alpha));
  }
}

Image decode(std::span<const std::byte> data, const PictureHeader &header, const std::string &name) {
  set_library_limits();
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte *>(data.data()), data.size());  // it only reads
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(header.format, false);
  if (!input || !input->supports("ioproxy")) {
    OIIO::geterror();
    throw Error(name, std::string("this build of OpenImageIO cannot read ") + header.format + " from memory");
  }
  input->threads(1);
  OIIO::ImageSpec config, spec;
  config.attribute("oiio:UnassociatedAlpha", 1);
  config.attribute("bmp:monochrome_detect", 0);
  input->set_ioproxy(&memory);
  if (!input->open(std::string("picture.") + header.suffix, spec, config)) throw Error(name, "cannot be decoded" + library_message(*input));
  if (spec.width != header.width || spec.height != header.height || spec.depth > 1 || spec.nchannels < 1 || spec.deep)
    throw Error(name, "is broken: its size is not the one in its header");
  Image image;
  image.name = name;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = kept_channels(spec);
  if (spec.format == OIIO::TypeDesc::UINT8)
    image.pixels = read_pixels<std::uint8_t>(*input, spec, image.channels, OIIO::TypeDesc::UINT8, name);
  else
    image.pixels = read_pixels<float>(*input, spec, image.channels, OIIO::TypeDesc::FLOAT, name);
  if (header.format == std::string_view("webp") && image.channels == 4 && !image.is_float() && spec.get_int_attribute("oiio:UnassociatedAlpha") == 0)
    divide_by_alpha(std::get<std::vector<std::uint8_t>>(image.pixels));
  const std::string late = input->geterror();  // some readers say only in passing that a part was missing
  if (!late.empty()) throw Error(name, "is cut off or broken: " + printable(late.substr(0, late.find('\n')), 200));
  input->close();
  return image;
}

}  // namespace

Image decode_image(std::span<const std::byte> data, const std::string &name) {
  const PictureHeader header = read_picture_header(data, name);
  try {
    if (header.format == std::string_view("png")) return decode(plain_png(data, name), header, name);
    return decode(data, header, name);
  } catch (const Error &) {
    throw;
  } catch (const std::bad_alloc &) {
    throw Error(name, "there is not enough memory for its " + std::to_string(header.width) + " x " + std::to_string(header.height) + " pixels");
  } catch (const std::exception &error) {
    throw Error(name, "cannot be decoded: " + printable(error.what(), 200));
  } catch (...) {
    throw Error(name, "cannot be decoded");
  }
}

Image read_image(const std::filesystem::path &path) { return decode_image(read_file(path), printable(path.string(), 400)); }

}  // namespace sunstone
