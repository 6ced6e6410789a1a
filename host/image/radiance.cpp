// SPDX-License-Identifier: Apache-2.0
#include "image/radiance.h"

#include <array>
#include <cmath>

#include "math/elementary.h"

namespace sunstone {

namespace {

float usable(float value, RadianceFaults &faults) {
  if (std::isnan(value))
    faults.nan++;
  else if (std::isinf(value))
    faults.infinite++;
  else if (value < 0)
    faults.negative++;
  else
    return value;
  return 0;
}

// The curve of IEC 61966-2-1, in the arithmetic that all our numbers share.
std::array<float, 256> srgb_to_linear() {
  std::array<float, 256> table;
  for (int i = 0; i < 256; i++) {
    const float value = static_cast<float>(i) / 255.0f;
    table[i] = value <= 0.04045f ? value / 12.92f : kernel::pow_real((value + 0.055f) / 1.055f, 2.4f);
  }
  return table;
}

}  // namespace

Image radiance_map(const Image &picture, RadianceFaults &faults) {
  Image map;
  map.name = picture.name;
  map.width = picture.width;
  map.height = picture.height;
  map.channels = 3;
  const std::size_t count = std::size_t(picture.width) * picture.height;
  const int channels = picture.channels;
  const bool grey = channels < 3;
  std::vector<float> pixels(count * 3);
  if (picture.is_float()) {
    const std::vector<float> &from = std::get<std::vector<float>>(picture.pixels);
    for (std::size_t i = 0; i < count; i++)
      for (int c = 0; c < 3; c++) pixels[3 * i + c] = grey && c > 0 ? pixels[3 * i] : usable(from[i * channels + c], faults);
  } else {
    const std::vector<std::uint8_t> &from = std::get<std::vector<std::uint8_t>>(picture.pixels);
    const std::array<float, 256> table = srgb_to_linear();
    for (std::size_t i = 0; i < count; i++)
      for (int c = 0; c < 3; c++) pixels[3 * i + c] = table[from[i * channels + (grey ? 0 : c)]];
  }
  map.pixels = std::move(pixels);
  return map;
}

}  // namespace sunstone
