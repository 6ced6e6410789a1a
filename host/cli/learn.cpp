// SPDX-License-Identifier: Apache-2.0
// sunstone learn: the figures of the course, rendered and measured here.
#include "learn/figure.h"

#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "base/file.h"
#include "base/share.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/session.h"
#include "pipeline/plan.h"

namespace sunstone {

namespace {

struct Options {
  RenderOptions render;
  std::string folder = "learn", pixel;
  bool quick = false;
  std::uint64_t sample = 0;
  unsigned samples = 8;
};

void make_folder(const std::string &folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) throw Error(printable(folder, 400), "cannot be made a folder" + (error ? ": " + error.message() : ""), "name another with -o FOLDER");
  check_writable(std::filesystem::path(folder) / "index.html");
}

// A figure's scene comes with the program, another from the command line.
RenderOptions scene_options(const Options &o, const Shot &shot) {
  if (shot.scene.empty()) return o.render;
  RenderOptions bundled;
  bundled.scene = shared_file("scenes/" + shot.scene).string();
  if (!shot.environment.empty()) bundled.environment = shared_file("scenes/" + shot.environment).string();
  return bundled;
}

Easel::Asked read_paths(Options &o) {
  const std::vector<float> at = parse_numbers("--pixel", o.pixel, 2);
  RenderSettings settings = render_settings(o.render);
  const Plan &plan = integrator(settings.integrator);
  if (plan.effects || plan.bidirectional || !plan.light_walk.empty() || plan.walk.size() == 1)
    throw UsageError("--integrator " + plan.name, "walks more than one path from the eye: a tree of rays, or light subpaths beside it, and single paths are shown", "use path, pure or hybrid");
  if (settings.indirect_samples > 1) throw UsageError("--indirect-samples", "makes trees, and single paths are shown", "sunstone learn branching compares trees and paths");
  const int x = static_cast<int>(at[0]), y = static_cast<int>(at[1]);
  if (static_cast<float>(x) != at[0] || static_cast<float>(y) != at[1] || x < 0 || y < 0 || x >= settings.width || y >= settings.height)
    throw UsageError("--pixel " + printable(o.pixel), fmt::format("is not a pixel of the {} picture", o.render.size), "0,0 is the upper left one");
  if (o.sample + o.samples > (std::uint64_t(1) << 32) / settings.light_samples) throw UsageError("--sample " + std::to_string(o.sample), "sample numbers times shadow rays end at 2^32");
  const std::string command = fmt::format("sunstone learn paths {} --integrator {} --size {} --max-depth {} --pixel {} --sample {} --samples {}", printable(o.render.scene, 400), o.render.integrator, o.render.size,
                                          o.render.max_depth, o.pixel, o.sample, o.samples);
  return {{"", "", settings}, x, y, {o.sample, o.sample + o.samples}, command};
}

void draw(Options &o, std::span<const Figure> wanted, const std::optional<Easel::Asked> &asked, Notices &notices) {
  make_folder(o.folder);
  catch_interrupts();
  Progress progress(o.render.quiet);
  const DeviceInfo info = choose_device(list_devices(notices), o.render.device);
  const Device device(info, {o.render.threads, true, o.render.work_group});
  progress.line(info.description());
  Variant variant = device_variant(info);
  if (o.render.lanes) variant.lanes = o.render.lanes;
  if (!o.render.layout.empty()) variant.layout = layout_from_name(o.render.layout);
  const SceneLoader load = [&](const Shot &shot, Layout layout) {
    LoadedScene loaded = load_scene(scene_options(o, shot), shot.settings, layout, info, notices);
    StudioScene scene{std::move(loaded.flat), loaded.camera, loaded.line, {}};
    for (const Material &material : loaded.scene.materials) scene.material_names.push_back(material.name);
    return scene;
  };
  Studio studio(device, variant, load, [&](double fraction, const std::string &text) {
    if (fraction < 1) progress.bar(fraction, text);
    return !interrupted();
  });
  Easel easel{studio, o.folder, o.quick, asked};
  const double begun = Progress::seconds();
  draw_all(easel, wanted, [&](const Drawn &d) { progress.line(fmt::format("{}: {}", d.figure->name, d.finding)); });
  progress.end_bar();
  const std::filesystem::path first = std::filesystem::path(o.folder) / (wanted.size() > 1 ? "index.html" : std::string(wanted[0].name) + ".html");
  progress.line(fmt::format("{} in {}", printable(first.string(), 400), show_seconds(Progress::seconds() - begun)));
}

void add_common(CLI::App &command, const std::shared_ptr<Options> &options) {
  command.add_option("-o,--output", options->folder, "The folder that pages, pictures and tables are written into [learn]")->type_name("FOLDER");
  command.add_flag("--quick", options->quick, "Tiny pictures and few samples: a first look, worth nothing as a measurement");
}

// A figure with scenes of its own takes no more than how to run.
void add_figure(CLI::App &learn, const Figure &f, std::span<const Figure> draws, CommandContext &context) {
  auto options = std::make_shared<Options>();
  CLI::App *command = learn.add_subcommand(f.name, f.summary);
  add_common(*command, options);
  command->add_option("--device", options->render.device, "Number, part of the name, cpu or gpu [as render chooses]")->type_name("SELECTOR");
  command->add_option("--threads", options->render.threads, "Use so many units of a CPU")->type_name("N");
  command->add_flag("-q,--quiet", options->render.quiet, "Only warnings and errors");
  if (std::string_view(f.name) == "branching") {
    command->add_option("scene", options->render.scene, "A scene of yours: .gltf, .glb or .obj [the Cornell box]")->type_name("SCENE");
    command->add_option("--env", options->render.environment, "Its light from all around: a picture (.hdr, .exr) or a colour")->type_name("FILE|R,G,B");
  }
  command->footer(fmt::format("Takes about {:.0f} s on two idle cores.\n\nExample:\n  sunstone learn {} -o out", f.seconds, f.name));
  command->callback([options, draws, &context] {
    context.quiet = options->render.quiet;
    std::optional<Easel::Asked> asked;
    if (!options->render.scene.empty()) asked.emplace();
    draw(*options, draws, asked, context.notices);
  });
}

// The paths of a scene of the user's: what `render` takes, but for what the picture's pixel decides.
void add_paths(CLI::App &learn, const Figure &f, CommandContext &context) {
  auto options = std::make_shared<Options>();
  CLI::App *command = learn.add_subcommand(f.name, f.summary);
  options->render.size = "480x360";
  add_render_options(*command, options->render);
  for (const char *other : {"--output", "--spp", "--time", "--error", "--crop", "--background", "--exposure", "--tone", "--aov", "--update", "--samples", "--checkpoint", "--resume", "--stats", "--pool"})
    command->remove_option(command->get_option(other));
  command->get_option("--size")->description("Width and height in pixels [480x360]");
  add_common(*command, options);
  command->add_option("--pixel", options->pixel, "The pixel, from the upper left")->type_name("X,Y")->required();
  command->add_option("--sample", options->sample, "The first sample that is shown [0]")->check(CLI::Range(0ull, 0xffffffffull))->type_name("N");
  command->add_option("--samples", options->samples, "How many are shown [8]")->check(CLI::Range(1, 256))->type_name("K");
  command->footer("Writes paths.html, paths.json, paths.csv, paths.svg and paths.png.\n\nExamples:\n"
                  "  sunstone learn paths scenes/cornell/cornell.gltf --pixel 300,320 -o out\n"
                  "  sunstone learn paths model.glb --integrator pure --pixel 10,20 --sample 41 --samples 1");
  command->callback([options, &f, &context] {
    context.quiet = options->render.quiet;
    draw(*options, std::span(&f, 1), read_paths(*options), context.notices);
  });
}

}  // namespace

void add_learn(CLI::App &app, CommandContext &context) {
  CLI::App *learn = app.add_subcommand("learn", "Figures of a course on path tracing, rendered and measured here, as pages");
  learn->require_subcommand(0, 1);
  learn->allow_extras();
  static const Figure all = {"all", "", "every figure, and a page that leads to them", 0, nullptr};
  double seconds = 0;
  for (const Figure &f : figures()) {
    seconds += f.seconds;
    if (std::string_view(f.name) == "paths") add_paths(*learn, f, context);
    else add_figure(*learn, f, std::span(&f, 1), context);
  }
  Figure everything = all;
  everything.seconds = seconds;
  add_figure(*learn, everything, figures(), context);
  learn->footer("Each writes pictures, a table (CSV) and one page of HTML that needs nothing else, into the folder of -o.\n\nExamples:\n  sunstone learn all -o out\n  sunstone learn convergence -o out\n"
                "  sunstone learn paths scenes/cornell/cornell.gltf --pixel 300,320 -o out");
  // Before a figure is drawn, and with the names of the figures where CLI11 would say no more than that a word was not expected.
  learn->parse_complete_callback([learn] {
    const std::vector<std::string> words = learn->remaining(true);
    const std::vector<CLI::App *> named = learn->get_subcommands();
    if (named.empty()) figure(words.empty() ? "" : words[0]);
    if (!words.empty()) throw UsageError("learn " + named[0]->get_name() + " " + printable(words[0]), "was not expected", "sunstone learn " + named[0]->get_name() + " --help tells the flags");
  });
}

}  // namespace sunstone
