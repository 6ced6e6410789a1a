// SPDX-License-Identifier: Apache-2.0
#include "flatten/alias_table.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace sunstone {
namespace {

constexpr std::int64_t numbers = std::int64_t(1) << 24;
constexpr float one_number = 0x1p-24f;

// Whole shares of 2^24, each at least 1, what is left over by largest remainder.
std::vector<std::int64_t> shares_of(std::span<const double> weights) {
  const std::size_t n = weights.size();
  double total = 0;
  for (double weight : weights) total += weight;
  const double room = static_cast<double>(numbers - static_cast<std::int64_t>(n));
  std::vector<std::int64_t> shares(n);
  std::vector<double> remainders(n);
  std::int64_t given = 0;
  for (std::size_t i = 0; i < n; i++) {
    const double part = total > 0 ? weights[i] / total * room : room / static_cast<double>(n);
    const double whole = std::floor(part);
    shares[i] = 1 + static_cast<std::int64_t>(whole);
    remainders[i] = part - whole;
    given += shares[i];
  }
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return remainders[a] > remainders[b]; });
  // Rounding in the quotients may leave the sum a little off on either side.
  for (std::size_t i = 0; given < numbers; i = (i + 1) % n, given++) shares[order[i]]++;
  for (std::size_t i = 0; given > numbers; i = (i + 1) % n)
    if (shares[order[n - 1 - i]] > 1) shares[order[n - 1 - i]]--, given--;
  return shares;
}

}  // namespace

AliasTable make_alias_table(std::span<const double> weights) {
  const auto n = static_cast<std::int64_t>(weights.size());
  AliasTable table;
  if (n == 0) return table;
  std::vector<std::int64_t> shares = shares_of(weights);
  for (std::int64_t share : shares) table.pmf.push_back(static_cast<float>(share) * one_number);

  const auto first = [&](std::int64_t slot) { return (slot * numbers + n - 1) / n; };  // the least k in the slot
  std::vector<std::size_t> poor, rich;
  const auto sort_in = [&](std::size_t i) {
    const auto slot = static_cast<std::int64_t>(i);
    const std::int64_t room = first(slot + 1) - first(slot);
    if (shares[i] < room) poor.push_back(i);
    if (shares[i] > room) rich.push_back(i);
  };
  for (std::size_t i = weights.size(); i-- > 0;) sort_in(i);
  table.threshold.assign(weights.size(), 1.0f);
  table.alias.resize(weights.size());
  std::iota(table.alias.begin(), table.alias.end(), std::size_t(0));
  while (!poor.empty()) {
    const std::size_t slot = poor.back();
    const auto s = static_cast<std::int64_t>(slot);
    poor.pop_back();
    const std::size_t giver = rich.back();  // there is one: what the poor lack is what the rich have too much
    rich.pop_back();
    // Number k of the slot has fraction (k * n - slot * 2^24) / 2^24; it keeps the first `shares` of them.
    table.threshold[slot] = static_cast<float>((first(s) + shares[slot]) * n - s * numbers) * one_number;
    table.alias[slot] = giver;
    shares[giver] -= first(s + 1) - first(s) - shares[slot];
    sort_in(giver);
  }
  return table;
}

}  // namespace sunstone
