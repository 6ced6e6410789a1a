// SPDX-License-Identifier: Apache-2.0
// Two sets of films over independent seeds hold the same picture, or do not: Welch's test on means of blocks and of the whole picture, every bounce and channel by
// itself, Holm-corrected to one rate of false alarms.
#pragma once
#include <string>
#include <vector>

#include "support/render.h"

namespace sunstone::test {

struct Agreement {
  std::size_t means = 0, rejected = 0;
  std::string what;  // the first of those that differ
};

// `layers` of both; blocks of `block` pixels a side.
Agreement agreement(const std::vector<Film> &a, const std::vector<Film> &b, const std::vector<std::string> &layers, int block, double false_alarms);

// "bounce.0" ... "bounce.last".
std::vector<std::string> bounces(unsigned first, unsigned last);

// Standard error of the whole picture's mean over the mean, in green.
double relative_error(const std::vector<Film> &films, const std::string &layer);

}  // namespace sunstone::test
