// SPDX-License-Identifier: Apache-2.0
// The film on the host: sums of integers over (pixels, samples). Films add, and that is the whole protocol between devices, processes and days.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/hash.h"
#include "shared/film.h"

namespace sunstone {

struct SampleRange {
  std::uint64_t first = 0, last = 0;  // half-open
  bool operator==(const SampleRange &) const = default;
};

struct FilmLayer {
  std::string name;  // beauty.even beauty.odd bounce.0 ... albedo normal Z position object_id material_id
  std::vector<std::int64_t> values;  // ((row * width + column) * 3 + channel) * 2 + bin, over the crop window
};

struct Film {
  int picture_width = 0, picture_height = 0;      // of the whole picture
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;             // crop window, half-open; the film covers this
  std::vector<SampleRange> samples;               // sorted, disjoint, not adjacent: the same for every pixel
  std::vector<FilmLayer> layers;                  // the first two are beauty.even and beauty.odd
  std::string scene_hash;                         // hex
  std::map<std::string, std::string> settings;    // what decides the bits: integrator, max_depth, seed, sampler, filter, camera, environment ...
  std::map<std::string, std::string> information; // what does not: version, device, seconds, scene file
  std::uint64_t clamped = 0, nan = 0;             // contributions
  bool interrupted = false;
  std::string name;                               // where it came from, for messages; empty: made here

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  std::size_t pixels() const { return static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()); }
  std::uint64_t sample_count() const;
  const FilmLayer *find(const std::string &name) const;
};

// bin 0 * 2^-36 + bin 1 * 2^-12.
double film_number(std::int64_t fine, std::int64_t coarse);

// The samples that a layer is summed over: all of the film's, but sample 0 alone where it holds identifiers, which have no average.
std::uint64_t layer_samples(const Film &film, const FilmLayer &layer);

// One channel's value of a layer, averaged over layer_samples (0 where there are none).
double film_value(const Film &film, const FilmLayer &layer, std::size_t pixel, int channel);

// beauty.even + beauty.odd as floats, RGB, rows from the top of the crop window.
std::vector<float> film_beauty(const Film &film);

// The variance of the beauty's mean, estimated from its two halves: one degree of freedom a channel, for display and --error, too weak for tests.
// Infinity where a half has no sample.
double film_variance(const Film &film, std::size_t pixel, int channel);

// Adds `other` to `film`. Throws Error saying what differs: scene hash, a setting, the window, the layers, or samples that both hold.
void add_film(Film &film, const Film &other);

// Why `b` cannot be added to `a` apart from samples, or an empty string.
std::string film_difference(const Film &a, const Film &b);

// Inserts a range; throws Error where it overlaps one that is there.
void insert_samples(std::vector<SampleRange> &ranges, SampleRange range);
std::string show_samples(const std::vector<SampleRange> &ranges);  // "0:16, 32:48"

// Covers picture size, crop window, sample count and the beauty's integers (even + odd added first), nothing else: the same on every device.
Hash film_hash(const Film &film);
Hash layer_hash(const Film &film, const FilmLayer &layer);

// relMSE of the beauty estimated from its two halves, for progress and --error; infinity below 2 samples.
double estimated_error(const Film &film);

}  // namespace sunstone
