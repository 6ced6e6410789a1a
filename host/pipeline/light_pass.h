// SPDX-License-Identifier: Apache-2.0
// The pass of light subpaths that goes before the eye's walk: which map of their vertices serves a sample, the radius that it is looked at with, and its making.
#pragma once
#include <optional>

#include "pipeline/counts.h"
#include "pipeline/light_map.h"
#include "pipeline/stages.h"

namespace sunstone {

constexpr int steps_in_a_pass = 4;  // of a walk over one sample alone, before the host reads how far it is

// What is left to the program: as many photons as the picture has pixels, and a radius within which there are about ten of them, or one where walks are joined, too.
// Plans without a pass have none of it.
void resolve_photons(const Plan &plan, RenderSettings &settings, kernel::Frame &frame);

// A radius that was left to the program, where walks are joined too: no more than two pixels of this size, in metres. What is seen may be small in a large scene, and what few
// light vertices fall there joins do better.
void bound_radius(RenderSettings &settings, double pixel);

class LightPass {
 public:
  // All but `device` have to outlive it. `frame` is that of the eye's walk, on the host and, for kernels, on the device.
  LightPass(const Device &device, const Programs &programs, const Plan &plan, const RenderSettings &settings, kernel::Frame &frame, const Buffer<kernel::Frame> &device_frame);

  // A new film is lit. Light subpaths that reach the lens light it while their map is made: a map of before would leave that out.
  void begin_film();

  // Has the runner look at the map of this sample; where it is not there yet, it is made first, over the same pool.
  void look(StageRunner &runner, const Pool &pool, Counters &counters, std::uint64_t sample);

  // Has it look at an empty one, for launches that do nothing.
  void look_at_nothing(StageRunner &runner);

  std::size_t bytes() const { return map_.bytes() + all_.bytes() + caustics_.bytes(); }

 private:
  float radius_of(std::uint64_t iteration);
  void trace(StageRunner &runner, const Pool &pool, Counters &counters, std::uint64_t sample);

  const Plan &plan_;
  const RenderSettings &settings_;
  kernel::Frame &frame_;
  const Buffer<kernel::Frame> &device_frame_;
  LightMap map_;
  LightGrid all_, caustics_;
  std::optional<std::uint64_t> mapped_;  // the sample whose light subpaths are in the map
  std::uint64_t shrunk_ = 0;             // iterations that `shrink_` stands for
  double shrink_ = 1;                    // the radius' square, as a share of the first
};

}  // namespace sunstone
