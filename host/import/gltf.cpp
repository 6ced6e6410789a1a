// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 -> Scene. The parts: gltf_strict (bytes -> JSON), gltf_value (typed access), gltf_buffers, gltf_accessors, gltf_images, gltf_materials,
// gltf_skins, gltf_meshes, gltf_curves, gltf_animations, gltf_hierarchy, gltf_nodes. The sections cited are those of the glTF 2.0 specification.
#include <algorithm>
#include <charconv>
#include <cstdio>

#include "base/error.h"
#include "base/file.h"
#include "import/gltf_nodes.h"
#include "import/importers.h"

namespace sunstone {

namespace {

using namespace gltf;

constexpr const char *supported_extensions[] = {
    "EXT_mesh_gpu_instancing", "EXT_texture_webp",       "KHR_implicit_shapes", "KHR_lights_punctual",  "KHR_materials_emissive_strength",
    "KHR_materials_ior",       "KHR_materials_specular", "KHR_materials_unlit",  "KHR_materials_transmission",
    "KHR_materials_volume",    "KHR_mesh_quantization",  "KHR_texture_transform"};

// "2.0" -> major and minor.
std::pair<unsigned, unsigned> version_of(const Value &value) {
  const std::string text = value.text();
  unsigned major = 0, minor = 0;
  const char *const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, major);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '.') value.fail("\"" + printable(text, 40) + "\" is no version");
  const auto second = std::from_chars(first.ptr + 1, end, minor);
  if (second.ec != std::errc() || second.ptr != end) value.fail("\"" + printable(text, 40) + "\" is no version");
  return {major, minor};
}

void check_asset(const Value &root) {
  const Value asset = root["asset"], version = asset["version"];
  if (!version) version.fail("is missing");
  if (const auto [major, minor] = version_of(version); major != 2)
    version.fail("glTF " + std::to_string(major) + "." + std::to_string(minor) + " is not supported, only 2.x");
  if (const Value least = asset["minVersion"])
    if (const auto [major, minor] = version_of(least); major != 2 || minor > 0)
      least.fail("the file asks for glTF " + std::to_string(major) + "." + std::to_string(minor) + ", and 2.0 is what is supported");
}

void check_required_extensions(const Value &root) {
  const Value required = root["extensionsRequired"];
  for (std::size_t i = 0; i < required.size(); i++) {
    const std::string name = required[i].text();
    if (std::find(std::begin(supported_extensions), std::end(supported_extensions), name) == std::end(supported_extensions))
      required[i].fail("the file requires " + printable(name) + ", which is not supported");
  }
}

// What --time-at and --animation ask for; without a time the scene is at rest, and no animation is read.
Animation chosen_animation(const Value &root, Accessors &accessors, const ImportOptions &options) {
  const Context &context = root.context();
  const std::size_t count = root["animations"].size();
  if (!options.time) {
    if (count > 0) context.notices.note(context.file, "shown at rest, and has " + counted(count, "animations") + " for --time-at SECONDS");
    return {};
  }
  if (count == 0) {
    expect_no_animation(context.file, options, context.notices);
    return {};
  }
  const Animation animation(root, accessors, options.animation);
  if (*options.time < animation.first() || *options.time > animation.last()) {
    char text[120];
    std::snprintf(text, sizeof text, "its animation goes from %.4g to %.4g seconds, and keeps still before and after", animation.first(), animation.last());
    context.notices.note(context.file, text);
  }
  return animation;
}

}  // namespace

Scene import_gltf(const std::filesystem::path &path, const ImportOptions &options, Notices &notices) {
  const std::string file = printable(path.filename().string());
  const std::vector<std::byte> data = read_file(path);
  const std::string suffix = path.extension().string();
  const bool glb = suffix.size() == 4 && (suffix[1] | 0x20) == 'g' && (suffix[2] | 0x20) == 'l' && (suffix[3] | 0x20) == 'b';
  const Document document = parse_document(data, file, glb, notices);

  Context context{file, path.parent_path(), options, {}, notices};
  const Value root(context, &document.root, "");
  check_asset(root);
  check_required_extensions(root);
  root.check_extensions({"KHR_implicit_shapes", "KHR_lights_punctual"});

  Scene scene;
  scene.name = path.stem().string();
  const Value used = root["extensionsUsed"];
  for (std::size_t i = 0; i < used.size(); i++) scene.extensions.push_back(printable(used[i].text()));

  Buffers buffers(root, document.binary);
  Accessors accessors(root, buffers);
  Images images(root, buffers);
  Materials materials(root, images);
  Meshes meshes(root, accessors, materials);
  const Animation animation = chosen_animation(root, accessors, options);
  Nodes(root, accessors, materials, meshes).import(animation, options.time.value_or(0), options.shutter, scene);
  images.read(scene);

  if (scene.instances.empty() && scene.shapes.empty()) context.report.warning(file, "there is no triangle in it to render");
  context.report.flush(notices);
  return scene;
}

}  // namespace sunstone
