// SPDX-License-Identifier: Apache-2.0
// Film -> files. The suffix decides: .exr all layers; .png .jpg .hdr .tif a view; .film the integers.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "film/film.h"
#include "image/image.h"

namespace sunstone {

enum class Tone { none, filmic };

struct ViewOptions {
  std::optional<float> exposure = 0.0f;  // EV; empty: auto (log-average of the beauty to 0.18)
  Tone tone = Tone::none;
  bool transparent_background = false;   // alpha from the film's layer "alpha"
};

// The suffixes that write_picture knows, for messages.
const std::vector<std::string> &picture_suffixes();

// UsageError where the suffix is unknown: asked before a render begins.
void check_picture_name(const std::filesystem::path &path);

// Written beside and renamed; Error where it cannot be.
void write_picture(const std::filesystem::path &path, const Film &film, const ViewOptions &view);

struct Comparison {
  double rmse = 0, relmse = 0, psnr = 0, flip = 0, largest = 0;
  int largest_x = 0, largest_y = 0;
  std::size_t bad_pixels = 0;  // not finite in either picture
};

// Two pictures of one size, RGB. relMSE is the mean over pixels and channels of (x-r)^2 / (r^2 + 0.01), r the reference, nothing trimmed.
// FLIP after Andersson et al. 2020 (LDR). Throws Error where the sizes differ.
Comparison compare_images(const Image &image, const Image &reference);

// For `compare`: a picture of any readable suffix, .film included, as linear RGB floats.
Image read_picture(const std::filesystem::path &path);

}  // namespace sunstone
