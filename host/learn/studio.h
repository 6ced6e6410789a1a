// SPDX-License-Identifier: Apache-2.0
// Where figures are rendered: one device, the scenes and programs that were needed so far, and how far the work is.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "content/content.h"
#include "pipeline/renderer.h"

namespace sunstone {

// What is rendered, and how. `scene` is a bundled one, such as "cornell/cornell.gltf", or empty: the one of the command line.
struct Shot {
  std::string scene, environment;
  RenderSettings settings;
};

struct StudioScene {
  FlatScene flat;
  kernel::Camera camera;
  std::string line;                        // what it is, in one line
  std::vector<std::string> material_names; // by number in FlatScene::materials
};

// Loads a scene with the camera of a picture of this size. The command gives it, as it knows how a scene is opened.
using SceneLoader = std::function<StudioScene(const Shot &shot, Layout layout)>;

// Says how much of all is done; false where the user wants to end.
using StudioProgress = std::function<bool(double fraction, const std::string &text)>;

class Studio {
 public:
  Studio(Device device, Variant variant, SceneLoader load, StudioProgress progress);

  const StudioScene &scene(const Shot &shot);

  // Its kernels compiled and launched once, so that what follows may be timed. The studio has to outlive it.
  std::unique_ptr<Renderer> renderer(const Shot &shot, unsigned pool = 0);

  // From here on the work counts from `begin` to `end` of all.
  void span(double begin, double end);
  // The next piece is so large a part of the span; says what it is.
  void piece(double share, const std::string &text);
  // Renders, telling how far the piece is. Throws Error where the user has asked to end.
  void render(Renderer &renderer, SampleRange samples);
  // Renders whole samples from the first on until the time is over. Returns seconds that it took.
  double render_for(Renderer &renderer, std::uint64_t first, double seconds);

  bool columns() const { return variant_.columns; }  // how its pools lie (shared/path_fields.h)

 private:
  void tell(double of_piece);
  Device device_;
  Variant variant_;
  SceneLoader load_;
  StudioProgress progress_;
  std::map<std::string, StudioScene> scenes_;
  std::vector<std::unique_ptr<Programs>> programs_;
  double begin_ = 0, end_ = 1, done_ = 0, share_ = 0;
  std::string text_;
};

// The whole picture from the box filter, whose pixels are independent of each other, with every bounce kept.
RenderSettings figure_settings(int width, int height, const std::string &integrator, unsigned max_depth);

}  // namespace sunstone
