// SPDX-License-Identifier: Apache-2.0
// Embree over the same geometry and the same rays: the yardstick of bench and tests.
#pragma once
#include <memory>
#include <span>

#include "bench/rays.h"
#include "flatten/flatten.h"

namespace sunstone {

struct EmbreeOptions {
  bool robust = false;   // RTC_SCENE_FLAG_ROBUST: watertight
  bool high = true;      // build quality high (spatial splits, where not robust), else medium
  unsigned threads = 0;  // that trace; 0: all
};

class EmbreeReference {
 public:
  EmbreeReference(const FlatScene &scene, const EmbreeOptions &options);
  ~EmbreeReference();
  // Seconds that tracing took. Hits as the kernels leave them: t_max, SUN_NONE where there is none. Sides and kinds of triangles are not looked at.
  double closest(std::span<const TraceRay> rays, std::span<kernel::Hit> hits) const;
  // 16 rays a call (rtcIntersect16), for coherent rays.
  double closest16(std::span<const TraceRay> rays, std::span<kernel::Hit> hits) const;
  // hits[i].instance is 0 where the ray is blocked, SUN_NONE where it is not.
  double any(std::span<const TraceRay> rays, std::span<kernel::Hit> hits) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sunstone
