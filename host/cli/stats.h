// SPDX-License-Identifier: Apache-2.0
// --stats: what was measured, as JSON.
#pragma once
#include <string>

#include "cli/session.h"

namespace sunstone {

struct RenderTimes {
  double startup = 0, render = 0;
  std::string reproducible;  // yes, no, or unknown
};

std::string render_stats(const Session &session, const RenderTimes &times);

}  // namespace sunstone
