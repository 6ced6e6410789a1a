// SPDX-License-Identifier: Apache-2.0
// The stages on one device: their programs, and the kernels bound to a scene, a pool and a film.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "device/kernel.h"
#include "flatten/flatten.h"
#include "pipeline/light_map.h"
#include "pipeline/plan.h"
#include "pipeline/settings.h"
#include "pipeline/upload.h"
#include "shared/queues.h"

namespace sunstone {

// What the programs are compiled for. None of it changes a bit.
struct Variant {
  unsigned lanes = 1;
  Layout layout = Layout::binary;
  bool columns = false;
  unsigned chunk = 1024;
  bool passable = true, specular = true, textures = true, shapes = true;
  int motion = 2;  // FlatScene::motion
  bool few_shapes = false, triangles = true;  // of the fused walk
  bool branching = false;
  bool bidirectional = false;  // has the stages of light subpaths
  bool light_map = false;      // and those of a map of their vertices
  bool photons = false;        // which eye paths look at
  bool operator==(const Variant &) const = default;
};

// Lanes, layout of paths and chunks that suit a device: explicit vectors on CPUs, one path a work-item in columns on GPUs.
Variant device_variant(const DeviceInfo &info);
// What of it an integrator needs ...
Variant integrator_variant(Variant variant, const RenderSettings &settings);
// ... and what a scene.
Variant scene_variant(Variant variant, const FlatScene &scene, const RenderSettings &settings);
// The layout of the BVH that suits a device.
Layout device_layout(const DeviceInfo &info);

// Says how much of a compilation is done, and what comes next.
using CompileProgress = std::function<void(double fraction, const std::string &what)>;

// Compiled programs: of the stages that work on paths, LANES at once, and of those that trace rays. PoCL preprocesses each program at every start, with
// headers of its own that take 0.06 s, so they are few (docs/decisions/0005-programs-and-caches.md).
struct Programs {
  Programs(const Device &device, const Variant &variant, const CompileProgress &progress = {});
  Variant variant;
  Program paths, rays;
  const Program &maps() const;     // of the light map, likewise
  const Program &whitted() const;  // of the fused walk: compiled when it is first asked for

 private:
  Device device_;
  mutable std::optional<Program> whitted_, maps_;
};

// Paths and queues of one pool.
struct Pool {
  Pool(const Device &device, unsigned slots, unsigned chunk, unsigned light_samples, unsigned branch_records, unsigned light_vertices);
  unsigned slots, chunks, light_samples;
  Buffer<kernel::uint> paths;       // SUN_PATH_WORDS a slot
  Buffer<kernel::uint> status;
  Buffer<kernel::Hit> hits;
  Buffer<kernel::ShadowRay> shadow_rays;  // light_samples times the slots: the first ray of each slot, then the second of each ...
  Buffer<kernel::uint> branches;    // branch_records of 16 words a slot, where vertices branch
  Buffer<kernel::uint> walks;       // SUN_WALK_WORDS a slot, where there are light vertices
  Buffer<kernel::uint> light_vertices;  // light_vertices times the slots, likewise
  Buffer<kernel::uint> rays[2];     // the ray queue and its successor
  Buffer<kernel::uint> shadow_queue;
  Buffer<kernel::uint> chunk_counts;
  Buffer<kernel::uint> counts;      // twice SUN_COUNT_WORDS
};

// Launches stages of a plan over a pool. Everything that is enqueued runs in order.
class StageRunner {
 public:
  StageRunner(const Programs &programs, const DeviceScene &scene, const Pool &pool, const Buffer<kernel::Frame> &frame, const Buffer<std::int64_t> &film);
  void run(Stage stage);
  // The maps that `gather` and `gather_caustics` look at, which have to outlive the runner. Where there is none of caustics, all photons are looked at in their place.
  void look_at(const LightMap &map, const LightGrid &all, const LightGrid *caustics);
  int current() const { return current_; }  // which of the pool's two ray queues is the queue now
  void set_current(int current) { current_ = current; }

 private:
  void run_gather(const LightGrid &grid, kernel::uint phase);
  void gather(unsigned bit, const Buffer<kernel::uint> &queue, const Buffer<kernel::uint> &out);
  const Programs &programs_;
  const DeviceScene &scene_;
  const Pool &pool_;
  const Buffer<kernel::Frame> &frame_;
  const Buffer<std::int64_t> &film_;
  unsigned lanes_;
  int current_ = 0;  // which of pool.rays is the queue
  std::optional<Kernel> emit_, deposit_, connect_, occlude_all_, gather_;
  const LightMap *map_ = nullptr;
  const LightGrid *all_ = nullptr, *caustics_ = nullptr;
  Kernel generate_, intersect_, first_hit_, shade_, occlude_, roulette_, count_, scan_, scatter_;
  std::optional<Kernel> branch_;  // where vertices branch
  std::optional<Kernel> whitted_, whitted_next_;
};

}  // namespace sunstone
