// SPDX-License-Identifier: Apache-2.0
// Textures that a material library names: pictures are read once, and one that is missing or broken is one warning.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "import/import.h"
#include "import/obj_loader.h"

namespace sunstone {

class ObjTextures {
 public:
  // `obj` is the scene's file: pictures are looked up in its folder, and warnings name it.
  ObjTextures(const std::filesystem::path &obj, const ImportOptions &options, Scene &scene, Notices &notices)
      : folder_(obj.parent_path()), options_(options), scene_(scene), notices_(notices) {}

  // A picture as it is; nothing where `name` is empty or cannot be read. `place` names the material.
  TextureUse color(const std::string &name, const tinyobj::texture_option_t &options, const std::string &place);
  // One channel of a picture as grey: the one that -imfchan names, else its alpha where that says anything, else its first.
  TextureUse scalar(const std::string &name, const tinyobj::texture_option_t &options, const std::string &place);
  // Roughness in green and metallic in blue, each from the first channel of a picture of its own.
  TextureUse metallic_roughness(const tinyobj::material_t &material, const std::string &place);

 private:
  int image(const std::string &name, const std::string &place);
  TextureUse use(int image, const tinyobj::texture_option_t &options);
  std::filesystem::path folder_;
  const ImportOptions &options_;
  Scene &scene_;
  Notices &notices_;
  std::map<std::string, int> images_;             // by name; -1: not there
  std::map<std::tuple<int, char>, int> grey_;     // by picture and channel
  std::map<std::pair<int, int>, int> joined_;     // by the pictures of roughness and metallic
  std::map<std::pair<int, bool>, int> textures_;  // by picture and -clamp
};

}  // namespace sunstone
