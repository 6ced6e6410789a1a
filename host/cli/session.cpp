// SPDX-License-Identifier: Apache-2.0
#include "cli/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <future>

#include "base/error.h"
#include "base/number.h"
#include "math/elementary.h"

namespace sunstone {

namespace {

Camera choose_camera(const Content &content, const RenderOptions &o, const Scene &scene, const Scene &at_rest, float aspect) {
  if (o.look_from.empty() != o.look_at.empty()) throw UsageError(o.look_from.empty() ? "--look-at" : "--look-from", "--look-from and --look-at go together");
  const float to_radians = SUN_PI / 180.0f;
  Camera camera;
  if (!o.look_from.empty()) {
    if (!o.camera.empty()) throw UsageError("--camera", "cannot be given beside --look-from");
    const std::vector<float> from = parse_numbers("--look-from", o.look_from, 3), at = parse_numbers("--look-at", o.look_at, 3);
    const glm::vec3 up = o.up == "z" ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
    camera = content.look_camera({from[0], from[1], from[2]}, {at[0], at[1], at[2]}, up, static_cast<float>(o.fov.value_or(40.0)) * to_radians);
  } else if (!o.camera.empty()) {
    const Camera *found = nullptr;
    std::string known;
    const std::optional<std::size_t> number = read_number<std::size_t>(o.camera);
    for (std::size_t i = 0; i < scene.cameras.size(); i++) {
      known += fmt::format("{}{} \"{}\"", i ? ", " : "", i, printable(scene.cameras[i].name));
      if (scene.cameras[i].name == o.camera || number == i) found = found ? found : &scene.cameras[i];
    }
    if (!found) throw UsageError("--camera " + printable(o.camera), scene.cameras.empty() ? "the file has no camera" : "no such camera; there are " + known);
    camera = *found;
  } else {
    camera = scene.cameras.empty() ? content.default_camera(scene, aspect) : scene.cameras[0];
  }
  if (o.fov) camera.yfov = static_cast<float>(*o.fov) * to_radians;
  if (o.aperture) camera.lens_radius = static_cast<float>(*o.aperture);
  if (o.focus) {
    camera.focus_distance = static_cast<float>(*o.focus);
  } else if (camera.lens_radius > 0) {
    // On the centre of the scene, along the axis.
    const Bounds bounds = content.scene_bounds(at_rest);
    const glm::vec3 forward = -camera.transform[2], to = bounds.empty() ? forward : (bounds.lower + bounds.upper) * 0.5f - camera.transform[3];
    const float along = to.x * forward.x + to.y * forward.y + to.z * forward.z;
    camera.focus_distance = along > 1e-4f ? along : 1.0f;
  }
  return camera;
}

// What moves is seen from where the scene at rest is, and sharp where that is: otherwise a made-up view would move with it. Null where nothing is made up.
std::shared_ptr<const Scene> scene_at_rest(const Content &content, const RenderOptions &o, const Scene &scene) {
  const bool view = scene.cameras.empty() && o.look_from.empty() && o.camera.empty(), focus = o.aperture && !o.focus;
  if (!o.import.time || (!view && !focus)) return nullptr;
  Notices said;  // all of it is said of the scene itself
  ImportOptions at_rest = o.import;
  at_rest.time.reset();
  at_rest.shutter = 0;
  Scene still = content.import_scene(o.scene, at_rest, said);
  still.images.clear();
  return std::make_shared<const Scene>(std::move(still));
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

LoadedScene load_scene(const RenderOptions &o, const RenderSettings &settings, Layout layout, const DeviceInfo &info, Notices &notices,
                       std::shared_ptr<const Scene> at_rest) {
  LoadedScene loaded;
  const Content &content = load_content();
  const double begun = now();
  loaded.scene = content.import_scene(o.scene, o.import, notices);
  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  if (!o.environment.empty()) loaded.scene.environment = content.import_environment(o.environment, notices);
  loaded.scene.environment.rotation = static_cast<float>(o.environment_rotation / 360.0);
  loaded.scene.environment.strength = static_cast<float>(o.environment_strength);
  loaded.at_rest = at_rest ? std::move(at_rest) : scene_at_rest(content, o, loaded.scene);
  if (loaded.at_rest && loaded.scene.cameras.empty() && o.look_from.empty()) {
    Scene defaults = *loaded.at_rest;
    defaults.environment = loaded.scene.environment;
    content.add_defaults(defaults, aspect, o.scene, o.camera.empty(), notices);
    loaded.scene.environment = defaults.environment;
    loaded.scene.cameras = defaults.cameras;
  }
  content.add_defaults(loaded.scene, aspect, o.scene, o.look_from.empty() && o.camera.empty(), notices);
  const Plan &plan = integrator(settings.integrator);
  for (const Light &light : loaded.scene.lights) {
    const char *kind = light.kind == Light::Kind::point ? "point" : light.kind == Light::Kind::spot ? "spot" : "directional";
    if (std::ranges::find(plan.refuses, kind) != plan.refuses.end())
      throw Error(o.scene, fmt::format("has a {} light, which no path of --integrator {} can meet: its radiance comes from areas and environments alone", kind, plan.name),
                  "--integrator path and --integrator hybrid render it");
  }
  if (settings.nee_first && !loaded.scene.lights.empty())
    throw Error(o.scene, "has point, spot or directional lights, which no path meets by chance: with --nee first all that they light indirectly would be missing", "--nee every renders it");
  const Camera camera = choose_camera(content, o, loaded.scene, loaded.at_rest ? *loaded.at_rest : loaded.scene, aspect);
  loaded.import_seconds = now() - begun;
  const std::size_t estimate = content.estimate_memory(loaded.scene, layout).total();
  const double mebibytes = static_cast<double>(estimate) / 1048576.0;
  if (estimate > info.memory)
    throw Error(o.scene, fmt::format("needs about {:.0f} MiB on the device, which has {:.0f} MiB", mebibytes, static_cast<double>(info.memory) / 1048576.0),
                "choose another --device, or a smaller scene");
  if (mebibytes >= 256) notices.note(o.scene, fmt::format("needs about {:.0f} MiB on the device", mebibytes));
  FlattenOptions flatten;
  flatten.layout = layout;
  flatten.max_page_bytes = info.max_allocation;
  loaded.flat = content.flatten(loaded.scene, flatten, notices);
  loaded.camera = content.flatten_camera(camera, settings.width, settings.height);
  loaded.flat.camera_keys = flatten_camera_keys(camera, settings.width, settings.height, content.flatten_camera);
  loaded.build_seconds = now() - begun - loaded.import_seconds;
  const FlatScene &flat = loaded.flat;
  const std::size_t meshes = flat.instances.size() - flat.shape_count;
  loaded.line = fmt::format("{}: {} triangles, {} instance{}{}, {} material{}, {} texture{}, {} emitter{}", printable(o.scene), flat.triangles.size() - flat.shape_count, meshes,
                            meshes == 1 ? "" : "s", flat.shape_count ? fmt::format(", {} shape{}", flat.shape_count, flat.shape_count == 1 ? "" : "s") : "", flat.materials.size(), flat.materials.size() == 1 ? "" : "s", flat.textures.size(),
                            flat.textures.size() == 1 ? "" : "s", flat.emitters.size(), flat.emitters.size() == 1 ? "" : "s");
  if (flat.motion_steps) loaded.line += fmt::format(", moving in {} step{}", flat.motion_steps, flat.motion_steps == 1 ? "" : "s");
  return loaded;
}

Session open_session(const RenderOptions &o, const RenderSettings &settings, Notices &notices) {
  Session session;
  // The platforms come up first: the content object brings another TBB.
  const DeviceInfo info = choose_device(list_devices(notices), o.device);
  session.variant = device_variant(info);
  if (o.lanes) session.variant.lanes = o.lanes;
  if (!o.layout.empty()) session.variant.layout = layout_from_name(o.layout);
  std::future<LoadedScene> loading =
      std::async(std::launch::async, [&] { return load_scene(o, settings, session.variant.layout, info, notices); });
  session.device = Device(info, {o.threads, true, o.work_group});
  session.loaded = loading.get();
  session.variant = scene_variant(session.variant, session.loaded.flat, settings);
  return session;
}

static void make_renderer(Session &session, const RenderOptions &o, const RenderSettings &settings) {
  const double begun = now();
  session.renderer = std::make_unique<Renderer>(session.device, *session.programs, session.loaded.flat, session.loaded.camera, settings, Tuning{o.pool, session.variant.lanes});
  session.device.finish();
  session.upload_seconds = now() - begun;
}

void compile_session(Session &session, const RenderOptions &o, const RenderSettings &settings, const CompileProgress &progress) {
  const auto half = [&](double first) -> CompileProgress {
    return [&progress, first](double fraction, const std::string &what) {
      if (progress) progress(first + 0.5 * fraction, what);
    };
  };
  double begun = now();
  session.programs = std::make_unique<Programs>(session.device, session.variant, half(0));
  session.compile_seconds = now() - begun;
  make_renderer(session, o, settings);
  begun = now();
  session.renderer->warm_up(half(0.5));
  session.compile_seconds += now() - begun;
}

void next_frame(Session &session, const RenderOptions &o, const RenderSettings &settings, Notices &notices) {
  session.renderer.reset();  // before the next scene takes its memory
  session.loaded = load_scene(o, settings, session.variant.layout, session.device.info(), notices, session.loaded.at_rest);
  session.compile_seconds = 0;
  const Variant variant = scene_variant(session.variant, session.loaded.flat, settings);
  if (variant != session.variant) {
    const double begun = now();
    session.variant = variant;
    session.programs = std::make_unique<Programs>(session.device, variant);
    session.compile_seconds = now() - begun;
  }
  make_renderer(session, o, settings);
}

}  // namespace sunstone
