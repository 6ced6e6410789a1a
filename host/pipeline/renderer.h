// SPDX-License-Identifier: Apache-2.0
// (plan, picture, samples) -> film, on one device.
#pragma once
#include <functional>
#include <memory>

#include "film/film.h"
#include "pipeline/counts.h"
#include "pipeline/display.h"
#include "pipeline/plan.h"
#include "pipeline/settings.h"
#include "pipeline/stages.h"

namespace sunstone {

struct RenderProgress {
  std::uint64_t paths_begun = 0, paths_wanted = 0;  // of this call
};

// A copy of everything on the device that stages change, the film apart.
struct StageState {
  std::vector<kernel::uint> paths, status, rays[2], shadow_queue, counts, walks, light_vertices;
  std::vector<kernel::Hit> hits;
  std::vector<kernel::ShadowRay> shadow_rays;
  int current = 0;
};

class Renderer;

// The stages of a renderer one by one, for the bench and for pages that show paths step by step.
class StageProbe {
 public:
  StageProbe(Renderer &renderer, SampleRange samples);
  ~StageProbe();
  StageProbe(StageProbe &&) noexcept;
  const std::vector<Stage> &walk() const;  // that this render runs
  void warm_up(int steps);                 // whole steps of the walk; the pool stays full
  void run(Stage stage);
  StageState save() const;
  void restore(const StageState &state);
  std::size_t items(Stage stage) const;    // entries of the queue that the stage works on, as it was run last
  std::vector<std::int64_t> film() const;  // integers of the first tile as they are now, layer by layer

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class Renderer {
 public:
  // Of these samples; left out, there are so many that the pool never runs dry.
  StageProbe probe(SampleRange samples = {0, std::uint64_t(1) << 32}) { return StageProbe(*this, samples); }
  // Builds pool and film on the device. `programs` have to outlive the renderer.
  Renderer(const Device &device, const Programs &programs, const FlatScene &scene, const kernel::Camera &camera, const RenderSettings &settings, const Tuning &tuning);
  ~Renderer();

  // Launches every stage once on an empty queue. Drivers that compile at a first launch (PoCL) do it here and not within the first sample.
  void warm_up(const CompileProgress &progress);

  // Renders samples [first, last) of every pixel and adds them to the film. `progress` is asked between launches; where it answers false the call ends
  // after the samples that have begun, all pixels alike. Returns what was done: [first, done). Throws Error before it begins where the film has some of them.
  SampleRange render(SampleRange wanted, const std::function<bool(const RenderProgress &)> &progress);

  // Of the same scene and size; the film is left as it is. The renderer has to outlive it. Throws Error where the integrator is not one fused walk.
  Display display() const;

  const Film &film() const;
  const RenderCounts &counts() const;
  std::size_t pool_bytes() const;
  std::size_t light_map_bytes() const;
  std::size_t film_bytes() const;
  std::size_t scene_bytes() const;
  unsigned pool_slots() const;

 private:
  friend class StageProbe;
  struct State;
  std::unique_ptr<State> state_;
};

// What decides the bits, for the film's header: refused to be mixed by merge and --resume.
std::map<std::string, std::string> film_settings(const RenderSettings &settings, const kernel::Camera &camera, std::span<const kernel::Camera> camera_keys = {});

}  // namespace sunstone
