// SPDX-License-Identifier: Apache-2.0
// Materials: metallic-roughness and its extensions, as far as sunstone renders them.
#pragma once
#include <vector>

#include "import/gltf_images.h"
#include "scene/scene.h"

namespace sunstone::gltf {

class Materials {
 public:
  Materials(const Value &root, Images &images) : materials_(root["materials"]), images_(images), numbers_(materials_.size(), -1) {}

  // The material whose index `reference` holds, as a number into Scene::materials; -1, the default one, where it is absent.
  int material(const Value &reference, Scene &scene);

 private:
  Material read(const Value &value, Scene &scene);
  TextureUse texture(const Value &info, Scene &scene);

  Value materials_;
  Images &images_;
  std::vector<int> numbers_;  // by glTF material
};

}  // namespace sunstone::gltf
