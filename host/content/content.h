// SPDX-License-Identifier: Apache-2.0
// What libsunstone_content.so does for the binary, as a table of functions: it holds OpenImageIO, which takes a third of a second to load, and Debian's
// TBB, which must not come before Intel's. So it is opened only where it is needed, once the OpenCL platforms are up (docs/decisions/0003-content-object.md).
#pragma once
#include <cstddef>
#include <filesystem>

#include "bench/traversal.h"
#include "film/film.h"
#include "flatten/bvh.h"
#include "flatten/camera.h"
#include "flatten/flatten.h"
#include "flatten/fragments.h"
#include "image/image.h"
#include "import/import.h"
#include "output/output.h"
#include "scene/default_view.h"
#include "scene/validate.h"

namespace sunstone {

struct Content {
  // output/output.h. (check_picture_name is in the binary itself: library picture_names.)
  void (*write_picture)(const std::filesystem::path &path, const Film &film, const ViewOptions &view) = nullptr;
  Comparison (*compare_images)(const Image &image, const Image &reference) = nullptr;
  Image (*read_picture)(const std::filesystem::path &path) = nullptr;
  // import/import.h and scene/.
  Scene (*import_scene)(const std::filesystem::path &path, const ImportOptions &options, Notices &notices) = nullptr;
  Environment (*import_environment)(const std::string &text, Notices &notices) = nullptr;
  Bounds (*scene_bounds)(const Scene &scene) = nullptr;
  Camera (*default_camera)(const Scene &scene, float aspect) = nullptr;
  Camera (*look_camera)(glm::vec3 from, glm::vec3 at, glm::vec3 up, float yfov) = nullptr;
  void (*add_defaults)(Scene &scene, float aspect, const std::string &file, bool camera_wanted, Notices &notices) = nullptr;
  // flatten/.
  MemoryEstimate (*estimate_memory)(const Scene &scene, Layout layout) = nullptr;
  FlatScene (*flatten)(const Scene &scene, const FlattenOptions &options, Notices &notices) = nullptr;
  void (*split_long_triangles)(FlatScene &scene, const SplitOptions &options) = nullptr;
  Tree (*build_tree)(const FlatScene &scene, Layout layout, const std::function<void(const char *what, double fraction)> &progress) = nullptr;
  kernel::Camera (*flatten_camera)(const Camera &camera, int width, int height) = nullptr;
  // bench/embree_reference.h: embree-high, embree-robust, embree-medium or embree-16, over this geometry.
  TraversalReference (*embree)(const FlatScene &scene, const std::string &name, unsigned threads) = nullptr;
};

// The only symbol of the library: the table, or null where the caller's is of another size, so that a library and a binary of two builds do not meet.
constexpr const char *content_symbol = "sunstone_content";
using ContentFunction = const Content *(*)(std::size_t table_size);

// Opens the library at the first call, from any thread, and throws Error where it is missing or of another build.
const Content &load_content();

}  // namespace sunstone
