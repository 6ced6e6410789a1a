// SPDX-License-Identifier: Apache-2.0
// Pearson's test of counts against expectations, as a standard score: [Wilson31]'s cube root makes chi2 of any number of cells nearly normal.
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

namespace sunstone::test {

// Cells that expect fewer than 5 are put together. Under the hypothesis this is above 5 in about 3 of 10^7 tests.
inline double chi2_score(const std::vector<double> &counts, const std::vector<double> &expected) {
  double chi2 = 0, pooled_count = 0, pooled_expected = 0;
  int cells = 0;
  const auto add = [&](double count, double want) {
    chi2 += (count - want) * (count - want) / want;
    cells++;
  };
  for (std::size_t i = 0; i < counts.size(); i++) {
    if (expected[i] >= 5) add(counts[i], expected[i]);
    else pooled_count += counts[i], pooled_expected += expected[i];
  }
  if (pooled_expected > 0) add(pooled_count, pooled_expected);
  else if (pooled_count > 0) return INFINITY;  // something fell where nothing can
  const double freedom = cells - 1, spread = 2 / (9 * freedom);
  return (std::cbrt(chi2 / freedom) - (1 - spread)) / std::sqrt(spread);
}

inline double chi2_score_uniform(const std::vector<double> &counts) {
  double total = 0;
  for (const double count : counts) total += count;
  return chi2_score(counts, std::vector<double>(counts.size(), total / static_cast<double>(counts.size())));
}

constexpr double chi2_limit = 5;

}  // namespace sunstone::test
