// SPDX-License-Identifier: Apache-2.0
// Suffix -> writer; and any picture back as linear RGB.
#include "output/output.h"

#include <cstring>
#include <exception>

#include "base/error.h"
#include "base/file.h"
#include "film/film_file.h"
#include "output/color.h"
#include "output/layers.h"
#include "output/suffix.h"
#include "output/view.h"

namespace sunstone {

void write_picture(const std::filesystem::path &path, const Film &film, const ViewOptions &view) {
  check_picture_name(path);
  const std::string suffix = suffix_of(path);
  if (suffix == ".film") return write_film(path, film);
  if (film.pixels() == 0) throw Error(printable(path.string(), 400), "could not be written: the film has no pixels");
  try {
    if (suffix == ".exr") return write_layers(path, film);
    write_view(path, film, view);
  } catch (const Error &) {
    throw;
  } catch (const std::bad_alloc &) {
    throw Error(printable(path.string(), 400), "could not be written: there is not enough memory to encode it");
  } catch (const std::exception &error) {
    throw Error(printable(path.string(), 400), "could not be encoded: " + printable(error.what(), 200));
  }
}

// OpenEXR and Radiance files hold light, all others what a screen shows.
static bool is_linear(std::span<const std::byte> data) {
  const auto begins = [&](std::string_view magic) {
    return data.size() >= magic.size() && std::memcmp(data.data(), magic.data(), magic.size()) == 0;
  };
  return begins("\x76\x2f\x31\x01") || begins("#?");
}

Image read_picture(const std::filesystem::path &path) {
  const std::string name = printable(path.string(), 400);
  if (suffix_of(path) == ".film") {
    const Film film = read_film(path);
    return {name, film.width(), film.height(), 3, film_beauty(film)};
  }
  const std::vector<std::byte> data = read_file(path);
  const Image image = decode_image(data, name);
  const bool linear = is_linear(data);
  std::vector<float> from_byte(256);
  for (std::size_t i = 0; i < from_byte.size(); i++) {
    const double value = static_cast<double>(i) / 255;
    from_byte[i] = static_cast<float>(linear ? value : srgb_decode(value));
  }
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height),
                    channels = static_cast<std::size_t>(image.channels);
  std::vector<float> rgb(pixels * 3);
  for (std::size_t i = 0; i < pixels; i++)
    for (std::size_t c = 0; c < 3; c++) {
      const std::size_t at = i * channels + (channels >= 3 ? c : 0);  // one or two channels are grey, with or without alpha
      if (const auto *bytes = std::get_if<std::vector<std::uint8_t>>(&image.pixels))
        rgb[i * 3 + c] = from_byte[(*bytes)[at]];
      else
        rgb[i * 3 + c] =
            linear ? std::get<std::vector<float>>(image.pixels)[at] : static_cast<float>(srgb_decode(std::get<std::vector<float>>(image.pixels)[at]));
    }
  return {name, image.width, image.height, 3, std::move(rgb)};
}

}  // namespace sunstone
