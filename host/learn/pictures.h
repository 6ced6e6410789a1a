// SPDX-License-Identifier: Apache-2.0
// Films into pictures and figures: sums of bounce layers, errors, means.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "film/film.h"
#include "image/image.h"

namespace sunstone {

Image beauty_of(const Film &film);

// A film of the same samples that holds bounces [first, last] alone: what --max-depth would leave, to the bit, for roulette and limits end paths and
// change none of their contributions before. Needs a film with bounce layers.
Film bounces_of(const Film &film, unsigned first, unsigned last);

// A film of one sample with these values, to be written as a picture. RGB, rows from the top.
Film film_of(int width, int height, const std::vector<float> &rgb);

// Writes the PNG of a view. `exposure` in EV.
void write_png(const std::filesystem::path &path, const Film &film, float exposure = 0);

// |x - r| of each pixel, averaged over the channels, in false colours from black (0) over blue, magenta and orange to white (`white` and more).
Film error_map(const Image &image, const Image &reference, double white);

// The mean of a picture's luminance, over all pixels.
double mean_luminance(const Image &image);

struct Statistics {
  double mean = 0;        // of the luminance over the picture
  double mean_error = 0;  // one standard deviation of that mean, from the samples' own variance
  double variance = 0;    // of one sample's luminance in its pixel, averaged over the pixels
};
// From films of independent samples of the same picture: their spread gives the variance. Needs two at least.
Statistics statistics_of(const std::vector<Film> &films);

}  // namespace sunstone
