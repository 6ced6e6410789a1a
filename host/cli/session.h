// SPDX-License-Identifier: Apache-2.0
// A scene on a device, ready to render: what `render`, `verify` and `bench` begin with.
#pragma once
#include <memory>

#include "base/notice.h"
#include "cli/render_options.h"
#include "content/content.h"
#include "pipeline/renderer.h"

namespace sunstone {

struct LoadedScene {
  Scene scene;
  FlatScene flat;
  kernel::Camera camera;
  double import_seconds = 0, build_seconds = 0;
  std::string line;  // what it is, in one line
  std::shared_ptr<const Scene> at_rest;  // without its pictures, where the view is made up from it
};

// Imports and flattens by the flags of `render`: camera, environment, defaults. Throws Error where the estimate exceeds the device's memory, before
// anything is flattened; says the estimate first where it is large. `at_rest` is that of another time of the same scene.
LoadedScene load_scene(const RenderOptions &options, const RenderSettings &settings, Layout layout, const DeviceInfo &info, Notices &notices,
                       std::shared_ptr<const Scene> at_rest = {});

struct Session {
  Device device;
  Variant variant;
  LoadedScene loaded;
  std::unique_ptr<Programs> programs;
  std::unique_ptr<Renderer> renderer;
  double compile_seconds = 0, upload_seconds = 0;
};

// Opens the device and loads the scene at once, in two threads.
Session open_session(const RenderOptions &options, const RenderSettings &settings, Notices &notices);

// Then the kernels for it, and its renderer. `progress` is asked before each of them; the second half is their first launches.
void compile_session(Session &session, const RenderOptions &options, const RenderSettings &settings, const CompileProgress &progress = {});

// Another time of the session's scene: loaded and uploaded anew, for the same programs unless it asks for others.
void next_frame(Session &session, const RenderOptions &options, const RenderSettings &settings, Notices &notices);

}  // namespace sunstone
