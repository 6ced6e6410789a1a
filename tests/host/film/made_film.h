// SPDX-License-Identifier: Apache-2.0
// Films made in code: of known values, or of integers that fill every bit.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "film/film.h"

namespace sunstone::test {

inline FilmLayer empty_layer(const Film &film, std::string name) {
  return {std::move(name), std::vector<std::int64_t>(film.pixels() * SUN_FILM_CHANNELS * SUN_FILM_BINS, 0)};
}

// A film of `samples` over the whole picture, black.
inline Film black_film(int width, int height, std::vector<SampleRange> samples, const std::vector<std::string> &layers = {}) {
  Film film;
  film.picture_width = film.x1 = width;
  film.picture_height = film.y1 = height;
  film.samples = std::move(samples);
  film.scene_hash = "0123456789abcdef0123456789abcdef";
  film.settings = {{"integrator", "path"}, {"max_depth", "16"}, {"seed", "7"}};
  film.information = {{"version", "0.1.0"}, {"device", "a device"}, {"seconds", "1.500"}, {"scene", "room.gltf"}};
  film.layers.push_back(empty_layer(film, "beauty.even"));
  film.layers.push_back(empty_layer(film, "beauty.odd"));
  for (const std::string &name : layers) film.layers.push_back(empty_layer(film, name));
  return film;
}

inline FilmLayer &layer(Film &film, const std::string &name) { return const_cast<FilmLayer &>(*film.find(name)); }

// Adds `sum`, whose quanta are whole, to a channel as the kernels would: below 1 in fine quanta, else in coarse ones.
inline void add(Film &film, const std::string &name, std::size_t pixel, int channel, double sum) {
  const std::size_t at = (pixel * SUN_FILM_CHANNELS + static_cast<std::size_t>(channel)) * SUN_FILM_BINS;
  if (std::fabs(sum) < 1)
    layer(film, name).values[at] += static_cast<std::int64_t>(std::ldexp(sum, SUN_FILM_FINE_BITS));
  else
    layer(film, name).values[at + 1] += static_cast<std::int64_t>(std::ldexp(sum, SUN_FILM_COARSE_BITS));
}

// Every bit of every bin drawn at random: sums wrap around.
inline void fill_at_random(Film &film, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (FilmLayer &each : film.layers)
    for (std::int64_t &value : each.values) value = static_cast<std::int64_t>(random());
}

}  // namespace sunstone::test
