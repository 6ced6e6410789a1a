// SPDX-License-Identifier: Apache-2.0
// The channels of the EXR are a list made from the film's layers: each is a sum of integer layers, or what is told from the film as a whole.
#include "output/layers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "output/picture_writer.h"

namespace sunstone {

namespace {

constexpr int rows_at_once = 64;

struct Channel {
  enum class Kind { mean, variance, samples, identifier } kind = Kind::mean;
  std::string name;
  std::vector<const FilmLayer *> terms;  // added as integers
  int component = 0;                     // of the layers' three
  bool integer() const { return kind == Kind::samples || kind == Kind::identifier; }
};

using Terms = std::vector<const FilmLayer *>;

void add_three(std::vector<Channel> &channels, const std::string &prefix, const char *letters, const Terms &terms,
               Channel::Kind kind = Channel::Kind::mean) {
  for (int c = 0; c < SUN_FILM_CHANNELS; c++) channels.push_back({kind, prefix + letters[c], terms, c});
}

// The depth in "bounce.N", or -1.
int bounce_of(const std::string &name) {
  constexpr std::string_view prefix = "bounce.";
  if (!name.starts_with(prefix) || name.size() == prefix.size() || name.size() > prefix.size() + 6) return -1;
  const std::string digits = name.substr(prefix.size());
  return digits.find_first_not_of("0123456789") == std::string::npos ? std::stoi(digits) : -1;
}

std::vector<Channel> channels_of(const Film &film) {
  std::vector<Channel> channels;
  const Terms beauty = {&film.layers.at(SUN_LAYER_EVEN), &film.layers.at(SUN_LAYER_ODD)};
  add_three(channels, "", "RGB", beauty);
  if (const FilmLayer *alpha = film.find("alpha")) channels.push_back({Channel::Kind::mean, "A", {alpha}, 0});

  // Depth 0 is light seen directly, depth 1 what it lights: both are "direct" to a compositor; all that was scattered again is "indirect".
  Terms direct, indirect;
  for (std::size_t i = SUN_LAYER_FIRST_OPTIONAL; i < film.layers.size(); i++) {
    const FilmLayer &layer = film.layers[i];
    if (layer.name == "alpha") continue;
    if (layer.name == "Z") {
      channels.push_back({Channel::Kind::mean, "Z", {&layer}, 0});
    } else if (layer.name == "object_id" || layer.name == "material_id") {
      channels.push_back({Channel::Kind::identifier, layer.name, {&layer}, 0});
    } else {
      add_three(channels, layer.name + ".", layer.name == "normal" || layer.name == "position" ? "XYZ" : "RGB", {&layer});
    }
    if (const int bounce = bounce_of(layer.name); bounce >= 0) (bounce <= 1 ? direct : indirect).push_back(&layer);
  }
  if (!direct.empty()) {
    add_three(channels, "direct.", "RGB", direct);
    add_three(channels, "indirect.", "RGB", indirect);
  }
  channels.push_back({Channel::Kind::samples, "samples", {}, 0});
  add_three(channels, "variance.", "RGB", {}, Channel::Kind::variance);
  return channels;
}

// A channel of a pixel as the 32 bits that go into the file.
std::uint32_t bits_of(const Film &film, const Channel &channel, double samples, std::size_t pixel) {
  if (channel.kind == Channel::Kind::samples) return static_cast<std::uint32_t>(std::min(samples, 4294967295.0));
  if (channel.kind == Channel::Kind::variance) return std::bit_cast<std::uint32_t>(static_cast<float>(film_variance(film, pixel, channel.component)));
  const std::size_t at = (pixel * SUN_FILM_CHANNELS + static_cast<std::size_t>(channel.component)) * SUN_FILM_BINS;
  std::uint64_t fine = 0, coarse = 0;
  for (const FilmLayer *layer : channel.terms) {
    fine += static_cast<std::uint64_t>(layer->values[at]);
    coarse += static_cast<std::uint64_t>(layer->values[at + 1]);
  }
  const double sum = film_number(static_cast<std::int64_t>(fine), static_cast<std::int64_t>(coarse));
  if (channel.kind == Channel::Kind::identifier) return static_cast<std::uint32_t>(std::clamp(std::round(sum), 0.0, 4294967295.0));
  return std::bit_cast<std::uint32_t>(samples > 0 ? static_cast<float>(sum / samples) : 0.0f);
}

void add_metadata(OIIO::ImageSpec &spec, const Film &film) {
  const auto text = [&](const std::string &key, const std::string &value) {
    if (!value.empty()) spec.attribute("sunstone:" + key, value);
  };
  for (const auto &[key, value] : film.information) text(key, value);
  text("scene_hash", film.scene_hash);
  text("settings", nlohmann::json(film.settings).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  if (const auto seed = film.settings.find("seed"); seed != film.settings.end()) text("seed", seed->second);
  text("samples", show_samples(film.samples));
  text("film_hash", film_hash(film).hex());
  text("clamped", std::to_string(film.clamped));
  text("nan", std::to_string(film.nan));
  spec.attribute("sunstone:interrupted", film.interrupted ? 1 : 0);
}

}  // namespace

void write_layers(const std::filesystem::path &path, const Film &film) {
  const std::size_t values = film.pixels() * SUN_FILM_CHANNELS * SUN_FILM_BINS;
  for (const FilmLayer &layer : film.layers)
    if (layer.values.size() != values)
      throw Error(printable(path.string(), 400), "could not be written: layer " + printable(layer.name) + " does not fit the film's window");
  const std::vector<Channel> channels = channels_of(film);

  OIIO::ImageSpec spec(film.width(), film.height(), static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
  spec.x = film.x0, spec.y = film.y0;
  spec.full_width = film.picture_width, spec.full_height = film.picture_height;
  spec.channelnames.clear();
  for (std::size_t i = 0; i < channels.size(); i++) {
    spec.channelnames.push_back(channels[i].name);
    spec.channelformats.push_back(channels[i].integer() ? OIIO::TypeDesc::UINT32 : OIIO::TypeDesc::FLOAT);
    if (channels[i].name == "A") spec.alpha_channel = static_cast<int>(i);
    if (channels[i].name == "Z") spec.z_channel = static_cast<int>(i);
  }
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  add_metadata(spec, film);

  PictureWriter writer(path, "openexr", spec);
  const double samples = static_cast<double>(film.sample_count());
  const std::size_t width = static_cast<std::size_t>(film.width());
  std::vector<std::uint32_t> rows;
  for (int begin = 0; begin < film.height(); begin += rows_at_once) {
    const int end = std::min(begin + rows_at_once, film.height());
    rows.resize(static_cast<std::size_t>(end - begin) * width * channels.size());
    std::size_t i = 0;
    for (std::size_t pixel = static_cast<std::size_t>(begin) * width; pixel < static_cast<std::size_t>(end) * width; pixel++)
      for (const Channel &channel : channels) rows[i++] = bits_of(film, channel, samples, pixel);
    writer.rows(begin, end, OIIO::TypeDesc::UNKNOWN, rows.data());  // 32 bits a channel, float or uint
  }
  writer.finish();
}

}  // namespace sunstone
