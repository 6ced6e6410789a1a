// SPDX-License-Identifier: Apache-2.0
// Images and the ways materials use them -> texture records over pages of texels.
#pragma once
#include <map>
#include <tuple>

#include "flatten/flatten.h"

namespace sunstone {

// One way of looking up one image; becomes one kernel::Texture. An 8-bit image that is both colour and data is stored once and has two records.
struct TextureRequest {
  int image = -1;
  bool color = false;  // decoded from sRGB where the image holds encoded values
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool linear = true;
  auto operator<=>(const TextureRequest &) const = default;
};

// Collects what materials ask for; equal requests and equal references become one.
class TextureLibrary {
 public:
  explicit TextureLibrary(const Scene &scene) : scene_(&scene) {}
  // The reference that a material's slot names; SUN_NONE where there is no texture or its image could not be read.
  kernel::uint use(const TextureUse &use, bool color);
  const std::vector<TextureRequest> &requests() const { return requests_; }
  const std::vector<kernel::TextureRef> &refs() const { return refs_; }

 private:
  const Scene *scene_;
  std::vector<TextureRequest> requests_;
  std::vector<kernel::TextureRef> refs_;
  std::map<TextureRequest, kernel::uint> request_numbers_;
  std::map<std::array<kernel::uint, 8>, kernel::uint> ref_numbers_;
};

// Fills flat.texture_refs, flat.textures and flat.texel_pages. Throws Error where the texels do not fit into the pages.
void flatten_textures(const Scene &scene, const TextureLibrary &library, std::size_t max_page_bytes, FlatScene &flat, Notices &notices);

// Decoded texel (rows from the top, inside the picture): what the kernels see there.
std::array<float, 4> read_texel(const FlatScene &flat, const kernel::Texture &texture, kernel::uint x, kernel::uint y);

// The texel that holds (u, v) after wrapping.
std::array<float, 4> nearest_texel(const FlatScene &flat, const kernel::Texture &texture, float u, float v);

// Least and mean value of each channel over a whole texture, summed in a fixed order.
struct TextureRange {
  std::array<float, 4> least{1, 1, 1, 1};
  std::array<double, 4> mean{1, 1, 1, 1};
};
TextureRange texture_range(const FlatScene &flat, const kernel::Texture &texture);

// Bytes that a scene's images will take as texels, at most.
std::size_t texel_bytes(const Scene &scene);

}  // namespace sunstone
