// SPDX-License-Identifier: Apache-2.0
#include "cli/render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/number.h"
#include "cli/commands.h"
#include "pipeline/plan.h"
#include "shared/frame.h"
#include "shared/light_map.h"

namespace sunstone {

namespace {

template <class T> T parse(const std::string &flag, std::string_view text, const char *what) {
  const std::optional<T> value = read_number<T>(text);
  if (!value) throw UsageError(flag + " " + printable(text), std::string("is not ") + what);
  return *value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

LayerChoice parse_layers(const std::string &text) {
  LayerChoice choice;
  if (text.empty()) return choice;
  for (const std::string_view name : split(text, ',')) {
    const bool all = name == "all";
    bool known = all || name == "beauty" || name == "samples" || name == "variance";  // always there
    const auto take = [&](std::string_view wanted, bool &flag) {
      if (all || name == wanted) flag = known = true;
    };
    take("bounce", choice.bounces);
    take("direct", choice.bounces);
    take("indirect", choice.bounces);
    take("albedo", choice.albedo);
    take("normal", choice.normal);
    take("Z", choice.depth);
    take("depth", choice.depth);
    take("position", choice.position);
    take("object_id", choice.object);
    take("material_id", choice.material);
    take("alpha", choice.alpha);
    if (!known)
      throw UsageError("--aov " + printable(name), "no such layer; there are beauty, albedo, normal, Z, position, samples, variance, bounce, direct, indirect, object_id, material_id, alpha, all");
  }
  return choice;
}

}  // namespace

void add_render_options(CLI::App &command, RenderOptions &o) {
  command.add_option("scene", o.scene, "The scene: .gltf, .glb or .obj")->required()->type_name("SCENE");
  command.add_option("-o,--output", o.outputs, "Write FILE: .exr with layers; .png .jpg .hdr .tif a view; .film the integers [the scene's stem .png]")->type_name("FILE")->allow_extra_args(false);
  command.add_option("--integrator", o.integrator, "How light is found [path]")->type_name("NAME")->group("Picture");
  command.add_option("--spp", o.spp, "Samples per pixel [64]")->type_name("N")->group("Picture");
  command.add_option("--time", o.seconds, "End after so many seconds, whole samples done")->type_name("SECONDS")->group("Picture");
  command.add_option("--error", o.error, "End once the estimated relMSE is below this (looked at after powers of two)")->type_name("RELMSE")->group("Picture");
  command.add_option("--size", o.size, "Width and height in pixels [1280x720]")->type_name("WxH")->group("Picture");
  command.add_option("--crop", o.crop, "Render this window of the picture alone, half-open")->type_name("X0,Y0,X1,Y1")->group("Picture");
  command.add_option("--max-depth", o.max_depth, "Most scatterings of a path; 0 is light seen directly [16]")->check(CLI::Range(0, 4096))->type_name("N")->group("Picture");
  command.add_option("--seed", o.seed, "Another seed gives independent noise [0]")->check(CLI::Range(0ull, 0xffffffffull))->type_name("N")->group("Picture");
  command.add_option("--sampler", o.sampler, "sobol (Owen-scrambled), or independent [sobol]")->check(CLI::IsMember({"sobol", "independent"}))->type_name("NAME")->group("Picture");
  command.add_option("--filter", o.filter, "box, tent, gaussian, mitchell or blackman-harris [blackman-harris]")->type_name("NAME")->group("Picture");
  command.add_flag("--end-on-light", o.end_on_light, "pure: a path ends on the light that it hits, as in the lecture")->group("Integrator");
  command.add_option("--sampling", o.sampling, "pure: directions by bsdf, cosine or uniform: what the pdf is worth [bsdf]")->type_name("NAME")->group("Integrator");
  command.add_option("--light-samples", o.light_samples, "hybrid, distribution: shadow rays a vertex, 1 to 64 [1]")->type_name("N")->group("Integrator");
  command.add_option("--indirect-samples", o.indirect_samples, "hybrid: rays that leave a vertex, each branching anew; distribution: rays for each effect that blurs [1]")->type_name("N")->group("Integrator");
  command.add_option("--nee", o.nee, "hybrid: shadow rays at every hit, or at the camera ray's first hit alone [every]")->type_name("every|first")->group("Integrator");
  command.add_option("--absorption", o.absorption, "hybrid: chance that a path ends at a scattering, from 0 to below 1 [by its throughput]")->type_name("A")->group("Integrator");
  command.add_flag("--double-count", o.double_count, "hybrid: the classic mistake, on purpose: a light that is hit counts beside its shadow rays")->group("Integrator");
  command.add_option("--heuristic", o.heuristic, "bdpt, vcm: strategies share a path by the power heuristic, or by the balance heuristic [power]")->type_name("power|balance")->group("Integrator");
  command.add_option("--strategy", o.strategy, "bdpt: paths of S vertices from the light and T from the eye alone")->type_name("S,T")->group("Integrator");
  command.add_flag("--unweighted", o.unweighted, "bdpt: that strategy as if there were no other")->group("Integrator");
  command.add_option("--photons", o.photons, "sppm: light paths of a sample, whose photons all pixels share [as many as pixels, 1024 to 1048576]; photon: of the render [500000]")->type_name("N")->group("Integrator");
  command.add_option("--radius", o.radius, "sppm, photon, vcm: within which light vertices count; of sppm and vcm for the first sample, as it shrinks [by the scene's size and the photons; vcm: two pixels of what is seen at most]")->type_name("METRES")->group("Integrator");
  command.add_option("--caustic-radius", o.caustic_radius, "photon: within which photons of caustics count [half of --radius]")->type_name("METRES")->group("Integrator");
  command.add_option("--alpha", o.alpha, "sppm, vcm: how much of what a sample adds is kept by the shrinking radius, above 0 to 1 [0.6667]")->type_name("A")->group("Integrator");
  command.add_option("--ambient", o.ambient, "whitted: light that is about everywhere, for matt surfaces [0,0,0]")->type_name("R,G,B")->group("Integrator");
  command.add_option("--cutoff", o.cutoff, "whitted: rays that are worth less are not followed [1/512]")->type_name("X")->group("Integrator");
  command.add_option("--camera", o.camera, "The file's camera of this name or number [0]")->type_name("NAME|INDEX")->group("Camera");
  command.add_option("--look-from", o.look_from, "A camera here ...")->type_name("X,Y,Z")->group("Camera");
  command.add_option("--look-at", o.look_at, "... looking there")->type_name("X,Y,Z")->group("Camera");
  command.add_option("--up", o.up, "What is up for --look-from [y]")->check(CLI::IsMember({"y", "z"}))->type_name("y|z")->group("Camera");
  command.add_option("--fov", o.fov, "Vertical angle of view in degrees [40 with --look-from]")->check(CLI::Range(0.001, 179.0))->type_name("DEG")->group("Camera");
  command.add_option("--aperture", o.aperture, "Radius of the lens in metres [0: all sharp]")->check(CLI::Range(0.0, 1e6))->type_name("RADIUS")->group("Camera");
  command.add_option("--focus", o.focus, "Distance of the sharp plane [to the scene's centre]")->check(CLI::Range(1e-6, 1e9))->type_name("METRES")->group("Camera");
  command.add_option("--env", o.environment, "Light from all around: a picture (.hdr, .exr) or a colour")->type_name("FILE|R,G,B")->group("Light");
  command.add_option("--env-rotation", o.environment_rotation, "Turn it about the vertical [0]")->type_name("DEG")->group("Light");
  command.add_option("--env-strength", o.environment_strength, "Multiply it [1]")->check(CLI::Range(0.0, 1e12))->type_name("X")->group("Light");
  command.add_option("--background", o.background, "scene, or transparent where camera rays meet nothing [scene]")->check(CLI::IsMember({"scene", "transparent"}))->type_name("KIND")->group("Light");
  add_view_options(command, o.view);
  command.add_option("--aov", o.layers, "More layers for .exr and .film: a list, or all")->type_name("LIST")->group("Output");
  command.add_option("--update", o.update, "Rewrite the pictures this often while rendering")->check(CLI::Range(0.1, 1e9))->type_name("SECONDS")->group("Output");
  command.add_option("--samples", o.samples, "Render these samples alone, half-open; merge adds the films")->type_name("A:B")->group("Output");
  add_pose_options(command, o.import);
  command.add_option("--frames", o.frames, "Render these frames of the animation, half-open; -o walk.png writes walk.0000.png ...")->type_name("A:B")->group("Motion");
  command.add_option("--fps", o.fps, "Frames of a second [24]")->type_name("N")->group("Motion");
  command.add_option("--checkpoint", o.checkpoint, "Keep the film here every 30 seconds and at the end")->type_name("FILE.film")->group("Output");
  command.add_option("--resume", o.resume, "Go on with this film")->type_name("FILE.film")->group("Output");
  command.add_option("--stats", o.stats, "Write what was measured as JSON")->type_name("FILE.json")->group("Output");
  command.add_option("--device", o.device, "Number, part of the name, cpu or gpu [the first GPU, else the CPU with most units]")->type_name("SELECTOR")->group("Device (never changes a bit)");
  command.add_option("--threads", o.threads, "Use so many units of a CPU")->type_name("N")->group("Device (never changes a bit)");
  command.add_option("--pool", o.pool, "Paths in flight")->check(CLI::Range(16u, 1u << 26))->type_name("N")->group("Device (never changes a bit)");
  command.add_option("--work-group", o.work_group, "Work-items of a group")->check(CLI::Range(1, 4096))->type_name("N")->group("Device (never changes a bit)");
  command.add_option("--layout", o.layout, "Tree: binary, wide8 or wide16")->type_name("NAME")->group("Device (never changes a bit)");
  command.add_option("--lanes", o.lanes, "Paths of a shading work-item: 1, 8 or 16")->check(CLI::IsMember({1, 8, 16}))->type_name("N")->group("Device (never changes a bit)");
  command.add_flag("--allow-outside", o.import.allow_outside, "Let the scene name files outside its own folder");
  command.add_flag("-q,--quiet", o.quiet, "Only warnings and errors");
  command.add_flag("-v,--verbose", o.verbose, "More about what is done");
}

std::vector<float> parse_numbers(const std::string &flag, const std::string &text, std::size_t count) {
  std::vector<float> values;
  for (const std::string_view part : split(text, ',')) {
    values.push_back(parse<float>(flag, part, "a number"));
    if (!std::isfinite(values.back())) throw UsageError(flag + " " + printable(text), "is not finite");
  }
  if (values.size() != count) throw UsageError(flag + " " + printable(text), "takes " + std::to_string(count) + " numbers with commas between them");
  return values;
}

// Sample numbers go up to 2^32; several rays a vertex take as many points of their sequence for each.
static SampleRange checked(const RenderOptions &o, SampleRange range) {
  const auto check = [&](const char *flag, long long rays, long long most) {
    rays = std::clamp(rays, 1ll, most);
    if (range.last > (std::uint64_t(1) << 32) / static_cast<std::uint64_t>(rays))
      throw UsageError(flag + (" " + std::to_string(rays)), "sample numbers times rays of a vertex end at 2^32");
  };
  check("--light-samples", o.light_samples.value_or(1), SUN_MOST_LIGHT_SAMPLES);
  check("--indirect-samples", o.indirect_samples.value_or(1), SUN_MOST_INDIRECT_SAMPLES);
  return range;
}

SampleRange parse_samples(const RenderOptions &o) {
  if (o.samples.empty()) {
    const unsigned long long open_end = o.seconds || o.error ? 1ull << 20 : 64;
    const unsigned long long spp = o.spp.value_or(open_end);
    if (spp == 0 || spp > (1ull << 32)) throw UsageError("--spp " + std::to_string(spp), "is not from 1 to 2^32");
    return checked(o, {0, spp});
  }
  if (o.spp) throw UsageError("--samples", "cannot be given beside --spp");
  const auto parts = split(o.samples, ':');
  if (parts.size() != 2) throw UsageError("--samples " + printable(o.samples), "is not A:B");
  const SampleRange range{parse<std::uint64_t>("--samples", parts[0], "a sample number"), parse<std::uint64_t>("--samples", parts[1], "a sample number")};
  if (range.first >= range.last || range.last > (std::uint64_t(1) << 32)) throw UsageError("--samples " + printable(o.samples), "holds no sample, or ends beyond 2^32");
  return checked(o, range);
}

std::optional<FrameRange> parse_frames(const RenderOptions &o) {
  if (o.frames.empty()) {
    if (o.fps) throw UsageError("--fps", "says how far apart --frames are, which are not given");
    check_pose_options(o.import);
    return {};
  }
  const std::string place = "--frames " + printable(o.frames);
  const auto parts = split(o.frames, ':');
  if (parts.size() != 2) throw UsageError(place, "is not A:B");
  const FrameRange range{parse<std::uint64_t>("--frames", parts[0], "a frame's number"), parse<std::uint64_t>("--frames", parts[1], "a frame's number")};
  if (range.first >= range.last || range.last > 10000000) throw UsageError(place, "holds no frame, or ends beyond 10000000");
  if (o.fps && !(*o.fps >= 1e-3 && *o.fps <= 1e6)) throw UsageError("--fps", "is not from 0.001 to 1000000");
  if (!o.checkpoint.empty() || !o.resume.empty())
    throw UsageError(o.resume.empty() ? "--checkpoint" : "--resume", "keeps the film of one picture, and --frames renders many",
                     "-o NAME.film keeps the film of each frame, and --frames goes on at any of them");
  if (o.update) throw UsageError("--update", "rewrites one picture while it gets better; --frames writes each when it is done");
  return range;
}

double frame_time(const RenderOptions &o, std::uint64_t number) { return o.import.time.value_or(0) + static_cast<double>(number) / o.fps.value_or(24); }

std::string frame_name(const std::string &name, std::uint64_t number) {
  const std::filesystem::path path(name);
  std::string digits = std::to_string(number);
  if (digits.size() < 4) digits.insert(0, 4 - digits.size(), '0');
  return (path.parent_path() / (path.stem().string() + "." + digits + path.extension().string())).string();
}

// What single integrators take, refused elsewhere.
static void read_integrator_flags(const RenderOptions &o, RenderSettings &s) {
  const Plan &plan = integrator(s.integrator);
  if (o.end_on_light) check_flag(plan, "--end-on-light");
  s.end_on_light = o.end_on_light;
  if (o.sampling) {
    check_flag(plan, "--sampling");
    s.sampling = sampling_from_name(*o.sampling);
  }
  if (o.light_samples) {
    check_flag(plan, "--light-samples");
    const std::string place = "--light-samples " + std::to_string(*o.light_samples);
    if (*o.light_samples < 1) throw UsageError(place, "without shadow rays light is found by chance alone", "use --integrator pure");
    if (*o.light_samples > SUN_MOST_LIGHT_SAMPLES)
      throw UsageError(place, "is more than " + std::to_string(SUN_MOST_LIGHT_SAMPLES) + ": each vertex of each of up to " + std::to_string(s.max_depth) +
                                  " scatterings would send as many rays, and each path in flight take " + std::to_string(*o.light_samples) + " x 64 bytes",
                       "more --spp spreads them over the pixel instead");
    s.light_samples = static_cast<unsigned>(*o.light_samples);
  }
  if (o.indirect_samples) {
    check_flag(plan, "--indirect-samples");
    if (*o.indirect_samples < 1 || *o.indirect_samples > SUN_MOST_INDIRECT_SAMPLES)
      throw UsageError("--indirect-samples " + std::to_string(*o.indirect_samples), "is not from 1 to " + std::to_string(SUN_MOST_INDIRECT_SAMPLES));
    s.indirect_samples = static_cast<unsigned>(*o.indirect_samples);
  }
  if (o.nee) {
    check_flag(plan, "--nee");
    if (*o.nee != "every" && *o.nee != "first") throw UsageError("--nee " + printable(*o.nee), "is neither every nor first");
    s.nee_first = *o.nee == "first";
  }
  if (o.absorption) {
    check_flag(plan, "--absorption");
    if (!(*o.absorption >= 0 && *o.absorption < 1)) throw UsageError("--absorption", "is a chance from 0 to below 1: at 1 no path would scatter");
    s.absorption = static_cast<float>(*o.absorption);
    if (!(s.absorption < 1)) throw UsageError("--absorption", "rounds to 1");
  }
  if (o.heuristic) {
    check_flag(plan, "--heuristic");
    if (*o.heuristic != "power" && *o.heuristic != "balance") throw UsageError("--heuristic " + printable(*o.heuristic), "is neither power nor balance");
    s.balance = *o.heuristic == "balance";
  }
  if (o.strategy) {
    check_flag(plan, "--strategy");
    const auto parts = split(*o.strategy, ',');
    if (parts.size() != 2) throw UsageError("--strategy " + printable(*o.strategy), "is not S,T: the vertices from the light's side, and from the eye's");
    s.strategy_s = parse<unsigned>("--strategy", parts[0], "a number of vertices");
    s.strategy_t = parse<unsigned>("--strategy", parts[1], "a number of vertices");
    if (s.strategy_t == 0) throw UsageError("--strategy " + printable(*o.strategy), "has no vertex at the eye, which light alone does not meet: T is at least 1");
    if (s.strategy_s > 4096 || s.strategy_t > 4096) throw UsageError("--strategy " + printable(*o.strategy), "is longer than any path");
  }
  if (o.unweighted) check_flag(plan, "--unweighted");
  s.unweighted = o.unweighted;
  if (!o.ambient.empty()) {
    check_flag(plan, "--ambient");
    const std::vector<float> rgb = parse_numbers("--ambient", o.ambient, 3);
    for (const float x : rgb)
      if (!(x >= 0 && x <= 1e18f)) throw UsageError("--ambient " + printable(o.ambient), "is from 0 to 1e18");
    std::ranges::copy(rgb, s.ambient.begin());
  }
  if (o.cutoff) {
    check_flag(plan, "--cutoff");
    if (!(*o.cutoff >= 0 && *o.cutoff <= 1)) throw UsageError("--cutoff", "is from 0, which follows every ray to the depth limit, to 1");
    s.cutoff = static_cast<float>(*o.cutoff);
  }
  if (o.photons) {
    check_flag(plan, "--photons");
    const std::string place = "--photons " + std::to_string(*o.photons);
    if (*o.photons < 1) throw UsageError(place, "without photons there is no light but what is direct", "use --integrator path");
    if (*o.photons > SUN_MOST_PHOTONS) throw UsageError(place, "is more than " + std::to_string(SUN_MOST_PHOTONS) + ": each leaves several vertices of 64 bytes");
    s.photons = static_cast<std::uint32_t>(*o.photons);
  }
  const auto read_radius = [&](const char *flag, const std::optional<double> &given, float &radius) {
    if (!given) return;
    check_flag(plan, flag);
    if (!(*given > 0)) throw UsageError(fmt::format("{} {}", flag, *given), "is not above 0 metres: photons are looked for within it, and points meet none");
    check_radius(flag, *given);
    radius = static_cast<float>(*given);
  };
  read_radius("--radius", o.radius, s.radius);
  read_radius("--caustic-radius", o.caustic_radius, s.caustic_radius);
  if (o.alpha) {
    check_flag(plan, "--alpha");
    if (!(*o.alpha > 0 && *o.alpha <= 1)) throw UsageError(fmt::format("--alpha {}", *o.alpha), "is above 0, and at most 1, where the radius does not shrink");
    s.alpha = std::max(static_cast<float>(*o.alpha), std::numeric_limits<float>::min());
  }
  if (o.double_count) check_flag(plan, "--double-count");
  s.double_count = o.double_count;
  check_branching(s);
}

RenderSettings render_settings(const RenderOptions &o) {
  RenderSettings s;
  const auto size = split(o.size, 'x');
  if (size.size() != 2) throw UsageError("--size " + printable(o.size), "is not WxH, such as 1280x720");
  s.width = parse<int>("--size", size[0], "a width in pixels");
  s.height = parse<int>("--size", size[1], "a height in pixels");
  if (s.width < 1 || s.height < 1 || s.width > 65536 || s.height > 65536 || static_cast<std::int64_t>(s.width) * s.height > (std::int64_t(1) << 28))
    throw UsageError("--size " + printable(o.size), "each side is from 1 to 65536, and there are at most 2^28 pixels");
  s.x1 = s.width;
  s.y1 = s.height;
  if (!o.crop.empty()) {
    const auto parts = split(o.crop, ',');
    if (parts.size() != 4) throw UsageError("--crop " + printable(o.crop), "is not X0,Y0,X1,Y1");
    int *const corner[4] = {&s.x0, &s.y0, &s.x1, &s.y1};
    for (std::size_t i = 0; i < 4; i++) *corner[i] = parse<int>("--crop", parts[i], "a whole number");
    if (s.x0 < 0 || s.y0 < 0 || s.x1 > s.width || s.y1 > s.height || s.x0 >= s.x1 || s.y0 >= s.y1)
      throw UsageError("--crop " + printable(o.crop), "is not a window of the " + o.size + " picture");
  }
  s.time = o.import.time;
  s.shutter = o.import.shutter;
  s.integrator = o.integrator;
  s.max_depth = o.max_depth;
  read_integrator_flags(o, s);
  s.seed = static_cast<std::uint32_t>(o.seed);
  s.independent = o.sampler == "independent";
  s.filter = filter_from_name(o.filter);
  s.transparent_background = o.background == "transparent";
  s.layers = parse_layers(o.layers);
  check_settings(integrator(s.integrator), s);
  return s;
}

}  // namespace sunstone
