// SPDX-License-Identifier: Apache-2.0
// sunstone bench: what a device does in a second, stage by stage, ray by ray, and to a given error.
#include "bench/stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "bench/big_scene.h"
#include "bench/traversal.h"
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "math/elementary.h"

namespace sunstone {

namespace {

using Json = nlohmann::ordered_json;

struct Options {
  RenderOptions render;
  std::string json;
  unsigned repeats = 5, rays = 1024, reference_spp = 1024, spp = 64, frames = 60;
};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void finish(const Options &o, Json result, const DeviceInfo &device) {
  result["device"] = device.description();
  result["repeats"] = o.repeats;
  if (o.json.empty()) return;
  const std::string text = result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  write_file(o.json, std::as_bytes(std::span(text)));
  fmt::print("{}\n", printable(o.json, 400));
}

// The scene of the flags, or the made room of a million triangles.
LoadedScene bench_scene(const Options &o, const RenderSettings &settings, const DeviceInfo &device, Notices &notices) {
  if (!o.render.scene.empty()) return load_scene(o.render, settings, device_layout(device), device, notices);
  LoadedScene loaded;
  loaded.flat = make_big_scene();
  load_content().split_long_triangles(loaded.flat, {});
  loaded.camera = corner_camera(loaded.flat.bounds);
  loaded.line = fmt::format("made room: {} triangles", loaded.flat.triangles.size());
  return loaded;
}

void traversal(Options &o, Notices &notices) {
  if (!o.json.empty()) check_writable(o.json);
  const RenderSettings settings = render_settings(o.render);
  const DeviceInfo info = choose_device(list_devices(notices), o.render.device);
  const Device device(info, {o.render.threads, true, o.render.work_group});
  LoadedScene loaded = bench_scene(o, settings, info, notices);
  const Content &content = load_content();
  fmt::print("{}\n{}\n", info.description(), loaded.line);
  std::vector<Tree> trees;
  std::vector<Layout> layouts = {Layout::binary, Layout::wide8, Layout::wide16};
  if (!o.render.layout.empty()) layouts = {layout_from_name(o.render.layout)};
  Json builds = Json::array();
  for (const Layout layout : layouts) {
    const double begun = now();
    trees.push_back(content.build_tree(loaded.flat, layout, {}));
    const Tree &tree = trees.back();
    const double bytes = static_cast<double>(tree.nodes.size() + tree.leaves.size()) / static_cast<double>(loaded.flat.triangles.size());
    fmt::print("tree {:<7} {:.2f} s, {} nodes, {} leaves, depth {}, {:.1f} bytes a triangle\n", layout_name(layout), now() - begun, tree.node_count, tree.leaf_count, tree.depth, bytes);
    builds.push_back({{"layout", layout_name(layout)}, {"seconds", now() - begun}, {"nodes", tree.node_count}, {"leaves", tree.leaf_count}, {"bytes_per_triangle", bytes}});
  }
  // As many threads as the device has units: the same cores.
  const unsigned threads = o.render.threads ? o.render.threads : info.cpu ? info.compute_units : 0;
  std::vector<TraversalReference> references;
  for (const char *name : {"embree-high", "embree-robust", "embree-medium", "embree-16"}) references.push_back(content.embree(loaded.flat, name, threads));
  const std::vector<TraversalResult> results = run_traversal_bench(device, loaded.flat, loaded.camera, trees, references, {o.rays, o.repeats});
  Json rows = Json::array();
  fmt::print("\n{:<9} {:<8} {:>10} {:>8}  {:<14} {:>10} {:>7} {:>9} {:>6}\n", "rays", "layout", "Mrays/s", "best", "reference", "Mrays/s", "ratio", "hit/miss", "t");
  for (const TraversalResult &r : results) {
    fmt::print("{:<9} {:<8} {:>10.2f} {:>8.2f}  {:<14} {:>10.2f} {:>7.2f} {:>9} {:>6}\n", r.kind, r.layout, r.mrays_per_s, r.best_mrays_per_s, r.reference, r.reference_mrays_per_s,
               r.ratio, r.hit_mismatches, r.t_mismatches);
    rows.push_back({{"kind", r.kind}, {"layout", r.layout}, {"reference", r.reference}, {"rays", r.rays}, {"mrays_per_s", r.mrays_per_s}, {"best_mrays_per_s", r.best_mrays_per_s},
                    {"embree_mrays_per_s", r.reference_mrays_per_s}, {"ratio", r.ratio}, {"hit_mismatches", r.hit_mismatches}, {"t_mismatches", r.t_mismatches}});
  }
  finish(o, {{"results", rows}, {"builds", builds}, {"triangles", loaded.flat.triangles.size()}}, info);
}

Session bench_session(Options &o, const RenderSettings &settings, Notices &notices) {
  Session session;
  if (!o.render.scene.empty()) {
    session = open_session(o.render, settings, notices);
    compile_session(session, o.render, settings);
    return session;
  }
  const DeviceInfo info = choose_device(list_devices(notices), o.render.device);
  session.device = Device(info, {o.render.threads, true, o.render.work_group});
  session.variant = device_variant(info);
  if (o.render.lanes) session.variant.lanes = o.render.lanes;
  if (!o.render.layout.empty()) session.variant.layout = layout_from_name(o.render.layout);
  session.loaded = bench_scene(o, settings, info, notices);
  session.loaded.flat.tree = load_content().build_tree(session.loaded.flat, session.variant.layout, {});
  session.variant = scene_variant(session.variant, session.loaded.flat, settings);
  compile_session(session, o.render, settings);
  return session;
}

void stages(Options &o, Notices &notices) {
  if (!o.json.empty()) check_writable(o.json);
  RenderSettings settings = render_settings(o.render);
  Session session = bench_session(o, settings, notices);
  fmt::print("{}\n{}\nlanes {}, layout {}, pool {}\n", session.device.info().description(), session.loaded.line, session.variant.lanes, layout_name(session.variant.layout),
             session.renderer->pool_slots());
  const std::vector<StageResult> results = run_stage_bench(session.device, *session.renderer, o.repeats);
  fmt::print("\n{:<15} {:>9} {:>11} {:>11} {:>10} {:>8} {:>7}\n", "stage", "items", "ms", "best ms", "Mitems/s", "GB/s", "share");
  Json rows = Json::array();
  for (const StageResult &r : results) {
    fmt::print("{:<15} {:>9} {:>11.3f} {:>11.3f} {:>10.2f} {:>8.2f} {:>6.1f}%\n", r.stage, r.items, r.seconds * 1e3, r.best_seconds * 1e3, r.mitems_per_s, r.gb_per_s, r.share * 100);
    rows.push_back({{"stage", r.stage}, {"items", r.items}, {"seconds", r.seconds}, {"best_seconds", r.best_seconds}, {"mitems_per_s", r.mitems_per_s}, {"bytes", r.bytes},
                    {"gb_per_s", r.gb_per_s}, {"share", r.share}});
  }
  finish(o, {{"stages", rows}, {"lanes", session.variant.lanes}, {"layout", layout_name(session.variant.layout)}, {"pool", session.renderer->pool_slots()}}, session.device.info());
}

Image image_of(const Film &film) { return {"film", film.width(), film.height(), 3, film_beauty(film)}; }

void scene(Options &o, Notices &notices) {
  if (!o.json.empty()) check_writable(o.json);
  if (o.render.scene.empty()) throw UsageError("sunstone bench scene", "takes a scene");
  const RenderSettings settings = render_settings(o.render);
  Session session = open_session(o.render, settings, notices);
  compile_session(session, o.render, settings);
  fmt::print("{}\n{}\n", session.device.info().description(), session.loaded.line);
  const auto renderer = [&] {
    return std::make_unique<Renderer>(session.device, *session.programs, session.loaded.flat, session.loaded.camera, settings, Tuning{o.render.pool, session.variant.lanes});
  };
  // Throughput: best and median of whole renders, after one that warms up.
  session.renderer->render({0, 1}, {});
  std::vector<double> rates;
  double rays = 0;
  for (unsigned i = 0; i < o.repeats; i++) {
    const auto run = renderer();
    const double begun = now();
    run->render({0, o.spp}, {});
    const double seconds = now() - begun;
    const RenderCounts &counts = run->counts();
    rates.push_back(static_cast<double>(counts.paths) / seconds);
    rays = static_cast<double>(counts.camera_rays + counts.bounce_rays + counts.shadow_rays) / static_cast<double>(counts.paths);
  }
  std::ranges::sort(rates);
  const double median = rates[rates.size() / 2];
  fmt::print("{:.3f} Msamples/s (best {:.3f}), {:.2f} rays a sample, {:.2f} Mrays/s\n", median * 1e-6, rates.back() * 1e-6, rays, median * rays * 1e-6);

  // Error over time, against a render of other samples of the same picture.
  const auto reference = renderer();
  reference->render({1u << 20, (1u << 20) + o.reference_spp}, {});
  const Image truth = image_of(reference->film());
  const auto run = renderer();
  Json series = Json::array();
  double seconds = 0;
  fmt::print("\n{:>8} {:>10} {:>12}\n", "samples", "seconds", "relMSE");
  for (std::uint64_t done = 0, next = 1; next <= o.spp; done = next, next *= 2) {
    const double begun = now();
    run->render({done, next}, {});
    seconds += now() - begun;
    const double relmse = load_content().compare_images(image_of(run->film()), truth).relmse;
    fmt::print("{:>8} {:>10.3f} {:>12.4e}\n", next, seconds, relmse);
    series.push_back({{"samples", next}, {"seconds", seconds}, {"relmse", relmse}});
  }
  finish(o, {{"scene", o.render.scene}, {"samples_per_s", median}, {"best_samples_per_s", rates.back()}, {"rays_per_s", median * rays}, {"relmse", series}}, session.device.info());
}

// The scene's own camera, turned about the vertical through the scene's centre: once around in so many frames.
std::vector<kernel::Camera> fly_around(const LoadedScene &loaded, unsigned frames) {
  const float x = 0.5f * (loaded.flat.bounds.lower.x + loaded.flat.bounds.upper.x), z = 0.5f * (loaded.flat.bounds.lower.z + loaded.flat.bounds.upper.z);
  std::vector<kernel::Camera> cameras;
  for (unsigned i = 0; i < frames; i++) {
    float sine, cosine;
    kernel::sin_cos(2 * SUN_PI * static_cast<float>(i) / static_cast<float>(frames), &sine, &cosine);
    kernel::Camera camera = loaded.camera;
    const auto turn = [&](float *v, float about_x, float about_z) {
      const float a = v[0] - about_x, b = v[2] - about_z;
      v[0] = about_x + (cosine * a + sine * b);
      v[2] = about_z + (cosine * b - sine * a);
    };
    turn(camera.position, x, z);
    for (float *v : {camera.right, camera.up, camera.forward}) turn(v, 0, 0);
    cameras.push_back(camera);
  }
  return cameras;
}

void whitted(Options &o, Notices &notices) {
  if (!o.json.empty()) check_writable(o.json);
  RenderOptions &r = o.render;
  r.integrator = "whitted";
  if (r.scene.empty()) r.scene = "scenes/whitted/whitted.gltf";
  if (r.environment.empty()) r.environment = "0.35,0.55,0.9";
  if (r.ambient.empty()) r.ambient = "0.15,0.15,0.15";
  const RenderSettings settings = render_settings(r);
  Session session = open_session(r, settings, notices);
  compile_session(session, r, settings);
  fmt::print("{}\n{}\n{}x{}, lanes {}, layout {}\n", session.device.info().description(), session.loaded.line, settings.width, settings.height, session.variant.lanes,
             layout_name(session.variant.layout));
  const std::vector<kernel::Camera> cameras = fly_around(session.loaded, o.frames);
  Display display = session.renderer->display();
  const auto fly = [&] {
    for (const kernel::Camera &camera : cameras) display.show(camera, 1);
    display.finish();
  };
  fly();
  std::vector<double> rates;
  double least_cpu = INFINITY;  // seconds of all the process's threads, a frame: what a machine that is busy with other work still tells
  for (unsigned i = 0; i < o.repeats; i++) {
    const double begun = now();
    const std::clock_t cpu_begun = std::clock();
    fly();
    rates.push_back(static_cast<double>(cameras.size()) / (now() - begun));
    least_cpu = std::min(least_cpu, static_cast<double>(std::clock() - cpu_begun) / CLOCKS_PER_SEC / static_cast<double>(cameras.size()));
  }
  Hasher hasher;
  for (const kernel::Camera &camera : cameras) {
    display.show(camera, 1);
    hasher.span(std::span<const kernel::uint>(display.shown()));
  }
  std::ranges::sort(rates);
  const double median = rates[rates.size() / 2];
  const std::string hash = hasher.digest().hex();
  fmt::print("\n{} frames around the scene, {} times: {:.1f} frames/s (best {:.1f}), {:.2f} ms of CPU a frame at the least; pixels {}\n", cameras.size(), o.repeats, median, rates.back(),
             least_cpu * 1e3, hash);
  finish(o, {{"scene", r.scene}, {"size", {settings.width, settings.height}}, {"frames", cameras.size()}, {"frames_per_s", median}, {"best_frames_per_s", rates.back()},
             {"cpu_seconds_a_frame", least_cpu}, {"pixels_hash", hash}, {"lanes", session.variant.lanes}, {"layout", layout_name(session.variant.layout)}},
         session.device.info());
}

}  // namespace

void add_bench(CLI::App &app, CommandContext &context) {
  CLI::App *bench = app.add_subcommand("bench", "Measure a device: rays, stages, scenes");
  bench->require_subcommand(1);
  bench->footer("Measure on an idle machine, and read ratios of one run rather than figures of several.");
  const auto add = [&](const char *name, const char *what, void (*work)(Options &, Notices &), const char *example) {
    auto options = std::make_shared<Options>();
    CLI::App *command = bench->add_subcommand(name, what);
    add_render_options(*command, options->render);
    command->get_option("scene")->required(false);
    for (const char *of_files : {"--output", "--frames", "--fps"}) command->remove_option(command->get_option(of_files));
    command->add_option("--json", options->json, "Write the same as JSON")->type_name("FILE");
    command->add_option("--repeats", options->repeats, "Timed runs, after one that is not [5]")->check(CLI::Range(1, 1000))->type_name("N");
    if (std::string_view(name) == "traversal") command->add_option("--rays", options->rays, "Primary rays a side [1024]")->check(CLI::Range(16, 8192))->type_name("N");
    if (std::string_view(name) == "whitted") {
      options->render.size = "1024x1024";
      options->render.max_depth = 6;
      command->add_option("--frames", options->frames, "Frames of the flight [60]")->check(CLI::Range(1, 100000))->type_name("N");
    }
    if (std::string_view(name) == "scene")
      command->add_option("--reference-spp", options->reference_spp, "Samples of the picture that errors are measured against [1024]")->check(CLI::Range(1u, 1u << 20))->type_name("N");
    command->footer(example);
    command->callback([options, work, &context] {
      options->spp = static_cast<unsigned>(options->render.spp.value_or(64));
      work(*options, context.notices);
    });
  };
  add("traversal", "Primary, bounce and shadow rays beside Embree on the same rays and threads; without a scene, in a room of a million triangles", traversal,
      "Examples:\n  sunstone bench traversal\n  sunstone bench traversal scenes/environment/environment.glb --layout wide16 --json traversal.json");
  add("stages", "Each stage of the wavefront alone, on queues of a render in full swing", stages, "Example:\n  sunstone bench stages scenes/cornell/cornell.gltf --size 512x512 --max-depth 8");
  add("whitted", "A flight around Whitted's scene by --integrator whitted, 1024x1024, a new camera each frame, in bytes as a display takes them; without a scene, "
      "scenes/whitted/whitted.gltf", whitted, "Example:\n  sunstone bench whitted --json whitted.json");
  add("scene", "Samples a second, and error over time", scene, "Example:\n  sunstone bench scene scenes/cornell/cornell.gltf --size 512x512 --max-depth 8 --spp 64");
}

}  // namespace sunstone
