// SPDX-License-Identifier: Apache-2.0
#include "import/obj_textures.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace sunstone {

namespace {

// Picks channels of `from` (nullptr: all of it 1) into the channels of a new picture of the same size and kind.
template <class T>
std::vector<T> pick(std::size_t count, T one, std::initializer_list<std::tuple<const Image *, int>> sources) {
  std::vector<T> out(count * sources.size());
  std::size_t c = 0;
  for (const auto &[image, channel] : sources) {
    const std::vector<T> *from = image ? &std::get<std::vector<T>>(image->pixels) : nullptr;
    for (std::size_t i = 0; i < count; i++) out[i * sources.size() + c] = from ? (*from)[i * image->channels + channel] : one;
    c++;
  }
  return out;
}

Image picked(const Image &like, std::initializer_list<std::tuple<const Image *, int>> sources) {
  Image out;
  out.name = like.name;
  out.width = like.width;
  out.height = like.height;
  out.channels = static_cast<int>(sources.size());
  const std::size_t count = std::size_t(like.width) * like.height;
  if (like.is_float())
    out.pixels = pick<float>(count, 1.0f, sources);
  else
    out.pixels = pick<std::uint8_t>(count, 255, sources);
  return out;
}

bool has_alpha(const Image &image) {
  if (image.channels != 2 && image.channels != 4) return false;
  return std::visit(
      [&](const auto &pixels) {
        const auto full = image.is_float() ? 1 : 255;
        for (std::size_t i = image.channels - 1; i < pixels.size(); i += image.channels)
          if (pixels[i] < full) return true;
        return false;
      },
      image.pixels);
}

int channel_of(const Image &image, char named) {
  const int alpha = image.channels - 1;
  if (named == 'g' && image.channels >= 3) return 1;
  if (named == 'b' && image.channels >= 3) return 2;
  if (named == 'm' && has_alpha(image)) return alpha;  // the loader's default for all but bump maps
  return 0;
}

}  // namespace

int ObjTextures::image(const std::string &name, const std::string &place) {
  if (name.empty()) return -1;
  const auto [entry, is_new] = images_.try_emplace(name, -1);
  if (!is_new) return entry->second;
  const std::string shown = "\"" + printable(name) + "\"";
  try {
    if (names_drive(name) && !options_.allow_outside) throw Error(place, "it is an absolute path and is not read");
    const std::filesystem::path path = resolve_resource(folder_, name, options_, place);
    scene_.images.push_back(read_image(path));
    entry->second = static_cast<int>(scene_.images.size()) - 1;
  } catch (const Error &error) {
    notices_.warning(place, "rendered without the texture " + shown + ": " + error.reason);
  }
  return entry->second;
}

TextureUse ObjTextures::use(int image, const tinyobj::texture_option_t &options) {
  TextureUse use;
  if (image < 0) return use;
  const auto [entry, is_new] = textures_.try_emplace({image, options.clamp}, static_cast<int>(scene_.textures.size()));
  if (is_new) {
    Texture texture;
    texture.image = image;
    if (options.clamp) texture.wrap_u = texture.wrap_v = Wrap::clamp;
    scene_.textures.push_back(texture);
  }
  use.texture = entry->second;
  // OBJ's v runs up and ours down: 1 - (s (1 - v) + o) = s v + (1 - s - o).
  const float su = options.scale[0], sv = options.scale[1], ou = options.origin_offset[0], ov = options.origin_offset[1];
  use.transform = glm::mat3x2(su, 0, 0, sv, ou, 1 - sv - ov);
  return use;
}

TextureUse ObjTextures::color(const std::string &name, const tinyobj::texture_option_t &options, const std::string &place) {
  return use(image(name, place), options);
}

TextureUse ObjTextures::scalar(const std::string &name, const tinyobj::texture_option_t &options, const std::string &place) {
  const int source = image(name, place);
  if (source < 0) return {};
  const auto [entry, is_new] = grey_.try_emplace({source, options.imfchan}, source);
  if (is_new && scene_.images[source].channels > 1) {
    const Image &from = scene_.images[source];
    Image grey = picked(from, {{&from, channel_of(from, options.imfchan)}});
    scene_.images.push_back(std::move(grey));
    entry->second = static_cast<int>(scene_.images.size()) - 1;
  }
  return use(entry->second, options);
}

TextureUse ObjTextures::metallic_roughness(const tinyobj::material_t &material, const std::string &place) {
  const int rough = image(material.roughness_texname, place), metal = image(material.metallic_texname, place);
  if (rough < 0 && metal < 0) return {};
  const tinyobj::texture_option_t &options = rough >= 0 ? material.roughness_texopt : material.metallic_texopt;
  const auto [entry, is_new] = joined_.try_emplace({rough, metal}, -1);
  if (is_new) {
    const Image *const roughness = rough < 0 ? nullptr : &scene_.images[rough], *metallic = metal < 0 ? nullptr : &scene_.images[metal];
    if (roughness && metallic &&
        (roughness->width != metallic->width || roughness->height != metallic->height || roughness->is_float() != metallic->is_float())) {
      notices_.warning(place, "map_Pm is not used: it has another size or depth than map_Pr");
      metallic = nullptr;
    }
    const Image &like = roughness ? *roughness : *metallic;
    Image both = picked(like, {{nullptr, 0}, {roughness, 0}, {metallic, 0}});
    scene_.images.push_back(std::move(both));
    entry->second = static_cast<int>(scene_.images.size()) - 1;
  }
  return use(entry->second, options);
}

}  // namespace sunstone
