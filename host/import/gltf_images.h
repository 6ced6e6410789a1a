// SPDX-License-Identifier: Apache-2.0
// Textures and the images behind them. Only images that a material uses are read; a fault in one is a warning, and the texture counts as none.
#pragma once
#include <optional>
#include <vector>

#include "import/gltf_buffers.h"
#include "scene/scene.h"

namespace sunstone::gltf {

class Images {
 public:
  Images(const Value &root, Buffers &buffers)
      : textures_(root["textures"]), images_(root["images"]), samplers_(root["samplers"]), buffers_(buffers) {}

  // The texture whose index `reference` holds, as a number into Scene::textures; -1 where it names no image.
  int texture(const Value &reference, Scene &scene);

  // Reads what was asked for, on several threads, and sets Texture::image.
  void read(Scene &scene);

 private:
  Value textures_, images_, samplers_;
  Buffers &buffers_;
  std::vector<int> numbers_;          // by glTF texture: its number in the scene, -1 no image, -2 not yet asked for
  std::vector<std::size_t> sources_;  // by texture of the scene: glTF image
};

}  // namespace sunstone::gltf
