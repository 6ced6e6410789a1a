// SPDX-License-Identifier: Apache-2.0
// An alias table [Walker77; Vose91] that gives exactly the chances it states: sampled with one of the 2^24 numbers k * 2^-24.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace sunstone {

struct AliasTable {
  std::vector<float> pmf;          // k * 2^-24 with a whole k >= 1; the sum is exactly 1
  std::vector<float> threshold;    // the slot keeps itself where the fraction is below ...
  std::vector<std::size_t> alias;  // ... and otherwise gives this
};

constexpr std::size_t max_alias_entries = std::size_t(1) << 24;

// `weights`: finite, none negative, at most max_alias_entries; where all are 0, all are alike. Nothing has chance 0.
//
// A slot of n holds c = floor or ceil of 2^24 / n numbers, those with floor(k * n / 2^24) = slot. Weights become whole numbers that add up to 2^24,
// and Vose's pairing of poor and rich entries runs on these, so that neither the table nor its pmf is ever rounded.
AliasTable make_alias_table(std::span<const double> weights);

}  // namespace sunstone
