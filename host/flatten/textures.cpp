// SPDX-License-Identifier: Apache-2.0
#include "flatten/textures.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "flatten/half.h"
#include "math/elementary.h"

namespace sunstone {
namespace {

using kernel::uint;

constexpr float half_limit = 65504;

uint wrap_code(Wrap wrap) { return wrap == Wrap::repeat ? SUN_WRAP_REPEAT : wrap == Wrap::mirror ? SUN_WRAP_MIRROR : SUN_WRAP_CLAMP; }

std::size_t words_per_texel(uint format) { return format == SUN_TEXEL_RGBA32F ? 4 : format == SUN_TEXEL_RGBA16F ? 2 : 1; }

// Texel i of an image of any number of channels: grey is spread over r, g and b, and alpha is 1 where there is none.
template <class T>
std::array<T, 4> rgba_of(const std::vector<T> &pixels, int channels, std::size_t i, T one) {
  const T *p = pixels.data() + i * static_cast<std::size_t>(channels);
  switch (channels) {
    case 1:
      return {p[0], p[0], p[0], one};
    case 2:
      return {p[0], p[0], p[0], p[1]};
    case 3:
      return {p[0], p[1], p[2], one};
    default:
      return {p[0], p[1], p[2], p[3]};
  }
}

float finite_or_zero(float x) { return std::isfinite(x) ? x : 0.0f; }

// What a float image holds, for the choice of its format.
struct FloatFacts {
  bool sixteen_bit = true;  // every value is some k / 65535: a file of 16-bit integers, hence sRGB-encoded where it is a colour
  bool halves = true;       // every value is a half
  bool within_half = true;  // no magnitude is beyond 65504
  std::size_t bad = 0;      // NaN or infinity
};

FloatFacts facts_of(const std::vector<float> &values) {
  FloatFacts facts;
  for (float value : values) {
    if (!std::isfinite(value)) {
      facts.bad++;
      continue;
    }
    const float scaled = value * 65535.0f;
    // Half a unit in the last place of 65535 is 2^-9; decoders round twice at most.
    facts.sixteen_bit = facts.sixteen_bit && value >= 0 && value <= 1 && std::fabs(scaled - std::floor(scaled + 0.5f)) <= 0.0079f;
    facts.halves = facts.halves && float_from_half(half_from_float(value)) == value;
    facts.within_half = facts.within_half && std::fabs(value) <= half_limit;
  }
  return facts;
}

float linear_from_srgb(float encoded) {
  if (encoded <= 0.04045f) return encoded / 12.92f;
  return kernel::pow_real((encoded + 0.055f) / 1.055f, 2.4f);
}

// One stretch of a page: an image in one encoding.
struct Stored {
  int image = -1;
  bool color = false;   // of a float image: negative values become 0 ...
  bool decode = false;  // ... and 16-bit sRGB becomes linear
  uint format = SUN_TEXEL_RGBA8;
  uint page = 0;
  std::size_t offset = 0, words = 0;
};

void store_bytes(const Image &image, uint *out) {
  const auto &pixels = std::get<0>(image.pixels);
  const auto width = static_cast<std::size_t>(image.width);
  tbb::parallel_for(std::size_t(0), static_cast<std::size_t>(image.height), [&](std::size_t y) {
    for (std::size_t i = y * width; i < (y + 1) * width; i++) {
      const auto t = rgba_of<std::uint8_t>(pixels, image.channels, i, 255);
      out[i] = t[0] | uint(t[1]) << 8 | uint(t[2]) << 16 | uint(t[3]) << 24;
    }
  });
}

void store_floats(const Image &image, const Stored &stored, uint *out) {
  const auto &pixels = std::get<1>(image.pixels);
  const auto width = static_cast<std::size_t>(image.width);
  tbb::parallel_for(std::size_t(0), static_cast<std::size_t>(image.height), [&](std::size_t y) {
    for (std::size_t i = y * width; i < (y + 1) * width; i++) {
      auto t = rgba_of<float>(pixels, image.channels, i, 1.0f);
      for (std::size_t c = 0; c < 4; c++) {
        t[c] = finite_or_zero(t[c]);
        if (stored.color && t[c] < 0) t[c] = 0;
        if (stored.decode && c < 3) t[c] = linear_from_srgb(t[c]);
      }
      if (stored.format == SUN_TEXEL_RGBA32F) {
        std::memcpy(out + 4 * i, t.data(), sizeof t);
      } else {
        out[2 * i] = half_from_float(t[0]) | uint(half_from_float(t[1])) << 16;
        out[2 * i + 1] = half_from_float(t[2]) | uint(half_from_float(t[3])) << 16;
      }
    }
  });
}

}  // namespace

uint TextureLibrary::use(const TextureUse &use, bool color) {
  if (!use || scene_->textures[static_cast<std::size_t>(use.texture)].image < 0) return SUN_NONE;
  const Texture &texture = scene_->textures[static_cast<std::size_t>(use.texture)];
  const TextureRequest request{texture.image, color, texture.wrap_u, texture.wrap_v, texture.linear};
  const auto [found, added] = request_numbers_.try_emplace(request, static_cast<uint>(requests_.size()));
  if (added) requests_.push_back(request);
  kernel::TextureRef ref{};
  ref.texture = found->second;
  ref.uv_set = use.uv_set == 1 ? 1 : 0;
  for (int row = 0; row < 2; row++)
    for (int column = 0; column < 3; column++) ref.m[3 * row + column] = use.transform[column][row];
  const auto [number, fresh] = ref_numbers_.try_emplace(std::bit_cast<std::array<uint, 8>>(ref), static_cast<uint>(refs_.size()));
  if (fresh) refs_.push_back(ref);
  return number->second;
}

void flatten_textures(const Scene &scene, const TextureLibrary &library, std::size_t max_page_bytes, FlatScene &flat, Notices &notices) {
  flat.texture_refs = library.refs();
  std::map<std::pair<int, bool>, std::size_t> numbers;  // (image, colour) -> stored; bytes are stored once for both
  std::map<int, FloatFacts> facts;
  std::vector<Stored> all;
  std::vector<std::size_t> stored_of_request;
  for (const TextureRequest &request : library.requests()) {
    const Image &image = scene.images[static_cast<std::size_t>(request.image)];
    const auto [found, added] = numbers.try_emplace({request.image, request.color && image.is_float()}, all.size());
    stored_of_request.push_back(found->second);
    if (!added) continue;
    Stored stored;
    stored.image = request.image;
    if (image.is_float()) {
      const auto [fact, first] = facts.try_emplace(request.image);
      if (first) {
        fact->second = facts_of(std::get<1>(image.pixels));
        if (fact->second.bad) notices.warning(printable(image.name), std::to_string(fact->second.bad) + " values are not finite; each counts as 0");
      }
      stored.color = request.color;
      stored.decode = request.color && fact->second.sixteen_bit;
      stored.format = (request.color ? fact->second.within_half : fact->second.halves) ? SUN_TEXEL_RGBA16F : SUN_TEXEL_RGBA32F;
    }
    stored.words = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * words_per_texel(stored.format);
    all.push_back(stored);
  }

  // First fit in the order of use, so that where a texture lies depends on the scene and the page size alone.
  const std::size_t page_words = std::min(max_page_bytes / sizeof(uint), std::size_t(std::numeric_limits<uint>::max()));
  std::array<std::size_t, SUN_TEXTURE_PAGES> filled{};
  for (Stored &stored : all) {
    while (stored.page < SUN_TEXTURE_PAGES && stored.words > page_words - filled[stored.page]) stored.page++;
    if (stored.page == SUN_TEXTURE_PAGES)
      throw Error{printable(scene.images[static_cast<std::size_t>(stored.image)].name),
                  "the textures do not fit into " + std::to_string(SUN_TEXTURE_PAGES) + " buffers of " +
                      std::to_string(page_words * sizeof(uint) >> 20) + " MiB",
                  "use smaller images, or a device whose largest buffer is larger"};
    stored.offset = filled[stored.page];
    filled[stored.page] += stored.words;
  }
  for (std::size_t page = 0; page < SUN_TEXTURE_PAGES; page++) flat.texel_pages[page].resize(filled[page]);
  for (const Stored &stored : all) {
    const Image &image = scene.images[static_cast<std::size_t>(stored.image)];
    uint *out = flat.texel_pages[stored.page].data() + stored.offset;
    image.is_float() ? store_floats(image, stored, out) : store_bytes(image, out);
  }

  for (std::size_t i = 0; i < library.requests().size(); i++) {
    const TextureRequest &request = library.requests()[i];
    const Stored &stored = all[stored_of_request[i]];
    const Image &image = scene.images[static_cast<std::size_t>(request.image)];
    kernel::Texture texture{};
    texture.page = stored.page;
    texture.offset = static_cast<uint>(stored.offset);
    texture.width = static_cast<uint>(image.width);
    texture.height = static_cast<uint>(image.height);
    texture.format = request.color && stored.format == SUN_TEXEL_RGBA8 ? SUN_TEXEL_RGBA8_SRGB : stored.format;
    texture.wrap_u = wrap_code(request.wrap_u);
    texture.wrap_v = wrap_code(request.wrap_v);
    texture.linear = request.linear ? 1 : 0;
    flat.textures.push_back(texture);
  }
}

std::array<float, 4> read_texel(const FlatScene &flat, const kernel::Texture &texture, uint x, uint y) {
  const std::size_t texel = static_cast<std::size_t>(y) * texture.width + x;
  const uint *words = flat.texel_pages[texture.page].data() + texture.offset + texel * words_per_texel(texture.format);
  std::array<float, 4> value;
  if (texture.format == SUN_TEXEL_RGBA32F) {
    std::memcpy(value.data(), words, sizeof value);
  } else if (texture.format == SUN_TEXEL_RGBA16F) {
    for (std::size_t c = 0; c < 4; c++) value[c] = float_from_half(static_cast<std::uint16_t>(words[c / 2] >> (c % 2 ? 16 : 0)));
  } else {
    for (std::size_t c = 0; c < 4; c++) {
      const uint byte = (words[0] >> (8 * c)) & 255u;
      value[c] = texture.format == SUN_TEXEL_RGBA8_SRGB && c < 3 ? flat.tables[SUN_TABLE_SRGB + byte] : static_cast<float>(byte) / 255.0f;
    }
  }
  return value;
}

std::array<float, 4> nearest_texel(const FlatScene &flat, const kernel::Texture &texture, float u, float v) {
  const auto cell = [](float t, uint size, uint wrap) {
    if (wrap == SUN_WRAP_REPEAT) t = t - std::floor(t);
    if (wrap == SUN_WRAP_MIRROR) {
      t = t - 2.0f * std::floor(t * 0.5f);
      t = t > 1.0f ? 2.0f - t : t;
    }
    t = t > 0.0f ? (t < 1.0f ? t : 1.0f) : 0.0f;  // NaN gives 0
    const auto i = static_cast<uint>(t * static_cast<float>(size));
    return i < size ? i : size - 1;
  };
  return read_texel(flat, texture, cell(u, texture.width, texture.wrap_u), cell(v, texture.height, texture.wrap_v));
}

TextureRange texture_range(const FlatScene &flat, const kernel::Texture &texture) {
  std::vector<TextureRange> rows(texture.height);
  tbb::parallel_for(uint(0), texture.height, [&](uint y) {
    TextureRange row;
    row.mean = {};
    row.least.fill(INFINITY);
    for (uint x = 0; x < texture.width; x++) {
      const auto texel = read_texel(flat, texture, x, y);
      for (std::size_t c = 0; c < 4; c++) {
        row.least[c] = std::min(row.least[c], texel[c]);
        row.mean[c] += texel[c];
      }
    }
    rows[y] = row;
  });
  TextureRange range;
  range.mean = {};
  range.least.fill(INFINITY);
  for (const TextureRange &row : rows)
    for (std::size_t c = 0; c < 4; c++) {
      range.least[c] = std::min(range.least[c], row.least[c]);
      range.mean[c] += row.mean[c];
    }
  const double texels = static_cast<double>(texture.width) * texture.height;
  for (double &mean : range.mean) mean /= texels;
  return range;
}

std::size_t texel_bytes(const Scene &scene) {
  std::vector<bool> looked_up(scene.images.size());
  for (const Texture &texture : scene.textures)
    if (texture.image >= 0) looked_up[static_cast<std::size_t>(texture.image)] = true;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < scene.images.size(); i++) {
    const Image &image = scene.images[i];
    if (looked_up[i]) bytes += static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * (image.is_float() ? 16 : 4);
  }
  return bytes;
}

}  // namespace sunstone
