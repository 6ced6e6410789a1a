// SPDX-License-Identifier: Apache-2.0
// A file's suffix chooses its importer; the importer yields a valid Scene and notices, or throws one Error that names file and place.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "base/notice.h"
#include "scene/scene.h"

namespace sunstone {

struct ImportOptions {
  bool allow_outside = false;  // read resources outside the scene's own folder
  std::optional<double> time{};  // seconds, finite: the pose of `animation` then; without it the one that is stored
  double shutter = 0;            // seconds from then on that the shutter is open, not negative
  std::string animation{};       // its name or number; empty: the first
};

// .gltf .glb .obj. Every index, size and number of what comes back has been checked (scene/validate.h).
Scene import_scene(const std::filesystem::path &path, const ImportOptions &options, Notices &notices);

// The path of a resource that a scene names (already decoded from its URI): refuses absolute paths and paths that leave `folder`, also through
// links, unless allow_outside. Throws Error{place, ...}; opens nothing.
std::filesystem::path resolve_resource(const std::filesystem::path &folder, const std::string &name, const ImportOptions &options, const std::string &place);

// --env: a file (.hdr .exr or any picture), or "r,g,b". Throws Error, or UsageError where the text is neither.
Environment import_environment(const std::string &text, Notices &notices);

}  // namespace sunstone
