// SPDX-License-Identifier: Apache-2.0
#include "output/view.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "output/color.h"
#include "output/picture_writer.h"
#include "output/suffix.h"

namespace sunstone {

namespace {

const FilmLayer &alpha_of(const Film &film) {
  const FilmLayer *alpha = film.find("alpha");
  if (!alpha) throw Error("film", "has no layer alpha, which a transparent background needs", "render with --background transparent");
  return *alpha;
}

// Beauty, with alpha as fourth channel where `transparent`: colours are multiplied by it, as light that passed.
std::vector<float> linear_pixels(const Film &film, bool transparent) {
  const std::vector<float> beauty = film_beauty(film);
  if (!transparent) return beauty;
  const FilmLayer &alpha = alpha_of(film);
  std::vector<float> pixels;
  pixels.reserve(film.pixels() * 4);
  for (std::size_t i = 0; i < film.pixels(); i++) {
    for (std::size_t c = 0; c < 3; c++) pixels.push_back(beauty[i * 3 + c]);
    pixels.push_back(static_cast<float>(film_value(film, alpha, i, 0)));
  }
  return pixels;
}

}  // namespace

float automatic_exposure(std::span<const float> rgb) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const double y = luminance(rgb[i], rgb[i + 1], rgb[i + 2]);
    if (!(y > 0) || !std::isfinite(y)) continue;
    sum += std::log2(y);
    count++;
  }
  return count ? static_cast<float>(std::log2(0.18) - sum / static_cast<double>(count)) : 0.0f;
}

double filmic(double x) {
  x = std::min(x, 1e6);  // the quotient's limit lies above 1 long before its squares overflow
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

std::vector<std::uint8_t> view_bytes(const Film &film, const ViewOptions &options) {
  const std::vector<float> beauty = film_beauty(film);
  const FilmLayer *alpha = options.transparent_background ? &alpha_of(film) : nullptr;
  const double scale = std::exp2(static_cast<double>(options.exposure ? *options.exposure : automatic_exposure(beauty)));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(film.pixels() * (alpha ? 4 : 3));
  for (std::size_t i = 0; i < film.pixels(); i++) {
    const double coverage = alpha ? std::clamp(film_value(film, *alpha, i, 0), 0.0, 1.0) : 1.0;
    for (std::size_t c = 0; c < 3; c++) {
      // The curve is for the surface's colour, so the alpha that was multiplied in comes out first.
      const double radiance = coverage > 0 ? std::max(0.0, static_cast<double>(beauty[i * 3 + c])) / coverage * scale : 0.0;
      const double shown = options.tone == Tone::filmic ? filmic(radiance) : std::min(radiance, 1.0);
      bytes.push_back(byte_of(srgb_encode(shown)));
    }
    if (alpha) bytes.push_back(byte_of(coverage));
  }
  return bytes;
}

void write_view(const std::filesystem::path &path, const Film &film, const ViewOptions &options) {
  const std::string suffix = suffix_of(path);
  const bool jpeg = suffix == ".jpg" || suffix == ".jpeg", hdr = suffix == ".hdr", tiff = suffix == ".tif" || suffix == ".tiff";
  ViewOptions used = options;
  if (jpeg || hdr) used.transparent_background = false;  // they have no alpha: the picture stands before black, as it was added up
  const int channels = used.transparent_background ? 4 : 3;
  const bool linear = hdr || tiff;

  OIIO::ImageSpec spec(film.width(), film.height(), channels, linear ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
  if (jpeg) {
    spec.attribute("Compression", "jpeg:95");
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  if (tiff) spec.attribute("compression", "zip");
  if (linear) {
    std::vector<float> pixels = linear_pixels(film, used.transparent_background);
    if (hdr)
      for (float &value : pixels) value = std::max(value, 0.0f);  // RGBE has no sign
    PictureWriter writer(path, hdr ? "hdr" : "tiff", spec);
    writer.rows(0, film.height(), OIIO::TypeDesc::FLOAT, pixels.data());
    writer.finish();
    return;
  }
  spec.attribute("oiio:UnassociatedAlpha", 1);  // ours is straight already
  const std::vector<std::uint8_t> bytes = view_bytes(film, used);
  PictureWriter writer(path, jpeg ? "jpeg" : "png", spec);
  writer.rows(0, film.height(), OIIO::TypeDesc::UINT8, bytes.data());
  writer.finish();
}

}  // namespace sunstone
