// SPDX-License-Identifier: Apache-2.0
// An integrator is an arrangement of stages: a row of a table.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace sunstone {

// What one step of a walk may run, in the order of a plan. `gather_*` make a dense queue for the stage behind them; `whitted` is a whole walk, fused.
enum class Stage { gather_paths, generate, intersect, first_hit, shade, gather_shadow_rays, occlude, roulette, branch, emit, deposit, connect, occlude_all, whitted, gather, gather_caustics };

struct RenderSettings;

struct Plan {
  std::string name, summary, source;
  bool direct = false;      // shade sends shadow rays
  bool weighted = false;    // and weights them and the emitters that are hit against each other; else each light has one of the two
  bool effects = false;     // rays leave a vertex by effect, each followed
  std::vector<Stage> walk;  // one step of every path; repeated until all have ended
  std::vector<std::string> refuses;  // emitters that no path of it can meet: "point", "spot", "directional"
  std::vector<std::string> takes;    // flags of its own
  std::string leaves_out;            // light that it does not follow, and who does
  bool bidirectional = false;        // slots walk a light subpath first: shared/bidirectional.h
  std::vector<Stage> light_walk = {};// one step of light subpaths alone, walked before those of eyes: their vertices become a map (pipeline/light_map.h)
  bool photons = false;              // they are photons, that eye paths look at: SUN_FRAME_PHOTONS
  bool map_once = false;             // one map serves all samples, with one of caustics beside it; else each sample has its own, of a radius that shrinks
  bool one_time = false;             // vertices of several pixels meet: all pixels take the shutter's time of a sample from its number alone
};

std::span<const Plan> integrators();

// UsageError with the names there are.
const Plan &integrator(const std::string &name);

// UsageError where a flag that belongs to single integrators does not belong to this one.
void check_flag(const Plan &plan, const std::string &flag);

// UsageError where settings ask for what the integrator does not take: the film would not know of it.
void check_settings(const Plan &plan, const RenderSettings &settings);

// Whether several rays may leave a vertex.
bool branches(const RenderSettings &settings);

// UsageError where the tree of rays of one sample would be beyond all bounds.
void check_branching(const RenderSettings &settings);

// UsageError where no photons could be found within it.
void check_radius(const std::string &flag, double radius);

// The queue that a stage needs has to be filled by one before it, and each that is filled has to be emptied: Error naming both otherwise.
void check_plan(const Plan &plan);

}  // namespace sunstone
