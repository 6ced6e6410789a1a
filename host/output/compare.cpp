// SPDX-License-Identifier: Apache-2.0
// How far two pictures of linear RGB are apart.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "output/flip.h"
#include "output/output.h"

namespace sunstone {

static const std::vector<float> &rgb_of(const Image &image) {
  const auto *pixels = std::get_if<std::vector<float>>(&image.pixels);
  if (image.width < 1 || image.height < 1 || image.channels != 3 || !pixels ||
      pixels->size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3)
    throw Error(image.name, "is not a picture of linear RGB");
  return *pixels;
}

static std::string show_size(const Image &image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

Comparison compare_images(const Image &image, const Image &reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(image.name, "has " + show_size(image) + " pixels, but " + reference.name + " has " + show_size(reference));
  std::vector<float> test = rgb_of(image), expected = rgb_of(reference);
  Comparison result;
  double squares = 0, relative = 0;
  std::size_t values = 0;
  const std::size_t pixels = test.size() / 3;
  for (std::size_t i = 0; i < pixels; i++) {
    float *x = &test[i * 3], *r = &expected[i * 3];
    const auto finite = [](const float *rgb) { return std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]); };
    if (!finite(x) || !finite(r)) {
      // Counted, and left out of all else: both are black for FLIP, which looks at neighbours.
      result.bad_pixels++;
      std::fill_n(x, 3, 0.0f);
      std::fill_n(r, 3, 0.0f);
      continue;
    }
    for (int c = 0; c < 3; c++) {
      const double reference_value = r[c], difference = x[c] - reference_value;
      squares += difference * difference;
      relative += difference * difference / (reference_value * reference_value + 0.01);
      if (std::fabs(difference) > result.largest) {
        result.largest = std::fabs(difference);
        result.largest_x = static_cast<int>(i % static_cast<std::size_t>(image.width));
        result.largest_y = static_cast<int>(i / static_cast<std::size_t>(image.width));
      }
    }
    values += 3;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (values == 0) {
    result.rmse = result.relmse = result.largest = infinity;
    result.psnr = -infinity;
    result.flip = 1;
    return result;
  }
  result.rmse = std::sqrt(squares / static_cast<double>(values));
  result.relmse = relative / static_cast<double>(values);
  result.psnr = result.rmse > 0 ? -20 * std::log10(result.rmse) : infinity;
  const std::vector<float> errors = flip_errors(test, expected, image.width, image.height, flip_pixels_per_degree);
  double sum = 0;
  for (const float error : errors) sum += error;
  result.flip = sum / static_cast<double>(errors.size());
  return result;
}

}  // namespace sunstone
