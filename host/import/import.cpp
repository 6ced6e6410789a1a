// SPDX-License-Identifier: Apache-2.0
#include "import/import.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "base/error.h"
#include "image/radiance.h"
#include "import/importers.h"
#include "scene/validate.h"

namespace sunstone {

namespace {

std::string lower_suffix(const std::filesystem::path &path) {
  std::string suffix = path.extension().string();
  for (char &c : suffix)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return suffix;
}

// Three numbers with commas between them, or nothing. std::from_chars, so that no locale has a say.
std::optional<glm::vec3> parse_triple(const std::string &text) {
  glm::vec3 value;
  const char *at = text.data(), *const end = text.data() + text.size();
  for (int i = 0; i < 3; i++) {
    while (at < end && *at == ' ') at++;
    const auto result = std::from_chars(at, end, value[i]);
    if (result.ec != std::errc() && result.ec != std::errc::result_out_of_range) return std::nullopt;
    if (result.ec == std::errc::result_out_of_range) value[i] = INFINITY;
    at = result.ptr;
    while (at < end && *at == ' ') at++;
    if (i < 2 && (at == end || *at++ != ',')) return std::nullopt;
  }
  return at == end ? std::optional(value) : std::nullopt;
}

}  // namespace

Scene import_scene(const std::filesystem::path &path, const ImportOptions &options, Notices &notices) {
  const std::string shown = printable(path.string(), 400), suffix = lower_suffix(path);
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (path.empty() || !std::filesystem::exists(status)) throw Error(shown, "no such file");
  if (std::filesystem::is_directory(status)) throw Error(shown, "is a folder, not a scene");
  const bool gltf = suffix == ".gltf" || suffix == ".glb";
  if (!gltf && suffix != ".obj")
    throw Error(shown,
                suffix.empty() ? "has no suffix that names its format" : "\"" + printable(suffix) + "\" is not a format of scenes that is read",
                "scenes are .gltf, .glb or .obj");
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(path, error) == 0 && !error) throw Error(shown, "is empty");
  if (!gltf) expect_no_animation(shown, options, notices);
  Scene scene = gltf ? import_gltf(path, options, notices) : import_obj(path, options, notices);
  if (scene.name.empty()) scene.name = path.stem().string();
  validate(scene, shown, notices);
  return scene;
}

void expect_no_animation(const std::string &file, const ImportOptions &options, Notices &notices) {
  if (!options.animation.empty()) throw UsageError("--animation " + printable(options.animation), file + " has no animation");
  if (options.time) notices.note(file, "has no animation: it is the same at every time");
}

std::filesystem::path resolve_resource(const std::filesystem::path &folder, const std::string &name, const ImportOptions &options,
                                       const std::string &place) {
  const std::string shown = "\"" + printable(name) + "\"";
  const char *const hint = "--allow-outside reads it all the same";
  if (name.empty()) throw Error(place, "names no file");
  if (name.find('\0') != std::string::npos) throw Error(place, shown + " is not a file's name");
  const std::filesystem::path base = folder.empty() ? std::filesystem::path(".") : folder, relative(name);
  if (options.allow_outside) return relative.is_absolute() ? relative : base / relative;
  if (relative.is_absolute()) throw Error(place, shown + " is an absolute path and is not read", hint);
  // Where links lead is looked up in the file system, by names alone; what does not exist is resolved as text.
  std::error_code error;
  const std::filesystem::path root = std::filesystem::weakly_canonical(std::filesystem::absolute(base), error);
  if (error) throw Error(place, shown + " cannot be resolved: " + error.message());
  const std::filesystem::path target = std::filesystem::weakly_canonical(root / relative, error);
  if (error) throw Error(place, shown + " cannot be resolved: " + error.message());
  const auto [in_root, in_target] = std::mismatch(root.begin(), root.end(), target.begin(), target.end());
  if (in_root != root.end()) throw Error(place, shown + " lies outside the scene's folder and is not read", hint);
  if (in_target == target.end()) throw Error(place, shown + " names the scene's folder, not a file");
  return target;
}

Environment import_environment(const std::string &text, Notices &notices) {
  Environment environment;
  if (const std::optional<glm::vec3> constant = parse_triple(text)) {
    for (int i = 0; i < 3; i++)
      if (!std::isfinite((*constant)[i]) || (*constant)[i] < 0)
        throw UsageError("--env", "\"" + printable(text) + "\": a radiance has to be finite and not negative");
    environment.kind = Environment::Kind::constant;
    environment.constant = *constant;
    return environment;
  }
  std::error_code error;
  if (text.empty() || !std::filesystem::exists(text, error)) {
    if (text.find(',') != std::string::npos)
      throw UsageError("--env", "\"" + printable(text) + "\" is neither a file nor three numbers", "for example --env 1,1,1");
    throw Error(printable(text, 400), "no such file", "--env takes a picture, or three numbers: 1,1,1");
  }
  environment.kind = Environment::Kind::map;
  RadianceFaults faults;
  environment.map = std::make_shared<const Image>(radiance_map(read_image(text), faults));
  if (faults.nan || faults.infinite || faults.negative)
    notices.warning(environment.map->name, "values treated as 0: " + std::to_string(faults.nan) + " NaN, " + std::to_string(faults.infinite) +
                                               " infinite, " + std::to_string(faults.negative) + " negative");
  return environment;
}

}  // namespace sunstone
