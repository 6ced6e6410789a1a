// SPDX-License-Identifier: Apache-2.0
// What a render counts: paths, rays, and how paths ended, as the device's counters tell it.
#pragma once
#include <cstdint>
#include <vector>

#include "shared/queues.h"

namespace sunstone {

struct Pool;

struct RenderCounts {
  std::uint64_t paths = 0, clamped = 0, nan = 0;
  std::uint64_t ended[SUN_ENDED_COUNT] = {};              // light, depth, escaped, absorbed: they add up to the paths, and the branches beside the first of each
  std::uint64_t camera_rays = 0, bounce_rays = 0, shadow_rays = 0;
  std::vector<std::uint64_t> ended_by_depth = std::vector<std::uint64_t>(SUN_COUNT_DEPTHS);  // paths that ended after so many scatterings
  std::vector<std::uint64_t> branched_by_depth = std::vector<std::uint64_t>(SUN_COUNT_DEPTHS);  // further branches begun after so many
};

// Rays of paths by how many scatterings were before them. One that ended after d was alive at every depth up to d; a branch begun after d from d + 1 on.
std::vector<std::uint64_t> rays_by_depth(const RenderCounts &counts);

// Counters of a pool, which wrap around, and the sum of what they have counted.
struct Counters {
  RenderCounts sum;
  std::vector<kernel::uint> seen;  // as they were read last

  // Paths from `first` to `last` are to be walked; the counters begin at 0.
  void begin(const Pool &pool, kernel::uint first, kernel::uint last);
  // Reads them, and adds what was counted since the last look.
  void look(const Pool &pool);
};

}  // namespace sunstone
