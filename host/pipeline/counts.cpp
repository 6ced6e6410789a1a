// SPDX-License-Identifier: Apache-2.0
#include "pipeline/counts.h"

#include "pipeline/stages.h"

namespace sunstone {

std::vector<std::uint64_t> rays_by_depth(const RenderCounts &counts) {
  std::vector<std::uint64_t> rays(SUN_COUNT_DEPTHS);
  std::uint64_t alive = counts.paths;
  for (std::size_t d = 0; d < rays.size(); d++) {
    rays[d] = alive;
    alive = alive + counts.branched_by_depth[d] - counts.ended_by_depth[d];
  }
  return rays;
}

void Counters::begin(const Pool &pool, kernel::uint first, kernel::uint last) {
  seen.assign(2 * SUN_COUNT_WORDS, 0);
  seen[SUN_COUNT_NEXT_PATH] = first;
  seen[SUN_COUNT_PATHS] = last;
  pool.counts.upload(seen);
}

void Counters::look(const Pool &pool) {
  std::vector<kernel::uint> now = pool.counts.download();
  const auto since = [&](std::size_t at) { return static_cast<std::uint64_t>(now[at] - seen[at]); };
  for (std::size_t i = 0; i < SUN_ENDED_COUNT; i++) {
    sum.ended[i] += since(SUN_COUNT_ENDED + i);
    sum.paths += since(SUN_COUNT_ENDED + i);
    sum.camera_rays += since(SUN_COUNT_ENDED + i);
  }
  for (std::size_t i = 0; i < SUN_COUNT_DEPTHS; i++) {
    sum.branched_by_depth[i] += since(SUN_COUNT_BRANCHED + i);
    sum.paths -= since(SUN_COUNT_BRANCHED + i);
    sum.camera_rays -= since(SUN_COUNT_BRANCHED + i);
  }
  sum.camera_rays += since(SUN_COUNT_RAYS);
  sum.bounce_rays += since(SUN_COUNT_RAYS + 1);
  sum.shadow_rays += since(SUN_COUNT_RAYS + 2);
  sum.clamped += since(SUN_COUNT_CLAMPED);
  sum.nan += since(SUN_COUNT_NAN);
  for (std::size_t i = 0; i < SUN_COUNT_DEPTHS; i++) sum.ended_by_depth[i] += since(SUN_COUNT_BY_DEPTH + i);
  seen = std::move(now);
}

}  // namespace sunstone
