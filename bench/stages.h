// SPDX-License-Identifier: Apache-2.0
// Each wavefront stage alone, on queues recorded from a render in full swing.
#pragma once
#include <string>
#include <vector>

#include "pipeline/renderer.h"

namespace sunstone {

struct StageResult {
  std::string stage;
  std::size_t items = 0;  // entries of the queue that it works on
  double seconds = 0;     // median of the repeats
  double best_seconds = 0;
  double mitems_per_s = 0;  // of the median
  std::size_t bytes = 0;    // that it has to read and write of paths, hits, shadow rays and queues (not of the scene or the film)
  double gb_per_s = 0;
  double share = 0;  // of one step of the whole walk
};

// Steps the renderer until its pool is full of paths of all depths, then times every stage of the plan `repeats` times from that same state. The film
// that the renderer holds afterwards is of no use.
std::vector<StageResult> run_stage_bench(const Device &device, Renderer &renderer, unsigned repeats);

}  // namespace sunstone
