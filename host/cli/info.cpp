// SPDX-License-Identifier: Apache-2.0
// sunstone info: what is in a scene, without rendering it.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "cli/commands.h"
#include "content/content.h"
#include "pipeline/stages.h"

namespace sunstone {

namespace {

struct Options {
  std::string scene;
  ImportOptions import;
  bool json = false;
};

std::string mebibytes(std::size_t bytes) { return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / 1048576.0); }

void tell(const Options &o, Notices &notices) {
  check_pose_options(o.import);
  const Content &content = load_content();
  const Scene scene = content.import_scene(o.scene, o.import, notices);
  std::size_t unique = 0, flattened = 0;
  std::vector<std::size_t> of_mesh;
  for (const Mesh &mesh : scene.meshes) {
    std::size_t triangles = 0;
    for (const Primitive &primitive : mesh.primitives) triangles += primitive.indices.size() / 3;
    of_mesh.push_back(triangles);
    unique += triangles;
  }
  for (const Instance &instance : scene.instances) flattened += of_mesh[static_cast<std::size_t>(instance.mesh)];
  const Bounds bounds = content.scene_bounds(scene);
  const MemoryEstimate memory = content.estimate_memory(scene, Layout::wide16);
  std::size_t emissive = 0;
  for (const Material &material : scene.materials) emissive += material.emission.x + material.emission.y + material.emission.z > 0;
  const auto shapes = [&](Shape::Kind kind) { return std::ranges::count(scene.shapes, kind, &Shape::kind); };
  // While the shutter is open.
  const auto moving = [](const auto &things) { return std::ranges::count_if(things, [](const auto &thing) { return !thing.keys.empty(); }); };
  const auto moving_instances = moving(scene.instances), moving_shapes = moving(scene.shapes), moving_lights = moving(scene.lights), moving_cameras = moving(scene.cameras);
  const auto deforming = std::ranges::count_if(scene.meshes, &Mesh::deforms);
  if (o.json) {
    nlohmann::ordered_json j = {{"scene", o.scene},
                                {"triangles", unique},
                                {"triangles_flattened", flattened},
                                {"meshes", scene.meshes.size()},
                                {"instances", scene.instances.size()},
                                {"shapes", {{"sphere", shapes(Shape::Kind::sphere)}, {"disk", shapes(Shape::Kind::disk)}, {"quad", shapes(Shape::Kind::quad)}, {"plane", shapes(Shape::Kind::plane)}}},
                                {"materials", scene.materials.size()},
                                {"emissive_materials", emissive},
                                {"textures", scene.textures.size()},
                                {"images", scene.images.size()},
                                {"lights", scene.lights.size()},
                                {"extensions", scene.extensions},
                                {"memory", {{"geometry", memory.geometry}, {"tree", memory.tree}, {"textures", memory.textures}, {"other", memory.other}, {"total", memory.total()}}}};
    if (scene.motion_steps)
      j["motion"] = {{"steps", scene.motion_steps}, {"instances", moving_instances}, {"meshes", deforming}, {"shapes", moving_shapes}, {"lights", moving_lights}, {"cameras", moving_cameras}};
    for (const Camera &camera : scene.cameras) j["cameras"].push_back(camera.name);
    if (!bounds.empty()) j["bounds"] = {{bounds.lower.x, bounds.lower.y, bounds.lower.z}, {bounds.upper.x, bounds.upper.y, bounds.upper.z}};
    for (const Notice &notice : notices.all()) j["notices"].push_back({{"kind", notice.kind == Notice::Kind::warning ? "warning" : "note"}, {"place", notice.place}, {"text", notice.text}});
    fmt::print("{}\n", j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  fmt::print("{}\n", printable(o.scene, 400));
  fmt::print("  triangles   {} ({} once instances are unfolded)\n", unique, flattened);
  fmt::print("  meshes      {}, instances {}\n", scene.meshes.size(), scene.instances.size());
  if (!scene.shapes.empty())
    fmt::print("  shapes      {} spheres, {} disks, {} quads, {} infinite planes\n", shapes(Shape::Kind::sphere), shapes(Shape::Kind::disk), shapes(Shape::Kind::quad),
               shapes(Shape::Kind::plane));
  fmt::print("  materials   {} ({} emissive), textures {}, images {}\n", scene.materials.size(), emissive, scene.textures.size(), scene.images.size());
  fmt::print("  lights      {}, cameras {}\n", scene.lights.size(), scene.cameras.size());
  for (std::size_t i = 0; i < scene.cameras.size(); i++)
    fmt::print("    camera {}  {} ({})\n", i, printable(scene.cameras[i].name), scene.cameras[i].orthographic ? "orthographic" : "perspective");
  if (scene.motion_steps)
    fmt::print("  motion      {} steps: {} instances and {} shapes move, {} meshes deform, {} lights and {} cameras move\n", scene.motion_steps, moving_instances, moving_shapes, deforming,
               moving_lights, moving_cameras);
  if (!bounds.empty())
    fmt::print("  bounds      ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) metres\n", bounds.lower.x, bounds.lower.y, bounds.lower.z, bounds.upper.x, bounds.upper.y, bounds.upper.z);
  std::string extensions;
  for (const std::string &name : scene.extensions) extensions += (extensions.empty() ? "" : ", ") + printable(name);
  if (!extensions.empty()) fmt::print("  extensions  {}\n", extensions);
  fmt::print("  memory      {} on a device: geometry {}, tree {}, textures {}, other {}\n", mebibytes(memory.total()), mebibytes(memory.geometry), mebibytes(memory.tree),
             mebibytes(memory.textures), mebibytes(memory.other));
}

}  // namespace

void add_info(CLI::App &app, CommandContext &context) {
  auto options = std::make_shared<Options>();
  CLI::App *command = app.add_subcommand("info", "Tell what is in a scene: counts, bounds, memory, extensions, warnings");
  command->add_option("scene", options->scene, "The scene: .gltf, .glb or .obj")->required()->type_name("SCENE");
  add_pose_options(*command, options->import);
  command->add_flag("--json", options->json, "Print JSON");
  command->add_flag("--allow-outside", options->import.allow_outside, "Let the scene name files outside its own folder");
  command->footer("Example:\n  sunstone info scenes/cornell/cornell.gltf");
  command->callback([options, &context] { tell(*options, context.notices); });
}

}  // namespace sunstone
