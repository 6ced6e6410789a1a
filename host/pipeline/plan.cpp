// SPDX-License-Identifier: Apache-2.0
#include "pipeline/plan.h"

#include <algorithm>

#include "base/error.h"

namespace sunstone {

std::span<const Plan> integrators() {
  using enum Stage;
  static const std::vector<Plan> table = {
      {"path", "path tracing with next-event estimation, multiple importance sampling and roulette", "Kajiya 1986, Veach 1997", true,
       {gather_paths, generate, intersect, first_hit, shade, gather_shadow_rays, occlude, roulette}, {}},
      {"pure", "path tracing as the equation says: light is found by chance alone", "Kajiya 1986", false,
       {gather_paths, generate, intersect, first_hit, shade, roulette}, {"point", "spot", "directional"}},
  };
  return table;
}

const Plan &integrator(const std::string &name) {
  std::string known;
  for (const Plan &plan : integrators()) {
    if (plan.name == name) return plan;
    known += (known.empty() ? "" : ", ") + plan.name;
  }
  throw UsageError("--integrator " + printable(name), "no such integrator; there are " + known);
}

void check_plan(const Plan &plan) {
  const auto at = [&](Stage stage) { return std::ranges::find(plan.walk, stage) - plan.walk.begin(); };
  const auto has = [&](Stage stage) { return std::ranges::find(plan.walk, stage) != plan.walk.end(); };
  const auto demand = [&](bool holds, const char *what) {
    if (!holds) throw Error("integrator " + plan.name, what);
  };
  for (const Stage stage : {Stage::gather_paths, Stage::generate, Stage::intersect, Stage::shade}) demand(has(stage), "a walk gathers, generates, intersects and shades");
  demand(at(Stage::gather_paths) < at(Stage::generate) && at(Stage::generate) < at(Stage::intersect) && at(Stage::intersect) < at(Stage::shade),
         "its stages stand in an order in which a queue is read before it is filled");
  demand(has(Stage::occlude) == plan.direct && has(Stage::gather_shadow_rays) == plan.direct, "shadow rays are sent and traced, or neither");
  if (plan.direct)
    demand(at(Stage::shade) < at(Stage::gather_shadow_rays) && at(Stage::gather_shadow_rays) < at(Stage::occlude), "shadow rays are traced before they are there");
  if (has(Stage::first_hit)) demand(at(Stage::intersect) < at(Stage::first_hit) && at(Stage::first_hit) < at(Stage::shade), "first_hit stands between intersect and shade");
  if (has(Stage::roulette)) demand(at(Stage::shade) < at(Stage::roulette), "roulette stands behind shade");
}

}  // namespace sunstone
