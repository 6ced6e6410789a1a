// SPDX-License-Identifier: Apache-2.0
// Every triangle of every instance against a ray, in the kernels' own arithmetic (kernels/scene compiled as C++): what a traversal has to find.
#pragma once
#include <vector>

#include "bench/rays.h"
#include "flatten/flatten.h"

namespace sunstone::hits {

struct TracedRay {
  TraceRay ray;
  kernel::uint passed_instance = SUN_NONE, passed_primitive = SUN_NONE;
  float time = 0;  // of the shutter's
};

kernel::Hit brute_force(const FlatScene &scene, const TracedRay &ray, kernel::uint want);
// All that count, in order.
std::vector<kernel::Hit> all_hits(const FlatScene &scene, const TracedRay &ray, kernel::uint want);
// The traversal of the binary layout on the host.
kernel::Hit host_closest(const FlatScene &scene, const Tree &binary, const TracedRay &ray, kernel::uint want);
bool host_any(const FlatScene &scene, const Tree &binary, const TracedRay &ray, kernel::uint want);

// t, u, v bit for bit, instance and primitive.
bool same(const kernel::Hit &a, const kernel::Hit &b);

}  // namespace sunstone::hits
