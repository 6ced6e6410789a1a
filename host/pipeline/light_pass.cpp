// SPDX-License-Identifier: Apache-2.0
#include "pipeline/light_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/bidirectional.h"

namespace sunstone {

void resolve_photons(const Plan &plan, RenderSettings &settings, kernel::Frame &frame) {
  if (plan.light_walk.empty()) return;
  constexpr std::uint32_t least = 1u << 10, most = 1u << 20, once = 500000;
  const double spread = plan.photons ? 4 : 1;
  if (!plan.photons) frame.light_paths = frame.width * frame.height;  // each eye path has one of its own
  else if (settings.photons == 0) settings.photons = plan.map_once ? once : std::clamp(frame.width * frame.height, least, most);
  if (plan.photons) frame.light_paths = settings.photons;
  const double size = frame.scene_radius > 0 ? frame.scene_radius : 1;
  if (settings.radius == 0) settings.radius = static_cast<float>(std::clamp(spread * size / std::sqrt(static_cast<double>(frame.light_paths)), 1e-6, 1e6));
  if (settings.caustic_radius == 0) settings.caustic_radius = settings.radius / 2;
}

void bound_radius(RenderSettings &settings, double pixel) {
  constexpr double pixels = 2;
  settings.radius = static_cast<float>(std::clamp(pixels * pixel, 1e-6, static_cast<double>(settings.radius)));
}

LightPass::LightPass(const Device &device, const Programs &programs, const Plan &plan, const RenderSettings &settings, kernel::Frame &frame, const Buffer<kernel::Frame> &device_frame)
    : plan_(plan), settings_(settings), frame_(frame), device_frame_(device_frame), map_(device, programs.maps(), plan.photons ? 1 : SUN_LIGHT_VERTEX_RECORDS) {}

// Photons bring no light to the lens, so that their map may serve several films of one sample.
void LightPass::begin_film() {
  if (!plan_.photons) mapped_.reset();
}

// The global schedule: a pure function of the iteration, so that iterations may be done in any order and place [Knaus11 eq. 14].
float LightPass::radius_of(std::uint64_t iteration) {
  if (iteration < shrunk_) {
    shrunk_ = 0;
    shrink_ = 1;
  }
  for (; shrunk_ < iteration; shrunk_++) shrink_ *= (static_cast<double>(shrunk_ + 1) + static_cast<double>(settings_.alpha)) / static_cast<double>(shrunk_ + 2);
  return static_cast<float>(static_cast<double>(settings_.radius) * std::sqrt(shrink_));
}

// Light subpaths of a sample, in batches of the pool, into the map.
void LightPass::trace(StageRunner &runner, const Pool &pool, Counters &counters, std::uint64_t sample) {
  kernel::Frame of_lights = frame_;
  of_lights.flags = (frame_.flags & ~SUN_FRAME_EYE_PASS) | SUN_FRAME_LIGHT_PASS | (plan_.photons ? SUN_FRAME_PHOTONS : 0u);
  of_lights.sample_first = static_cast<kernel::uint>(sample);
  device_frame_.upload(std::span(&of_lights, 1));
  const std::uint32_t paths = plan_.photons ? settings_.photons : frame_.paths_per_sample;
  map_.begin(paths);
  for (std::uint32_t first = 0; first < paths; first += pool.slots) {
    const std::uint32_t count = std::min(pool.slots, paths - first);
    pool.walks.fill_zero();
    counters.begin(pool, first, first + count);
    do {
      for (int step = 0; step < steps_in_a_pass; step++)
        for (const Stage stage : plan_.light_walk) runner.run(stage);
      counters.look(pool);
    } while (counters.seen[SUN_COUNT_LIVE] != 0 || counters.seen[SUN_COUNT_NEXT_PATH] < first + count);
    counters.sum.bounce_rays += count;  // their first
    map_.collect(pool, device_frame_, first, count);
  }
  map_.end();
}

void LightPass::look(StageRunner &runner, const Pool &pool, Counters &counters, std::uint64_t sample) {
  if (frame_.emitter_count == 0 || settings_.max_depth == 0) return;
  const std::uint64_t wanted = plan_.map_once ? 0 : sample;
  if (mapped_ != wanted) {
    mapped_.reset();
    const double radius = plan_.map_once ? settings_.radius : radius_of(sample);
    frame_.merges = static_cast<float>(std::numbers::pi * radius * radius * frame_.light_paths);
    trace(runner, pool, counters, wanted);
    map_.build(all_, static_cast<float>(radius), 0);
    if (plan_.map_once) map_.build(caustics_, settings_.caustic_radius, SUN_LIGHT_VERTEX_CAUSTIC);
    mapped_ = wanted;
  }
  runner.look_at(map_, all_, plan_.map_once ? &caustics_ : nullptr);
}

void LightPass::look_at_nothing(StageRunner &runner) {
  mapped_.reset();
  map_.begin(1);
  map_.build(all_, settings_.radius, 0);
  runner.look_at(map_, all_, plan_.map_once ? &all_ : nullptr);
}

}  // namespace sunstone
