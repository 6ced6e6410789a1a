// SPDX-License-Identifier: Apache-2.0
#include "learn/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "content/content.h"

namespace sunstone {

namespace {

double luminance(const float *rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

const std::vector<float> &rgb_of(const Image &image) { return std::get<std::vector<float>>(image.pixels); }

// Dark to bright, so that it reads without colours too. Linear values, as views encode them.
std::array<float, 3> false_colour(double t) {
  constexpr std::array<std::array<double, 3>, 5> stops = {{{0, 0, 0}, {0.02, 0.03, 0.25}, {0.45, 0.04, 0.35}, {0.95, 0.35, 0.05}, {1, 1, 0.9}}};
  const double at = std::clamp(t, 0.0, 1.0) * (stops.size() - 1);
  const std::size_t below = std::min<std::size_t>(static_cast<std::size_t>(at), stops.size() - 2);
  const double f = at - static_cast<double>(below);
  std::array<float, 3> colour{};
  for (std::size_t c = 0; c < 3; c++) colour[c] = static_cast<float>(stops[below][c] * (1 - f) + stops[below + 1][c] * f);
  return colour;
}

}  // namespace

Image beauty_of(const Film &film) { return {"film", film.width(), film.height(), 3, film_beauty(film)}; }

Film bounces_of(const Film &film, unsigned first, unsigned last) {
  Film part = film;
  part.layers.resize(2);
  for (FilmLayer &layer : part.layers) std::fill(layer.values.begin(), layer.values.end(), 0);
  for (unsigned depth = first; depth <= last; depth++) {
    const FilmLayer *layer = film.find(fmt::format("bounce.{}", depth));
    if (!layer) throw Error("film", fmt::format("has no layer of bounce {}", depth));
    for (std::size_t i = 0; i < layer->values.size(); i++) part.layers[0].values[i] += layer->values[i];
  }
  return part;
}

Film film_of(int width, int height, const std::vector<float> &rgb) {
  Film film;
  film.picture_width = film.x1 = width;
  film.picture_height = film.y1 = height;
  film.samples = {{0, 1}};
  for (const char *name : {"beauty.even", "beauty.odd"}) film.layers.push_back({name, std::vector<std::int64_t>(rgb.size() * SUN_FILM_BINS)});
  for (std::size_t i = 0; i < rgb.size(); i++)
    film.layers[0].values[i * SUN_FILM_BINS] = static_cast<std::int64_t>(std::llround(std::clamp(static_cast<double>(rgb[i]), -1e6, 1e6) * std::ldexp(1.0, SUN_FILM_FINE_BITS)));
  return film;
}

void write_png(const std::filesystem::path &path, const Film &film, float exposure) {
  ViewOptions view;
  view.exposure = exposure;
  load_content().write_picture(path, film, view);
}

Film error_map(const Image &image, const Image &reference, double white) {
  std::vector<float> rgb;
  const std::vector<float> &x = rgb_of(image), &r = rgb_of(reference);
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
    double error = 0;
    for (std::size_t c = 0; c < 3; c++) error += std::fabs(static_cast<double>(x[i + c]) - r.at(i + c)) / 3;
    for (const float channel : false_colour(error / white)) rgb.push_back(channel);
  }
  return film_of(image.width, image.height, rgb);
}

double mean_luminance(const Image &image) {
  const std::vector<float> &rgb = rgb_of(image);
  double sum = 0;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) sum += luminance(&rgb[i]);
  return sum / (static_cast<double>(rgb.size()) / 3);
}

Statistics statistics_of(const std::vector<Film> &films) {
  if (films.size() < 2) throw Error("statistics", "take two films at least");
  const double n = static_cast<double>(films.size()), pixels = static_cast<double>(films[0].pixels());
  std::vector<double> sum(films[0].pixels()), squares(films[0].pixels());
  for (const Film &film : films) {
    const std::vector<float> rgb = film_beauty(film);
    for (std::size_t i = 0; i < sum.size(); i++) {
      const double y = luminance(&rgb[i * 3]);
      sum[i] += y;
      squares[i] += y * y;
    }
  }
  Statistics s;
  double variance_of_films = 0;  // of a film's mean, averaged over the pixels
  for (std::size_t i = 0; i < sum.size(); i++) {
    const double mean = sum[i] / n;
    s.mean += mean / pixels;
    variance_of_films += std::max(0.0, (squares[i] - n * mean * mean) / (n - 1)) / pixels;
  }
  s.variance = variance_of_films * static_cast<double>(films[0].sample_count());
  s.mean_error = std::sqrt(variance_of_films / n / pixels);
  return s;
}

}  // namespace sunstone
