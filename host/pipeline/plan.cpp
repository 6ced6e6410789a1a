// SPDX-License-Identifier: Apache-2.0
#include "pipeline/plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "pipeline/settings.h"
#include "shared/bidirectional.h"
#include "shared/frame.h"
#include "shared/light_map.h"

namespace sunstone {

constexpr unsigned most_rays_a_sample = 1u << 20;
constexpr double least_radius = 1e-6, most_radius = 1e6;  // metres

std::span<const Plan> integrators() {
  using enum Stage;
  static const std::vector<Plan> table = {
      {"path", "path tracing with next-event estimation, multiple importance sampling and roulette", "Kajiya 1986, Veach 1997", true, true, false,
       {gather_paths, generate, intersect, first_hit, shade, gather_shadow_rays, occlude, roulette}, {}, {}, ""},
      {"pure", "path tracing as the equation says: light is found by chance alone", "Kajiya 1986", false, false, false,
       {gather_paths, generate, intersect, first_hit, shade, roulette}, {"point", "spot", "directional"}, {"--end-on-light", "--sampling"}, ""},
      {"hybrid", "light sampling for what is direct, path tracing for what is not", "the lecture's speed-up", true, false, false,
       {gather_paths, generate, intersect, first_hit, shade, gather_shadow_rays, occlude, roulette, branch}, {},
       {"--light-samples", "--indirect-samples", "--nee", "--absorption", "--double-count"}, ""},
      {"distribution", "Whitted's tree with rays spread over what blurs: gloss, translucency, soft shadows, the lens", "Cook, Porter, Carpenter 1984", true, false, true,
       {gather_paths, generate, intersect, first_hit, shade, gather_shadow_rays, occlude, roulette, branch}, {}, {"--light-samples", "--indirect-samples"},
       "light that matt surfaces send each other; --integrator path follows it"},
      {"bdpt", "bidirectional path tracing: paths from the eye and from the lights, joined in every way", "Lafortune & Willems 1993, Veach & Guibas 1995", true, true, false,
       {gather_paths, emit, intersect, first_hit, deposit, connect, gather_shadow_rays, occlude_all, roulette}, {}, {"--heuristic", "--strategy", "--unweighted"}, "", true},
      {"photon", "photon map: light paths first, then paths from the eye that look at their photons one ray later, and at caustics straight", "Jensen 1995, 1996", true, true, false,
       {gather_paths, generate, intersect, first_hit, gather_caustics, gather, shade, gather_shadow_rays, occlude, roulette}, {}, {"--photons", "--radius", "--caustic-radius"}, "",
       false, {gather_paths, emit, intersect, deposit, roulette}, true, true},
      {"sppm", "stochastic progressive photon mapping: photons around what the eye sees, ever closer", "Hachisuka & Jensen 2009, Knaus & Zwicker 2011", true, true, false,
       {gather_paths, generate, intersect, first_hit, gather, shade, gather_shadow_rays, occlude, roulette}, {}, {"--photons", "--radius", "--alpha"}, "", false,
       {gather_paths, emit, intersect, deposit, roulette}, true, false, true},
      {"vcm", "vertex connection and merging: bdpt, whose eye paths also take what light paths left around them", "Georgiev, Krivanek, Davidovic, Slusallek 2012", true, true, false,
       {gather_paths, emit, intersect, first_hit, gather, connect, gather_shadow_rays, occlude_all, roulette}, {}, {"--heuristic", "--radius", "--alpha"}, "", true,
       {gather_paths, emit, intersect, deposit, gather_shadow_rays, occlude_all, roulette}, false, false, true},
      {"whitted", "mirrored and refracted rays, both followed, and point lights: no light between matt surfaces", "Whitted 1980", false, false, false, {whitted}, {},
       {"--ambient", "--cutoff"},
       "what emissive surfaces and the environment light (they are seen, directly and in mirrors), and light between matt surfaces; --integrator path follows both"},
  };
  return table;
}

const char *sampling_name(Sampling sampling) { return sampling == Sampling::bsdf ? "bsdf" : sampling == Sampling::cosine ? "cosine" : "uniform"; }

Sampling sampling_from_name(const std::string &name) {
  for (const Sampling sampling : {Sampling::bsdf, Sampling::cosine, Sampling::uniform})
    if (name == sampling_name(sampling)) return sampling;
  throw UsageError("--sampling " + printable(name), "no such way; there are bsdf, cosine, uniform");
}

void check_flag(const Plan &plan, const std::string &flag) {
  if (std::ranges::find(plan.takes, flag) != plan.takes.end()) return;
  std::string takers;
  for (const Plan &other : integrators())
    if (std::ranges::find(other.takes, flag) != other.takes.end()) takers += (takers.empty() ? "" : " or ") + ("--integrator " + other.name);
  throw UsageError(flag, "means nothing to --integrator " + plan.name, "it belongs to " + takers);
}

// A light subpath of any pixel may light any other.
static void check_bidirectional(const Plan &plan, const RenderSettings &s) {
  if (s.x0 != 0 || s.y0 != 0 || s.x1 != s.width || s.y1 != s.height)
    throw UsageError("--crop", "is not for --integrator " + plan.name + ": light that starts anywhere falls into the window, so all of the picture would be traced for it", "render the whole picture, or use --integrator path");
  if (s.max_depth > SUN_MOST_BIDIRECTIONAL_DEPTH)
    throw UsageError("--max-depth " + std::to_string(s.max_depth), "is more than --integrator " + plan.name + " takes, " + std::to_string(SUN_MOST_BIDIRECTIONAL_DEPTH) + ": each path in flight keeps a light vertex and a shadow ray for each, 192 bytes",
                     "use --integrator path for longer paths");
  if (s.strategy_t) {
    const std::string place = "--strategy " + std::to_string(s.strategy_s) + "," + std::to_string(s.strategy_t);
    if (s.strategy_s + s.strategy_t < 2) throw UsageError(place, "has no edge: there are at least two vertices");
    if (s.strategy_t == 1 && s.strategy_s == 1) throw UsageError(place, "is not used: light that is seen directly is found by 0,2");
    if (s.strategy_s + s.strategy_t > s.max_depth + 2) throw UsageError(place, "scatters " + std::to_string(s.strategy_s + s.strategy_t - 2) + " times, more than --max-depth allows");
  } else if (s.unweighted) {
    throw UsageError("--unweighted", "is for one strategy: all of them without weights would count light many times", "add --strategy S,T");
  }
}

void check_radius(const std::string &flag, double radius) {
  if (!(radius >= least_radius * (1 - 1e-6) && radius <= most_radius))
    throw UsageError(fmt::format("{} {}", flag, radius), fmt::format("is not from {} to {} metres, within which photons can be told apart", least_radius, most_radius));
}

static void check_photons(const Plan &plan, const RenderSettings &s) {
  if (s.max_depth > SUN_MOST_BIDIRECTIONAL_DEPTH)
    throw UsageError("--max-depth " + std::to_string(s.max_depth), "is more than --integrator " + plan.name + " takes, " + std::to_string(SUN_MOST_BIDIRECTIONAL_DEPTH) + ": each light path in flight keeps a vertex for each, 128 bytes",
                     "use --integrator path for longer paths");
  if (s.radius != 0) check_radius("--radius", s.radius);
  if (s.caustic_radius != 0) check_radius("--caustic-radius", s.caustic_radius);
  if (!(s.alpha > 0 && s.alpha <= 1)) throw UsageError(fmt::format("--alpha {}", s.alpha), "is above 0, and at most 1, where the radius does not shrink");
  if (s.photons > SUN_MOST_PHOTONS) throw UsageError("--photons " + std::to_string(s.photons), "is more than " + std::to_string(SUN_MOST_PHOTONS));
}

void check_settings(const Plan &plan, const RenderSettings &settings) {
  const RenderSettings plain;
  if (settings.end_on_light) check_flag(plan, "--end-on-light");
  if (settings.sampling != plain.sampling) check_flag(plan, "--sampling");
  if (settings.light_samples != plain.light_samples) check_flag(plan, "--light-samples");
  if (settings.nee_first) check_flag(plan, "--nee");
  if (settings.absorption != plain.absorption) check_flag(plan, "--absorption");
  if (settings.double_count) check_flag(plan, "--double-count");
  if (settings.balance) check_flag(plan, "--heuristic");
  if (settings.strategy_t) check_flag(plan, "--strategy");
  if (settings.unweighted) check_flag(plan, "--unweighted");
  if (plan.bidirectional) check_bidirectional(plan, settings);
  if (settings.photons != plain.photons) check_flag(plan, "--photons");
  if (settings.radius != plain.radius) check_flag(plan, "--radius");
  if (settings.caustic_radius != plain.caustic_radius) check_flag(plan, "--caustic-radius");
  if (settings.alpha != plain.alpha) check_flag(plan, "--alpha");
  if (!plan.light_walk.empty()) check_photons(plan, settings);
  if (settings.ambient != plain.ambient) check_flag(plan, "--ambient");
  if (settings.cutoff != plain.cutoff) check_flag(plan, "--cutoff");
  if (std::ranges::find(plan.walk, Stage::whitted) != plan.walk.end() && settings.max_depth > SUN_WHITTED_DEPTH)
    throw UsageError("--max-depth " + std::to_string(settings.max_depth), "--integrator " + plan.name + " follows trees of rays, which double at each depth, to " + std::to_string(SUN_WHITTED_DEPTH));
  if (settings.light_samples < 1 || settings.light_samples > SUN_MOST_LIGHT_SAMPLES)
    throw UsageError("--light-samples", "is from 1 to " + std::to_string(SUN_MOST_LIGHT_SAMPLES));
  if (settings.indirect_samples != plain.indirect_samples) check_flag(plan, "--indirect-samples");
  check_branching(settings);
}

bool branches(const RenderSettings &settings) { return settings.indirect_samples > 1 || integrator(settings.integrator).effects; }

void check_branching(const RenderSettings &settings) {
  const std::string place = "--indirect-samples " + std::to_string(settings.indirect_samples);
  if (settings.indirect_samples < 1 || settings.indirect_samples > SUN_MOST_INDIRECT_SAMPLES)
    throw UsageError(place, "is from 1 to " + std::to_string(SUN_MOST_INDIRECT_SAMPLES));
  if (settings.indirect_samples == 1) return;
  // Rays of a sample as they are expected where nothing but the fixed chance ends them, and every vertex has every effect.
  const bool effects = integrator(settings.integrator).effects;
  const unsigned children = settings.indirect_samples * (effects ? 2 : 1);
  const double growth = children * (1.0 - std::max(0.0, static_cast<double>(settings.absorption)));
  double rays = 1, generation = 1;
  unsigned depth = 0;
  for (; depth < settings.max_depth && rays <= most_rays_a_sample; depth++) rays += generation *= growth;
  if (rays > most_rays_a_sample)
    throw UsageError(place, fmt::format("with --max-depth {} each sample could take {:.2g} rays after {} scatterings alone, and each ray may send {} shadow rays; at most {} rays are allowed",
                                        settings.max_depth, rays, depth, settings.light_samples, most_rays_a_sample),
                     fmt::format("use --max-depth {} or less, {}or --indirect-samples 1 and more --spp", depth - 1, effects ? "" : "a larger --absorption, "));
}

const Plan &integrator(const std::string &name) {
  std::string known;
  for (const Plan &plan : integrators()) {
    if (plan.name == name) return plan;
    known += (known.empty() ? "" : ", ") + plan.name;
  }
  throw UsageError("--integrator " + printable(name), "no such integrator; there are " + known);
}

void check_plan(const Plan &plan) {
  const auto at = [&](Stage stage) { return std::ranges::find(plan.walk, stage) - plan.walk.begin(); };
  const auto has = [&](Stage stage) { return std::ranges::find(plan.walk, stage) != plan.walk.end(); };
  const auto demand = [&](bool holds, const char *what) {
    if (!holds) throw Error("integrator " + plan.name, what);
  };
  if (has(Stage::whitted)) {
    demand(plan.walk.size() == 1 && !plan.direct, "a fused walk stands alone");
    return;
  }
  // What begins paths, what shades them and what traces their shadow rays goes by other names where there are light subpaths.
  const Stage begin = plan.bidirectional ? Stage::emit : Stage::generate, shade = plan.bidirectional ? Stage::connect : Stage::shade;
  const Stage occlude = plan.bidirectional ? Stage::occlude_all : Stage::occlude;
  for (const Stage stage : {Stage::gather_paths, begin, Stage::intersect, shade}) demand(has(stage), "a walk gathers, begins paths, intersects and shades");
  demand(at(Stage::gather_paths) < at(begin) && at(begin) < at(Stage::intersect) && at(Stage::intersect) < at(shade),
         "its stages stand in an order in which a queue is read before it is filled");
  if (!plan.light_walk.empty()) {
    const auto light = [&](Stage stage) { return std::ranges::find(plan.light_walk, stage) - plan.light_walk.begin(); };
    demand(light(Stage::gather_paths) < light(Stage::emit) && light(Stage::emit) < light(Stage::intersect) && light(Stage::intersect) < light(Stage::deposit) &&
               light(Stage::deposit) < static_cast<std::ptrdiff_t>(plan.light_walk.size()),
           "light subpaths are gathered, begun, intersected and stored");
  }
  demand(has(Stage::gather) == !plan.light_walk.empty() && has(Stage::gather_caustics) == (plan.photons && plan.map_once), "photons are looked at, or there are none");
  if (has(Stage::gather)) demand(at(Stage::intersect) < at(Stage::gather) && at(Stage::gather) < at(shade), "gather stands between intersect and shade");
  demand(has(Stage::deposit) == (plan.bidirectional && plan.light_walk.empty()), "light subpaths are begun and walked, or neither");
  if (has(Stage::deposit)) demand(at(Stage::intersect) < at(Stage::deposit) && at(Stage::deposit) < at(Stage::gather_shadow_rays), "deposit stands between intersect and the shadow rays");
  demand(has(occlude) == plan.direct && has(Stage::gather_shadow_rays) == plan.direct, "shadow rays are sent and traced, or neither");
  if (plan.direct)
    demand(at(shade) < at(Stage::gather_shadow_rays) && at(Stage::gather_shadow_rays) < at(occlude), "shadow rays are traced before they are there");
  if (has(Stage::first_hit)) demand(at(Stage::intersect) < at(Stage::first_hit) && at(Stage::first_hit) < at(shade), "first_hit stands between intersect and shade");
  if (has(Stage::branch)) demand(plan.walk.back() == Stage::branch, "branch stands at the end: it looks at what has ended");
  if (has(Stage::roulette)) demand(at(shade) < at(Stage::roulette), "roulette stands behind what shades");
}

}  // namespace sunstone
