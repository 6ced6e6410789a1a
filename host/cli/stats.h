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

// `film` is what was written: with --resume it holds more samples than this session rendered, and the times are of these alone.
std::string render_stats(const Session &session, const Film &film, const RenderTimes &times);

}  // namespace sunstone
