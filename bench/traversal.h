// SPDX-License-Identifier: Apache-2.0
// Rays per second of the kernels, beside a reference that traces the same rays in the same run, turn by turn.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/rays.h"
#include "device/device.h"

namespace sunstone {

// Embree, as a rule; kept behind a function since it lives in another object.
struct TraversalReference {
  std::string name;
  // Traces and returns seconds; for `any` hits[i].instance is SUN_NONE where nothing blocks.
  std::function<double(std::span<const TraceRay> rays, bool any, std::span<kernel::Hit> hits)> trace;
};

struct TraversalOptions {
  unsigned size = 1024;  // size x size primary rays
  unsigned repeats = 5;  // after one run that is not timed
};

struct TraversalResult {
  std::string kind;  // primary, bounce1, bounce2, shadow
  std::string layout, reference;
  std::size_t rays = 0;
  double mrays_per_s = 0, best_mrays_per_s = 0;  // median and best of the repeats
  double reference_mrays_per_s = 0, reference_best_mrays_per_s = 0;
  double ratio = 0;                // of the medians
  std::size_t hit_mismatches = 0;  // rays where one hits and the other does not
  std::size_t t_mismatches = 0;    // both hit, t differs by more than 1e-4 of it
};

// The rays come of the first tree's hits. One row for each kind, tree and reference (reference empty where there is none).
std::vector<TraversalResult> run_traversal_bench(const Device &device, const FlatScene &scene, const kernel::Camera &camera,
                                                 std::span<const Tree> trees, std::span<const TraversalReference> references,
                                                 const TraversalOptions &options);

}  // namespace sunstone
