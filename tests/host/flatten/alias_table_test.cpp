// SPDX-License-Identifier: Apache-2.0
// The alias table gives exactly the chances it states: counted over all 2^24 numbers that can be asked for.
#include "flatten/alias_table.h"

#include <gtest/gtest.h>

#include <numeric>

#include "host/flatten/flatten_support.h"
#include "scene/emitter.h"

namespace sunstone {
namespace {

std::vector<kernel::Emitter> emitters_of(const AliasTable &table) {
  std::vector<kernel::Emitter> emitters(table.pmf.size());
  for (std::size_t i = 0; i < emitters.size(); i++) {
    emitters[i].pmf = table.pmf[i];
    emitters[i].threshold = table.threshold[i];
    emitters[i].alias = static_cast<kernel::uint>(table.alias[i]);
  }
  return emitters;
}

// Every number once, through the kernels' function.
void expect_exact(const std::vector<double> &weights) {
  const AliasTable table = make_alias_table(weights);
  ASSERT_EQ(table.pmf.size(), weights.size());
  const auto emitters = emitters_of(table);
  std::vector<std::uint32_t> counts(weights.size());
  for (std::uint32_t k = 0; k < (1u << 24); k++) {
    const kernel::EmitterChoice choice =
        kernel::choose_emitter(emitters.data(), static_cast<kernel::uint>(emitters.size()), static_cast<float>(k) * 0x1p-24f);
    ASSERT_LT(choice.index, weights.size());
    counts[choice.index]++;
  }
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  const double slack = (static_cast<double>(weights.size()) + 2) * 0x1p-24;
  for (std::size_t i = 0; i < weights.size(); i++) {
    ASSERT_EQ(static_cast<float>(counts[i]) * 0x1p-24f, table.pmf[i]) << i << " of " << weights.size();
    ASSERT_GT(table.pmf[i], 0.0f);
    if (total > 0) {
      ASSERT_NEAR(table.pmf[i], weights[i] / total, slack);
    }
  }
}

TEST(AliasTable, OfOneEntry) { expect_exact({3.5}); }
TEST(AliasTable, OfTwoEntries) { expect_exact({1, 3}); }
TEST(AliasTable, OfEntriesWithoutWeight) { expect_exact({0, 0, 0, 0, 0}); }
TEST(AliasTable, OfWeightsFarApart) { expect_exact({1e-30, 1, 1e30, 0, 2}); }

TEST(AliasTable, OfManyRandomWeights) {
  Random random(7);
  for (std::size_t n : {3u, 1000u, 100003u}) {
    std::vector<double> weights(n);
    for (double &weight : weights) {
      const double x = random.number();
      weight = x * x * x * x * (random.number() < 0.1f ? 1000 : 1);
    }
    expect_exact(weights);
  }
}

TEST(AliasTable, ThatIsNearlyFull) {
  const std::size_t n = (std::size_t(1) << 23) + 12345;
  const AliasTable table = make_alias_table(std::vector<double>(n, 1.0));
  double sum = 0;
  for (float pmf : table.pmf) sum += pmf;
  EXPECT_EQ(sum, 1.0);
}

}  // namespace
}  // namespace sunstone
