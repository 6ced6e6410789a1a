// SPDX-License-Identifier: Apache-2.0
#include "bench/traversal.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "device/buffer.h"
#include "device/kernel.h"
#include "device/program.h"
#include "flatten/flatten.h"

namespace sunstone {
namespace {

using kernel::uint;
using Passed = std::array<uint, 2>;

// layout_name() lives with flatten, which the bench's kernel side does without.
std::string name_of(Layout layout) { return layout == Layout::binary ? "binary" : layout == Layout::wide8 ? "wide8" : "wide16"; }

// A tree on the device and the kernels of its layout.
class Tracer {
 public:
  Tracer(const Device &device, const FlatScene &scene, const Tree &tree)
      : layout(name_of(tree.layout)),
        device_(device),
        program_(device, "stages/trace.cl", {{"SUN_LAYOUT", int(tree.layout)}, {"SUN_SHAPES", scene.shape_count > 0}, {"SUN_MOTION", 0}}),
        closest_(program_, "trace_closest"),
        any_(program_, "trace_any"),
        nodes_(device, std::span<const std::byte>(tree.nodes), "nodes"),
        leaves_(device, std::span<const std::byte>(tree.leaves), "leaves"),
        list_(device, std::span<const uint>(tree.instance_list), "instance list"),
        roots_(device, std::span<const uint>(tree.roots), "roots"),
        fragments_(device, std::span<const kernel::Fragment>(scene.fragments), "fragments"),
        instances_(device, std::span<const kernel::Instance>(scene.instances), "instances"),
        top_root_(tree.top_root),
        instance_count_(uint(scene.instances.size() - scene.plane_count)),
        plane_count_(uint(scene.plane_count)) {}

  // Seconds from the launch to its end.
  double trace(const Buffer<TraceRay> &rays, const Buffer<Passed> &passed, bool any, const Buffer<kernel::Hit> &hits, const Buffer<uint> &blocked) {
    const uint count = uint(rays.size()), want = 0;
    const auto start = std::chrono::steady_clock::now();
    if (any)
      any_.run(count, rays, passed, blocked, count, want, nodes_, leaves_, list_, roots_, top_root_, fragments_, instances_, instance_count_,
                   plane_count_, 0.0f);
    else
      closest_.run(count, rays, passed, hits, count, want, nodes_, leaves_, list_, roots_, top_root_, fragments_, instances_, instance_count_,
                   plane_count_, 0.0f);
    device_.finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  const std::string layout;

 private:
  Device device_;
  Program program_;
  Kernel closest_, any_;
  Buffer<std::byte> nodes_, leaves_;
  Buffer<uint> list_, roots_;
  Buffer<kernel::Fragment> fragments_;
  Buffer<kernel::Instance> instances_;
  uint top_root_, instance_count_, plane_count_;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}
double least(const std::vector<double> &values) { return values.empty() ? 0.0 : *std::min_element(values.begin(), values.end()); }
double mega(std::size_t rays, double seconds) { return seconds > 0 ? double(rays) / seconds * 1e-6 : 0.0; }

struct RaySet {
  std::string kind;
  bool any;
  std::vector<TraceRay> rays;
};

void compare(TraversalResult &row, std::span<const kernel::Hit> ours, std::span<const kernel::Hit> theirs, bool any) {
  for (std::size_t i = 0; i < ours.size(); i++) {
    const bool a = ours[i].instance != SUN_NONE, b = theirs[i].instance != SUN_NONE;
    if (a != b)
      row.hit_mismatches++;
    else if (a && !any && !(std::fabs(ours[i].t - theirs[i].t) <= 1e-4f * std::fabs(theirs[i].t)))
      row.t_mismatches++;
  }
}

}  // namespace

std::vector<TraversalResult> run_traversal_bench(const Device &device, const FlatScene &scene, const kernel::Camera &camera,
                                                 std::span<const Tree> trees, std::span<const TraversalReference> references,
                                                 const TraversalOptions &options) {
  std::vector<Tracer> tracers;
  for (const Tree &tree : trees) tracers.emplace_back(device, scene, tree);
  std::vector<TraversalResult> results;
  if (tracers.empty()) return results;

  const auto new_rays = [](std::size_t count) { return std::vector<Passed>(count, Passed{SUN_NONE, SUN_NONE}); };
  const auto hits_of = [&](std::span<const TraceRay> rays) {
    const Buffer<TraceRay> ray_buffer(device, rays, "rays");
    const Buffer<Passed> passed(device, std::span<const Passed>(new_rays(rays.size())), "passed");
    const Buffer<kernel::Hit> hits(device, rays.size(), "hits");
    tracers[0].trace(ray_buffer, passed, false, hits, Buffer<uint>(device, 1, "blocked"));
    return hits.download();
  };
  std::vector<RaySet> sets;
  sets.push_back({"primary", false, primary_rays(camera, options.size)});
  const std::vector<kernel::Hit> first = hits_of(sets[0].rays);
  sets.push_back({"bounce1", false, bounce_rays(scene, sets[0].rays, first, 1)});
  sets.push_back({"bounce2", false, bounce_rays(scene, sets[1].rays, hits_of(sets[1].rays), 2)});
  sets.push_back({"shadow", true, shadow_rays(scene, sets[0].rays, first, 3)});

  for (const RaySet &set : sets) {
    const std::size_t count = set.rays.size();
    if (count == 0) continue;
    const Buffer<TraceRay> ray_buffer(device, std::span<const TraceRay>(set.rays), "rays");
    const Buffer<Passed> passed(device, std::span<const Passed>(new_rays(count)), "passed");
    const Buffer<kernel::Hit> hits(device, count, "hits");
    const Buffer<uint> blocked(device, count, "blocked");
    std::vector<std::vector<kernel::Hit>> reference_hits(references.size(), std::vector<kernel::Hit>(count));
    std::vector<std::vector<double>> ours(tracers.size()), theirs(references.size());
    for (unsigned repeat = 0; repeat <= options.repeats; repeat++) {  // turn by turn, so that a disturbance meets all alike; the first is a warm-up
      for (std::size_t k = 0; k < tracers.size(); k++) {
        const double seconds = tracers[k].trace(ray_buffer, passed, set.any, hits, blocked);
        if (repeat) ours[k].push_back(seconds);
      }
      for (std::size_t k = 0; k < references.size(); k++) {
        const double seconds = references[k].trace(set.rays, set.any, reference_hits[k]);
        if (repeat) theirs[k].push_back(seconds);
      }
    }
    for (std::size_t k = 0; k < tracers.size(); k++) {
      std::vector<kernel::Hit> our_hits(count);
      if (!references.empty()) {
        tracers[k].trace(ray_buffer, passed, set.any, hits, blocked);
        if (set.any) {
          const std::vector<uint> words = blocked.download();
          for (std::size_t i = 0; i < count; i++) our_hits[i].instance = words[i] ? 0 : SUN_NONE;
        } else {
          our_hits = hits.download();
        }
      }
      TraversalResult row;
      row.kind = set.kind;
      row.layout = tracers[k].layout;
      row.rays = count;
      row.mrays_per_s = mega(count, median(ours[k]));
      row.best_mrays_per_s = mega(count, least(ours[k]));
      if (references.empty()) results.push_back(row);
      for (std::size_t r = 0; r < references.size(); r++) {
        TraversalResult with = row;
        with.reference = references[r].name;
        with.reference_mrays_per_s = mega(count, median(theirs[r]));
        with.reference_best_mrays_per_s = mega(count, least(theirs[r]));
        with.ratio = with.reference_mrays_per_s > 0 ? with.mrays_per_s / with.reference_mrays_per_s : 0.0;
        compare(with, our_hits, reference_hits[r], set.any);
        results.push_back(with);
      }
    }
  }
  return results;
}

}  // namespace sunstone
