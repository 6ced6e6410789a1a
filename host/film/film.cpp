// SPDX-License-Identifier: Apache-2.0
// Adding films, reading numbers off them, and naming them by hash.
#include "film/film.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "base/error.h"

namespace sunstone {

namespace {

// The bins are integers modulo 2^64: adding them as unsigned numbers is defined whatever a file claims, and associative.
std::int64_t wrapping_sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

struct Halves {
  std::uint64_t even = 0, odd = 0;
};

Halves halves_of(const std::vector<SampleRange> &samples) {
  const auto evens_below = [](std::uint64_t n) { return n / 2 + n % 2; };
  Halves halves;
  for (const SampleRange &range : samples) {
    const std::uint64_t even = evens_below(range.last) - evens_below(range.first);
    halves.even += even;
    halves.odd += range.last - range.first - even;
  }
  return halves;
}

// Integers into a hash as little-endian bytes, a block at a time.
class IntegerHasher {
 public:
  explicit IntegerHasher(Hasher &hasher) : hasher_(hasher) {}
  ~IntegerHasher() { flush(); }
  void add(std::int64_t value) {
    block_[used_++] = value;
    if (used_ == block_.size()) flush();
  }

 private:
  void flush() {
    static_assert(std::endian::native == std::endian::little, "film hashes are of little-endian bytes");
    hasher_.bytes(block_.data(), used_ * sizeof block_[0]);
    used_ = 0;
  }
  Hasher &hasher_;
  std::array<std::int64_t, 1024> block_;
  std::size_t used_ = 0;
};

void hash_window(Hasher &hasher, const Film &film) {
  for (const int number : {film.picture_width, film.picture_height, film.x0, film.y0, film.x1, film.y1})
    hasher.value(static_cast<std::int64_t>(number));
  hasher.value(film.sample_count());
}

std::string name_of(const Film &film, const char *otherwise) { return film.name.empty() ? otherwise : printable(film.name); }

std::string show_window(const Film &film) {
  return std::to_string(film.x0) + "," + std::to_string(film.y0) + "," + std::to_string(film.x1) + "," + std::to_string(film.y1);
}
std::string show_size(const Film &film) { return std::to_string(film.picture_width) + "x" + std::to_string(film.picture_height); }

std::string settings_difference(const Film &a, const Film &b, const std::string &in_a, const std::string &in_b) {
  std::set<std::string> keys;
  for (const auto &[key, value] : a.settings) keys.insert(key);
  for (const auto &[key, value] : b.settings) keys.insert(key);
  const auto show = [](const std::map<std::string, std::string> &settings, const std::string &key) {
    const auto found = settings.find(key);
    return found == settings.end() ? std::string("not set") : found->second.empty() ? std::string("empty") : printable(found->second, 60);
  };
  std::string text;
  for (const std::string &key : keys) {
    const auto value_a = a.settings.find(key), value_b = b.settings.find(key);
    if (value_a != a.settings.end() && value_b != b.settings.end() && value_a->second == value_b->second) continue;
    text += (text.empty() ? "" : ", ") + printable(key, 60) + " is " + show(a.settings, key) + in_a + " and " + show(b.settings, key) + in_b;
  }
  return text;
}

// What was written about both: seconds add, of all else each distinct entry stays, in an order that does not depend on which film came first.
std::string join_information(const std::string &key, const std::string &a, const std::string &b) {
  if (key == "seconds") {
    char *end_a = nullptr, *end_b = nullptr;
    const double sum = std::strtod(a.c_str(), &end_a) + std::strtod(b.c_str(), &end_b);
    if (end_a != a.c_str() && end_b != b.c_str() && !*end_a && !*end_b && std::isfinite(sum)) {
      char text[32];
      std::snprintf(text, sizeof text, "%.3f", sum);
      return text;
    }
  }
  std::set<std::string> entries;
  for (const std::string *text : {&a, &b}) {
    for (std::size_t begin = 0; begin <= text->size();) {
      const std::size_t end = std::min(text->find("; ", begin), text->size());
      entries.insert(text->substr(begin, end - begin));
      begin = end + 2;
    }
  }
  entries.erase("");
  std::string joined;
  for (const std::string &entry : entries) joined += (joined.empty() ? "" : "; ") + entry;
  return joined;
}

}  // namespace

const FilmLayer *Film::find(const std::string &layer_name) const {
  const auto found = std::find_if(layers.begin(), layers.end(), [&](const FilmLayer &layer) { return layer.name == layer_name; });
  return found == layers.end() ? nullptr : &*found;
}

double film_number(std::int64_t fine, std::int64_t coarse) {
  return static_cast<double>(fine) * std::ldexp(1.0, -SUN_FILM_FINE_BITS) + static_cast<double>(coarse) * std::ldexp(1.0, -SUN_FILM_COARSE_BITS);
}

std::uint64_t layer_samples(const Film &film, const FilmLayer &layer) {
  return layer.name == "object_id" || layer.name == "material_id" ? 1 : film.sample_count();
}

double film_value(const Film &film, const FilmLayer &layer, std::size_t pixel, int channel) {
  const std::uint64_t samples = layer_samples(film, layer);
  if (samples == 0) return 0;
  const std::size_t at = (pixel * SUN_FILM_CHANNELS + static_cast<std::size_t>(channel)) * SUN_FILM_BINS;
  return film_number(layer.values.at(at), layer.values.at(at + 1)) / static_cast<double>(samples);
}

std::vector<float> film_beauty(const Film &film) {
  const std::size_t values = film.pixels() * SUN_FILM_CHANNELS;
  std::vector<float> beauty(values, 0.0f);
  const std::uint64_t samples = film.sample_count();
  if (samples == 0) return beauty;
  const std::vector<std::int64_t> &even = film.layers.at(SUN_LAYER_EVEN).values, &odd = film.layers.at(SUN_LAYER_ODD).values;
  for (std::size_t i = 0; i < values; i++)
    beauty[i] = static_cast<float>(film_number(wrapping_sum(even[2 * i], odd[2 * i]), wrapping_sum(even[2 * i + 1], odd[2 * i + 1])) /
                                   static_cast<double>(samples));
  return beauty;
}

// With means E of m and O of n samples, whose variance s^2 is one sample's: E[(E-O)^2] = s^2 (1/m + 1/n), and the mean of all has variance s^2 /
// (m+n).
double film_variance(const Film &film, std::size_t pixel, int channel) {
  const Halves halves = halves_of(film.samples);
  if (halves.even == 0 || halves.odd == 0) return std::numeric_limits<double>::infinity();
  const double m = static_cast<double>(halves.even), n = static_cast<double>(halves.odd);
  const std::size_t at = (pixel * SUN_FILM_CHANNELS + static_cast<std::size_t>(channel)) * SUN_FILM_BINS;
  const std::vector<std::int64_t> &even = film.layers.at(SUN_LAYER_EVEN).values, &odd = film.layers.at(SUN_LAYER_ODD).values;
  const double difference = film_number(even.at(at), even.at(at + 1)) / m - film_number(odd.at(at), odd.at(at + 1)) / n;
  return difference * difference * (m * n) / ((m + n) * (m + n));
}

double estimated_error(const Film &film) {
  const Halves halves = halves_of(film.samples);
  if (halves.even == 0 || halves.odd == 0 || film.pixels() == 0) return std::numeric_limits<double>::infinity();
  const std::vector<float> beauty = film_beauty(film);
  double sum = 0;
  for (std::size_t pixel = 0; pixel < film.pixels(); pixel++)
    for (int channel = 0; channel < SUN_FILM_CHANNELS; channel++) {
      const double mean = beauty[pixel * SUN_FILM_CHANNELS + static_cast<std::size_t>(channel)];
      sum += film_variance(film, pixel, channel) / (mean * mean + 0.01);
    }
  return sum / static_cast<double>(beauty.size());
}

std::string film_difference(const Film &a, const Film &b) {
  const std::string in_a = " in " + name_of(a, "the one"), in_b = " in " + name_of(b, "the other");
  const auto differs = [&](const char *what, const std::string &value_a, const std::string &value_b) {
    return std::string(what) + " is " + value_a + in_a + " and " + value_b + in_b;
  };
  if (a.scene_hash != b.scene_hash) return "scenes differ: " + differs("the hash", printable(a.scene_hash), printable(b.scene_hash));
  const std::string settings = settings_difference(a, b, in_a, in_b);
  if (!settings.empty()) return "settings differ: " + settings;
  if (a.picture_width != b.picture_width || a.picture_height != b.picture_height)
    return "pictures differ: " + differs("the size", show_size(a), show_size(b));
  if (a.x0 != b.x0 || a.y0 != b.y0 || a.x1 != b.x1 || a.y1 != b.y1)
    return "pictures differ: " + differs("the crop window", show_window(a), show_window(b));
  for (const FilmLayer &layer : a.layers)
    if (!b.find(layer.name)) return "layers differ: " + printable(layer.name) + " is missing" + in_b;
  for (const FilmLayer &layer : b.layers) {
    const FilmLayer *mine = a.find(layer.name);
    if (!mine) return "layers differ: " + printable(layer.name) + " is missing" + in_a;
    if (mine->values.size() != layer.values.size())
      return "layers differ: " +
             differs((printable(layer.name) + "'s length").c_str(), std::to_string(mine->values.size()), std::to_string(layer.values.size()));
  }
  return {};
}

void add_film(Film &film, const Film &other) {
  const std::string place = name_of(other, "film");
  const std::string difference = film_difference(film, other);
  if (!difference.empty()) throw Error(place, "cannot be added to " + name_of(film, "the film") + ": " + difference);
  std::vector<SampleRange> samples = film.samples;
  for (const SampleRange &range : other.samples) {
    try {
      insert_samples(samples, range);
    } catch (const Error &error) {
      throw Error(place, "cannot be added to " + name_of(film, "the film") + ": " + error.reason);
    }
  }
  // Nothing throws from here on but for want of memory, and that before the integers change.
  std::map<std::string, std::string> information = film.information;
  for (const auto &[key, value] : other.information) {
    const auto [at, added] = information.emplace(key, value);
    if (!added && (at->second != value || key == "seconds")) at->second = join_information(key, at->second, value);
  }
  for (FilmLayer &layer : film.layers) {
    const std::vector<std::int64_t> &theirs = other.find(layer.name)->values;
    for (std::size_t i = 0; i < theirs.size(); i++) layer.values[i] = wrapping_sum(layer.values[i], theirs[i]);
  }
  film.samples.swap(samples);
  film.information.swap(information);
  film.clamped += other.clamped;
  film.nan += other.nan;
  film.interrupted = film.interrupted || other.interrupted;
}

Hash film_hash(const Film &film) {
  Hasher hasher;
  hash_window(hasher, film);
  const std::vector<std::int64_t> &even = film.layers.at(SUN_LAYER_EVEN).values, &odd = film.layers.at(SUN_LAYER_ODD).values;
  {
    IntegerHasher integers(hasher);
    for (std::size_t i = 0; i < even.size(); i++) integers.add(wrapping_sum(even[i], odd.at(i)));
  }
  return hasher.digest();
}

Hash layer_hash(const Film &film, const FilmLayer &layer) {
  Hasher hasher;
  hash_window(hasher, film);
  hasher.add(layer.name);
  {
    IntegerHasher integers(hasher);
    for (const std::int64_t value : layer.values) integers.add(value);
  }
  return hasher.digest();
}

}  // namespace sunstone
