// SPDX-License-Identifier: Apache-2.0
#include "bench/stages.h"

#include <algorithm>

namespace sunstone {

namespace {

struct Row {
  Stage stage;
  const char *name;
  std::size_t bytes_an_item;  // read and written, of paths (64), hits (32), shadow rays (64), status and queue entries (4)
};
constexpr Row rows[] = {{Stage::gather_paths, "compact", 3 * 4 + 2 * 4},
                        {Stage::generate, "generate", 64 + 4 + 4},
                        {Stage::intersect, "intersect", 36 + 32 + 4 + 4},
                        {Stage::first_hit, "first_hit", 64 + 32 + 4 + 4 + 4},
                        {Stage::shade, "shade", 64 + 32 + 64 + 56 + 4 + 4 + 4},
                        {Stage::gather_shadow_rays, "compact_shadow", 3 * 4 + 4},
                        {Stage::occlude, "occlude", 56 + 4},
                        {Stage::roulette, "roulette", 64 + 64 + 4 + 4},
                        {Stage::branch, "branch", 2 * 128 + 8 + 4 + 4},
                        {Stage::emit, "emit", 64 + 64 + 4 + 4},
                        {Stage::deposit, "deposit", 2 * 64 + 2 * 64 + 32 + 128 + 64 + 4 + 4 + 4},
                        {Stage::connect, "connect", 2 * 64 + 2 * 64 + 32 + 128 + 64 + 4 + 4 + 4},
                        {Stage::occlude_all, "occlude", 64 + 4}};

}  // namespace

std::vector<StageResult> run_stage_bench(const Device &device, Renderer &renderer, unsigned repeats) {
  StageProbe probe = renderer.probe();
  probe.warm_up(16);
  std::vector<StageResult> results;
  for (const Stage stage : probe.walk()) {
    const Row &row = *std::ranges::find(rows, stage, &Row::stage);
    const StageState before = probe.save();
    std::vector<double> seconds;
    for (unsigned i = 0; i <= repeats; i++) {
      probe.restore(before);
      device.take_times();
      probe.run(stage);
      double sum = 0;
      for (const StageTime &time : device.take_times()) sum += time.seconds;
      if (i > 0) seconds.push_back(sum);  // the first may compile
    }
    std::ranges::sort(seconds);
    StageResult result;
    result.stage = row.name;
    result.items = probe.items(stage);
    result.seconds = seconds[seconds.size() / 2];
    result.best_seconds = seconds.front();
    result.mitems_per_s = static_cast<double>(result.items) / result.seconds * 1e-6;
    result.bytes = result.items * row.bytes_an_item;
    result.gb_per_s = static_cast<double>(result.bytes) / result.seconds * 1e-9;
    results.push_back(result);
  }
  double total = 0;
  for (const StageResult &result : results) total += result.seconds;
  for (StageResult &result : results) result.share = result.seconds / total;
  return results;
}

}  // namespace sunstone
