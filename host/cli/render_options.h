// SPDX-License-Identifier: Apache-2.0
// The flags of `sunstone render`, as they were given.
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "device/device.h"
#include "film/film.h"
#include "import/import.h"
#include "output/output.h"
#include "pipeline/settings.h"

namespace sunstone {

struct RenderOptions {
  std::string scene;
  std::vector<std::string> outputs;
  std::string integrator = "path", size = "1280x720", crop, samples, sampler = "sobol", filter = "blackman-harris", layers;
  std::optional<unsigned long long> spp;
  std::optional<double> seconds, error, update;
  unsigned max_depth = 16;
  unsigned long long seed = 0;
  bool end_on_light = false, double_count = false;
  bool unweighted = false;
  std::optional<std::string> sampling, nee, heuristic, strategy;
  std::optional<long long> light_samples, indirect_samples;
  std::optional<double> absorption, cutoff, radius, caustic_radius, alpha;
  std::optional<long long> photons;
  std::string ambient;
  std::string camera, look_from, look_at, up = "y";
  std::optional<double> fov, aperture, focus;
  std::string environment, background = "scene";
  double environment_rotation = 0, environment_strength = 1;
  ViewOptions view;
  std::string device, layout;
  unsigned threads = 0, pool = 0, work_group = 0, lanes = 0;
  std::string checkpoint, resume, stats;
  ImportOptions import;  // its time: of the picture, or where frames begin
  std::string frames;
  std::optional<double> fps;
  bool quiet = false, verbose = false;
};

void add_render_options(CLI::App &command, RenderOptions &options);

// The settings that the flags mean. UsageError names the flag and what it takes.
RenderSettings render_settings(const RenderOptions &options);

// "X,Y,Z" and the like: `count` finite numbers.
std::vector<float> parse_numbers(const std::string &flag, const std::string &text, std::size_t count);

// --frames A:B, half-open.
struct FrameRange {
  std::uint64_t first, last;
};
std::optional<FrameRange> parse_frames(const RenderOptions &options);

// Seconds at which frame `number` is taken: --time-at (0 without it) plus number / --fps.
double frame_time(const RenderOptions &options, std::uint64_t number);

// "dir/walk.png" -> "dir/walk.0007.png".
std::string frame_name(const std::string &name, std::uint64_t number);

// --samples A:B, or 0:spp.
SampleRange parse_samples(const RenderOptions &options);

}  // namespace sunstone
